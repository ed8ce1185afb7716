# What builds, measures and checks the laboratory: make help-lab
#
# All of lab/ but its programs is one library, built once for speed in $(B), and
# once with assertions and sanitizers, for tests, in $(B)/asan.

# Not every compiler has OpenMP: then sweeps have one thread.
OPENMP ?= $(shell $(CXX) -fopenmp -include omp.h -fsyntax-only -x c++ \
            /dev/null 2>/dev/null && echo 1 || echo 0)
OPENMP := $(OPENMP)

# The programs: NAME is built as $(B)/NAME from the file.
lab_main   := lab/run/cloth.cpp \
              lab/page/page_positions.cpp lab/charts/work_precision.cpp \
              lab/charts/stability_map.cpp \
              $(wildcard lab/bench/bench*.cpp)
lab_others := $(wildcard docs/examples/*.cpp)
lab_lib    := $(filter-out $(lab_main) lab/page/wasi.cpp \
                $(wildcard lab/try/*.cpp lab/python/*.cpp), \
              $(wildcard lab/*/*.cpp))
lab_tests  := $(wildcard tests/test_*.cpp)
names       = $(basename $(notdir $(1)))
LAB_PROGRAMS := $(call names,$(lab_main))
LAB_TESTS    := $(call names,$(lab_tests))

# No product and sum in one rounding: the same bits on every processor.
lab_system := $(strip $(foreach p,eigen3 CLI11 gtest,$(call system,$(p))) \
              $(filter-out -D%,$(call system,tomlplusplus)))  # its header alone
lab_flags = $(common) -fno-math-errno -ffp-contract=off \
            $(if $(filter 1,$(OPENMP)),-fopenmp) $(lab_system)
# What names SDL, or asks whether there is a viewer.
lab_draw  = $(if $(filter 1,$(VIEWER)),$(if $(filter lab/viewer/Screen.% \
            tests/test_viewer.% tests/test_faces.% CME212/%,$<), \
            -DMASS_SPRING_VIEWER $(call system,$(draw_pkg))))
# FAST=1 asks for tests of what is built for speed.
tested     = $(if $(FAST),$(B),$(B)/asan)
test_flags = $(if $(FAST),$(speed),$(debug) $(sanitizer))
test_libs  = $(gtest_libs) -lrapidcheck

# What takes no part in a step: -O1 saves a fifth of the time to compile.
cold := advice live page run viewer words
# Each room is compiled as one unit, which reads its headers once and saves three
# tenths of `make cloth` from nothing. Tests are built anew after each change: for
# them each file is a unit, unless UNITY=1. What needs the window is a unit by
# itself: programs without one are not linked with it.
drawing := $(filter $(patsubst %,lab/%.cpp,viewer/Screen run/Film run/Window), \
             $(lab_lib))
united  := $(filter-out $(drawing),$(lab_lib))
rooms   := $(sort $(patsubst lab/%/,%,$(dir $(united))))
# $(in_NAME): the sources of unit NAME.
$(foreach r,$(rooms),$(eval in_$(r) := $(filter lab/$(r)/%,$(united))))
in_words  := $(filter $(patsubst %,lab/scenes/%.cpp,Acting Fields KeyValues \
               MeshFile Net% SceneFile Warnings Words),$(in_scenes))
in_scenes := $(filter-out $(in_words),$(in_scenes))
units_of   = $(patsubst %,$(1)/unity/%.o,$(rooms) words) \
             $(drawing:%.cpp=$(1)/%.o)
files_of   = $(lab_lib:%.cpp=$(1)/%.o)

# Half of the time of a file goes into headers that many include. g++ compiles
# them once for the tests; not for ccache, which would then keep no object.
common_hpp := $(if $(UNITY)$(findstring clang,$(CXX))$(findstring ccache,$(CXX) \
                $(realpath $(shell command -v $(firstword $(CXX))))),,common.hpp.gch)

# Some classes of the tests hide a virtual call on purpose, as a student may.
# $(call variant,FOLDER,FLAGS,COMMON.GCH,OBJECTS): the library in FOLDER.
define compile
	@mkdir -p $$(dir $$@) && echo '$(CXX) $$@'
	@$$(CXX) $$(lab_flags) $(2) $$(lab_draw) $$(CPPFLAGS) $$(CXXFLAGS) \
	  $$(if $(3),$$(if $$(filter lab/%,$$<),-include $(1)/common.hpp)) \
	  $$(unit_flags) $$(if $$(findstring tests,$$<),-Wno-overloaded-virtual) \
	  -MMD -MP -c -o $$@ $$<
endef
define variant
$(1)/%.o: %.cpp $(1)/lab.flags $(3:%=$(1)/%)
$(compile)
$(1)/common.hpp.gch: $(1)/lab.flags
	@mkdir -p $$(@D) && printf '#include "%s"\n' mass_spring.hpp \
	  lab/methods/Methods.hpp lab/stepping/Scene.hpp >$(1)/common.hpp
	@echo '$(CXX) $$@'
	@$$(CXX) $$(lab_flags) $(2) $$(CPPFLAGS) $$(CXXFLAGS) -MMD -MP \
	  -MF $(1)/common.d -MT $$@ -x c++-header -o $$@ $(1)/common.hpp
$(1)/unity/%.o: $(1)/unity/%.cpp $(1)/lab.flags
$(compile)
.PRECIOUS: $(1)/unity/%.cpp
$(1)/unity/%.cpp: FORCE
	@mkdir -p $$(@D) && tools/unity.sh $$(in_$$*) | cmp -s - $$@ \
	  || tools/unity.sh $$(in_$$*) > $$@
$(1)/liblab.a: $(4) $(1)/stored_scenes.o
	@rm -f $$@ && ar rcs $$@ $$^
$(1)/lab.flags: FORCE
	@mkdir -p $$(dir $$@); echo '$(CXX) $(lab_flags) $(2) $(CPPFLAGS) $(CXXFLAGS)' \
	  | cmp -s - $$@ || echo '$(CXX) $(lab_flags) $(2) $(CPPFLAGS) $(CXXFLAGS)' > $$@
$(1)/lab/viewer/Screen.o: $(1)/viewer.flags
$(1)/viewer.flags: FORCE
	@mkdir -p $$(dir $$@); echo '$(VIEWER)' | cmp -s - $$@ || echo '$(VIEWER)' > $$@
endef
# Position-independent, for the module of Python; hidden, so as fast as not.
movable = $(speed) -fPIC -fvisibility=hidden
ifneq ($(O)$(UNITY),)
include lab/units.mk
endif
# The scenes of data/scenes as text in the library.
vpath stored_scenes.cpp $(B)
$(B)/stored_scenes.cpp: FORCE
	@mkdir -p $(@D) && tools/stored_scenes.sh | cmp -s - $@ \
	  || tools/stored_scenes.sh > $@

$(eval $(call variant,$(B),$(movable),,$(call units_of,$(B))))
$(eval $(call variant,$(B)/asan,$(debug) $(sanitizer),$(common_hpp),$(call \
  $(if $(UNITY),units_of,files_of),$(B)/asan)))
$(patsubst %,$(B)/unity/%.o,$(cold)) $(patsubst %,$(B)/lab/%.o,run/% viewer/% \
  page/%): unit_flags = -O1
# The parser of the command line takes seconds at more.
$(B)/asan/lab/run/Options.o: unit_flags = -O0

# $(call program,PROGRAM,FOLDER,SOURCE,FLAGS,LIBRARIES)
define program
$(1): $(2)/$(basename $(3)).o $(2)/liblab.a
	@echo 'link $$@'
	@$$(CXX) $$(lab_flags) $(4) $$(CXXFLAGS) -o $$@ $$(filter-out %/libviewer.a,$$^) $$(draw_libs) $(5) $$(LDLIBS)
endef
$(foreach f,$(lab_main) $(lab_others),$(eval $(call program,$(B)/$(call names,$(f)),$(B),$(f),$(speed),$(if $(filter bench%,$(call names,$(f))),-lbenchmark))))
$(foreach f,$(lab_tests) $(TEST_UNITS:%=unity/%.cpp),$(eval $(call program,$(B)/$(call names,$(f)),$(tested),$(f),$(test_flags),$$(test_libs))))

# Tests that run a program.
$(filter $(B)/test_cloth_%,$(LAB_TESTS:%=$(B)/%)) $(TEST_UNITS:%=$(B)/%): | $(B)/cloth
ifeq ($(VIEWER),1)
$(B)/cloth: $(B)/libviewer.a
$(patsubst %,$(B)/test_%,viewer faces image screen): $(tested)/libviewer.a
endif
$(B)/asan/libviewer.a: $(viewer:$(B)/%=$(B)/asan/%)
	@rm -f $@ && ar rcs $@ $^

# make NAME for each; ./cloth lies beside the course's program.
.PHONY: $(filter-out cloth,$(LAB_PROGRAMS)) $(LAB_TESTS) $(TEST_UNITS)
$(filter-out cloth,$(LAB_PROGRAMS)) $(LAB_TESTS) $(TEST_UNITS) $(call names,$(lab_others)): %: $(B)/%
ifneq ($(O)cloth,$(B)/cloth)
$(O)cloth: $(B)/cloth
	@ln -f $< $@ 2>/dev/null || cp $< $@
endif

.PHONY: quick check check-full help-lab examples $(call names,$(lab_others))
check check-full: deps
examples: $(patsubst %,$(B)/%,$(filter example_%,$(call names,$(lab_others))))
quick check check-full:
	@tools/check.sh $@
format:
	clang-format -i $(shell git ls-files '*.hpp' '*.cpp')

include lab/measure.mk lab/page/page.mk lab/python/python.mk docs/site/site.mk

-include $(shell find $(B) -name '*.d' 2>/dev/null)
