# The viewer is compiled once, for all programs that include it. Its assertions
# stay on: they check how programs call it. The graphics driver does the work,
# so -O1 is enough. Without SDL2 and OpenGL programs are built without a window.
system     = $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(1) 2>/dev/null))
mac       := $(filter Darwin,$(shell uname))
draw_pkg  := sdl2 libpng $(if $(mac),,gl)
ifeq ($(VIEWER),1)
override VIEWER := $(shell pkg-config --exists $(draw_pkg) && echo 1 || echo 0)
no_window := $(if $(filter 0,$(VIEWER)), (no window: pkg-config does not \
               find all of $(draw_pkg)))
endif
viewer_lib = $(if $(filter 1,$(VIEWER)),$(B)/libviewer.a)
draw_flags = $(if $(filter %/libviewer.a,$^),$(call system,$(draw_pkg)))
draw_libs  = $(if $(filter %/libviewer.a,$^),$(filter %/libviewer.a,$^) \
               $(shell pkg-config --libs $(draw_pkg)) \
               $(if $(mac),-framework OpenGL))
viewer    := $(patsubst %.cpp,$(B)/%.o,$(wildcard CME212/viewer/*.cpp))

$(B)/libviewer.flags $(viewer): flags = $(common) -O1 -g1 -DMASS_SPRING_VIEWER \
  $(call system,$(draw_pkg)) $(CPPFLAGS) $(CXXFLAGS)
$(viewer): $(B)/%.o: %.cpp $(B)/libviewer.flags
	@mkdir -p $(dir $@) && echo '$(CXX) $@'
	@$(CXX) $(flags) -MMD -MP -c -o $@ $<
$(B)/libviewer.a: $(viewer)
	@rm -f $@ && ar rcs $@ $^
