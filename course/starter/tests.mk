# The tests: make test [SECTION=3.2 | TASK=3.2.Problem1Force]
#
# The tests of a section are compiled as one program, with assertions and
# sanitizers: build/tests/3.2. One that counts what is done can't have
# sanitizers, and is a program of its own.

SECTION ?= $(basename $(TASK))
files    := $(wildcard tests/*.*.cpp)
sections := $(sort $(notdir $(basename $(files:.cpp=))))
counted  := $(patsubst tests/%.cpp,%, \
              $(shell grep -l '^// Build: counted' $(files) /dev/null))
alone     = $(filter $(SECTION).%,$(counted))
together  = $(filter-out $(counted:%=tests/%.cpp),$(wildcard tests/$*.*.cpp))
of_test   = $(common) $(debug) -O0 -Itests/headless -Itests \
            -include tests/prelude.hpp -DKIT_TESTS='"tests"' \
            -MMD -MP -MF $@.d -MT $@
wrap      = $(foreach f,move cpy set chr cmp,-Wl,--wrap=mem$(f))

.PHONY: test section
test:
	@bad=0; for s in $(or $(SECTION),$(sections)); do \
	  $(MAKE) --no-print-directory section SECTION=$$s || bad=1; done; \
	  exit $$bad
ifneq ($(filter-out $(sections),$(SECTION)),)
section:
	@echo "there is no section '$(SECTION)', expected one of: $(sections)"
	@exit 2
else
section: $(addprefix $(B)/tests/,$(if $(TASK), \
  $(or $(filter $(TASK),$(alone)),$(SECTION)),$(SECTION) $(alone)))
	@bad=0; for t in $^; do $$t $(TASK) || bad=1; done; exit $$bad
endif

.SECONDEXPANSION:
$(sections:%=$(B)/tests/%): $(B)/tests/%: $$(together) $(B)/tests/main.o
	@echo '$(CXX) $@'
	@printf '#include "%s"\n' $(together) >$@.cpp
	@$(CXX) $(of_test) $(sanitizer) -I. -o $@ $@.cpp $(B)/tests/main.o
$(counted:%=$(B)/tests/%): $(B)/tests/%: tests/%.cpp $(B)/tests/main.o
	@echo '$(CXX) $@'
	@$(CXX) $(of_test) -O1 -fsanitize-coverage=trace-pc -c -o $@.o $<
	@$(CXX) -o $@ $@.o $(B)/tests/main.o $(wrap)
$(B)/tests/main.o: tests/main.cpp
	@mkdir -p $(@D) && $(CXX) $(of_test) -c -o $@ $<
-include $(wildcard $(B)/tests/*.d)
