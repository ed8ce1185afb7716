# The tests: make test [SECTION=3.2 | TASK=3.2.Problem1Force]
#
# The tests of a section are compiled as one program, with assertions and
# sanitizers: build/tests/3.2. One that counts what is done can't have
# sanitizers, and is a program of its own. What knows nothing of your code is
# compiled once.

SECTION ?= $(basename $(TASK))
files    := $(wildcard tests/*.*.cpp)
sections := $(sort $(notdir $(basename $(files:.cpp=))))
counted  := $(patsubst tests/%.cpp,%, \
              $(shell grep -l 'Build: counted$$' $(files) /dev/null))
alone     = $(filter $(SECTION).%,$(counted))
together  = $(filter-out $(counted:%=tests/%.cpp),$(wildcard tests/$*.*.cpp))
frame     = $(B)/tests/main.o
of_test   = -Itests/headless $(common) -Itests $(debug) -O0 \
            -include tests/prelude.hpp -DKIT_TESTS='"tests"' \
            -MMD -MP -MF $@.d -MT $@ $(CPPFLAGS) $(CXXFLAGS)
defined   = $(shell sed -nE 's/.*(Define: |ifndef )(KIT_[A-Z]+)$$/-D\2/p' $(together))
# Where main() has the stages of the starter, it is compiled in each of them.
stages    = $(if $(findstring KIT_PROGRAM,$(defined)),$(shell \
              grep -qsw STAGE mass_spring.cpp && echo -DKIT_STAGES))
# What all programs are built with: another compiler builds them anew.
built_by  = $(B)/tests.built
build     = $(CXX) $(common) $(debug) $(CPPFLAGS) $(CXXFLAGS)
unit      = @mkdir -p $(@D); printf '\#include "%s"\n' $(1) >$(B)/tests/$*.cpp

.PHONY: test section
ifeq ($(SECTION),)
test:
	@bad=0; for s in $(sections); do \
	  $(MAKE) --no-print-directory test SECTION=$$s || bad=1; done; exit $$bad
else ifeq ($(filter $(sections),$(SECTION)),)
test:
	@echo "there is no section '$(SECTION)', expected one of: $(sections)"
	@exit 2
else
test: $(addprefix $(B)/tests/,$(if $(TASK), \
  $(or $(filter $(TASK),$(alone)),$(SECTION)),$(SECTION) $(alone)))
	@bad=0; for t in $^; do $$t $(TASK) || bad=1; done; exit $$bad
endif

# The tasks whose hints were opened are lines of $(B)/hints.
.PHONY: hint
ifeq ($(TASK),)
hint:
	@cat $(B)/hints 2>/dev/null | awk -F '\t' 'FILENAME == "-" { --n[$$0]; next } \
	  { ++n[$$1] } !all[$$1]++ { task[++k] = $$1 } END { for (i = 1; i <= k; ++i) \
	  if (n[task[i]] > 0) print task[i] ": " n[task[i]] " left" }' - tests/hints
else
hint:
	@cut -f 1 tests/hints | grep -qxF '$(TASK)' || \
	  { echo "TASK is '$(TASK)', expected one of:" \
	    $$(cut -f 1 tests/hints | uniq); exit 2; }
	@mkdir -p $(B) && echo '$(TASK)' >>$(B)/hints
	@awk -F '\t' -v task='$(TASK)' 'NR == FNR { n += $$0 == task; next } \
	  $$1 == task && ++all <= n { print "Hint " all ": " $$2 } \
	  END { print n < all ? all - n " left" : "That is all." }' \
	  $(B)/hints tests/hints | fold -sw 80
endif

.SECONDEXPANSION:
$(sections:%=$(B)/tests/%): $(B)/tests/%: $$(together) $(frame) $(built_by)
	@echo '$(CXX) $@'
	$(call unit,$(together))
	@$(if $(stages),$(CXX) $(stages) $(of_test) $(defined) $(sanitizer) -o $@ \
	  $(frame) $@.cpp 2>/dev/null ||) \
	$(CXX) $(of_test) $(defined) $(sanitizer) -o $@ $(frame) $@.cpp
$(counted:%=$(B)/tests/%): $(B)/tests/%: tests/%.cpp $(frame) $(built_by)
	@echo '$(CXX) $@'
	@$(CXX) $(of_test) -O1 -g1 -fsanitize-coverage=trace-pc -c -o $@.o $<
	@$(CXX) $(CXXFLAGS) -o $@ $(frame) $@.o
$(frame): $(B)/tests/%.o: tests/%.cpp tests/kit.cpp $(built_by)
	@echo '$(CXX) $@'
	$(call unit,tests/$*.cpp tests/kit.cpp)
	@$(CXX) $(of_test) -g1 -c -o $@ $(B)/tests/$*.cpp
$(built_by): FORCE
	@mkdir -p $(B); echo '$(build)' | cmp -s - $@ || echo '$(build)' >$@
-include $(wildcard $(B)/tests/*.d)
