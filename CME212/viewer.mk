# The viewer is compiled once, for all programs that include it. Its assertions
# stay on: they check how programs call it. The graphics driver does the work,
# so -O1 is enough.
system     = $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(1) 2>/dev/null))
draw_pkg   = sdl2 gl imgui libpng
draw_flags = $(if $(filter %/libviewer.a,$^),$(call system,$(draw_pkg)))
draw_libs  = $(if $(filter %/libviewer.a,$^),$(filter %/libviewer.a,$^) \
               $(shell pkg-config --libs $(draw_pkg)))
viewer    := $(patsubst %.cpp,$(B)/%.o,$(wildcard CME212/viewer/*.cpp))

$(B)/libviewer.flags $(viewer): flags = $(common) -O1 -g1 \
  $(call system,$(draw_pkg)) $(CPPFLAGS) $(CXXFLAGS)
$(viewer): $(B)/%.o: %.cpp $(B)/libviewer.flags
	@pkg-config --exists $(draw_pkg) || { echo "not all of $(draw_pkg) is \
	installed: 'make deps' does it; VIEWER=0 builds without a window" >&2; \
	exit 1; }
	@mkdir -p $(dir $@) && echo '$(CXX) $@'
	@$(CXX) $(flags) -MMD -MP -c -o $@ $<
$(B)/libviewer.a: $(viewer)
	@rm -f $@ && ar rcs $@ $^
