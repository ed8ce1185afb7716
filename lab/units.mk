# For the checks alone (tools/check.sh), which set O and UNITY.
#
# O=FOLDER/: programs are built there, and `make NAME` means FOLDER/NAME.
ifneq ($(O),)
.PHONY: $(DRIVERS) $(OTHERS) cloth
$(DRIVERS) $(OTHERS) cloth: %: $(O)%
endif

# UNITY=1: each room of the laboratory is one unit for tests, too, and tests are
# dealt out by size to the programs tests_0, tests_1 ...
ifneq ($(UNITY),)
UNITS ?= 6

# Programs of their own: three specialize templates of other namespaces, four
# are linked with the window, one hooks malloc, one has another Graph.hpp.
tests_drawn := test_viewer test_faces test_image test_screen
tests_alone := test_graph test_graph_memory \
               $(if $(filter 1,$(VIEWER)),$(tests_drawn)) \
               test_cloth test_plain_steps

dealt      := $(shell ls -S $(filter-out $(patsubst %,tests/%.cpp, \
                $(tests_alone) $(tests_drawn)),$(lab_tests)))
TEST_UNITS := $(patsubst %,tests_%,$(shell seq 0 $$(($(UNITS) - 1))))
$(foreach u,$(TEST_UNITS),$(eval in_$(u) := $(shell printf '%s\n' $(dealt) \
  | awk 'NR % $(UNITS) == $(u:tests_%=%)')))

# All tests, and their names: those that take longest to build and to run first,
# so that two jobs end together. And what tests and programs are linked of,
# beside the library.
.PHONY: units list-units objects
units: $(TEST_UNITS) $(tests_alone)
list-units:
	@echo $(TEST_UNITS) $(tests_alone)
objects: $(TEST_UNITS:%=$(tested)/unity/%.o) \
  $(tests_alone:%=$(tested)/tests/%.o) \
  $(patsubst %.cpp,$(B)/%.o,$(lab_main) $(lab_others))
endif
