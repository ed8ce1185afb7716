# The targets: make help. The laboratory: lab/lab.mk; for teachers: course.mk
# Every .cpp here is one program: `make NAME` builds ./NAME. What it includes
# decides what it is linked with: a viewer brings SDL2 and OpenGL, gtest brings
# GoogleTest.

STAGE  ?= tear
STAGES  = problem1 diagonals forces constraints tear
VIEWER ?= 1
REAL   ?= double
HW     ?= hw2
O       =
B      ?= build

# As they were given, whatever they hold: never expanded, and read by no shell.
override HW    := $(value HW)
override FORCE := $(value FORCE)
export HW FORCE

PROGRAMS := $(basename $(wildcard *.cpp))
DRIVERS  := mass_spring $(STAGES:%=mass_spring_%)
BUILT    := $(sort $(PROGRAMS) $(DRIVERS))

# The driver is built for speed, any other program for the debugger, with all
# assertions, and a program of GoogleTest under the sanitizers; FAST=1 asks for
# speed.
SANITIZE = address,undefined
# Left out: checks that take half of the time to compile, and find next to none.
unchecked = null,alignment,object-size,vptr,pointer-overflow
speed     = $(or $(SPEED),-O3) -DNDEBUG -g1
debug     = -Og -fno-omit-frame-pointer
sanitizer = $(if $(SANITIZE),-fsanitize=$(SANITIZE) \
              -fno-sanitize-recover=all -fno-sanitize=$(unchecked))
system    = $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(1) 2>/dev/null))
stage_of  = $(or $(patsubst mass_spring_%,%,$(filter mass_spring_%,$*)),$(STAGE))
common    = -std=c++20 -g -Wall -Wextra -pthread -I. \
            $(if $(filter-out double,$(REAL)),-DREAL=$(REAL))
flags     = $(common) \
            $(if $(or $(FAST),$(filter $(DRIVERS),$*)),$(speed),$(debug)) \
            $(if $(filter $(DRIVERS),$*),-DSTAGE=$(stage_of)) \
            $(if $(filter 1,$(VIEWER)),-DMASS_SPRING_VIEWER) $(CPPFLAGS) $(CXXFLAGS)

MAKEFLAGS += --no-builtin-rules
.PHONY: help all deps demo submit format clean FORCE
.SECONDARY .DELETE_ON_ERROR:

help:
	@echo 'make mass_spring        the cloth, last stage; STAGE=forces another, or'
	@echo '                        make mass_spring_forces; VIEWER=0 no window'
	@echo 'make test_nodes test_edges   the tests of the graph'
	@echo 'make demo               the cloth on data/grid2: all in one command'
	@echo 'make submit HW=hw2      tag and push; FORCE=1 moves the tag'
	@echo 'make starter OUT=DIR    what students start from; solution OUT=DIR'
	@echo 'make deps | clean | format'
	@echo 'make help-lab           the laboratory: ./cloth, charts, checks'
	@echo 'programs: $(PROGRAMS)'

# A program is built anew when its sources or its flags have changed. What it
# includes, and so what it is linked with, is found first: $(B)/NAME.uses. That
# is as new as a source dated in the future, or make would never end.
source = $(if $(filter $(DRIVERS),$*),mass_spring,$*).cpp
.SECONDEXPANSION:
$(BUILT:%=$(O)%): $(O)%: $$(source) $(B)/%.flags
	@mkdir -p $(dir $@) && echo '$(CXX) $@'
	@$(CXX) $(flags) $(draw_flags) $(if $(test),$(if $(FAST),,$(sanitizer))) \
	  -o $@ $< $(draw_libs) $(if $(test),-lgtest_main -lgtest) $(LDLIBS)
$(BUILT:%=$(B)/%.uses): $(B)/%.uses: $$(source) $(B)/%.flags
	@$(CXX) $(flags) -M -MG -MP -MT '$(O)$* $@' $< >$@
	@! grep -q CME212/SDLViewer.hpp $@ || echo '$(O)$*: $(B)/libviewer.a' >>$@
	@! grep -q gtest/gtest.h $@ || echo '$(O)$*: test = 1' >>$@
	@for f in $^; do [ ! "$$f" -nt $@ ] || touch -r "$$f" $@; done
$(B)/%.flags: FORCE
	@mkdir -p $(dir $@); echo '$(CXX) $(flags)' | cmp -s - $@ \
	  || echo '$(CXX) $(flags)' > $@
-include $(patsubst %,$(B)/%.uses,$(if $(filter all,$(MAKECMDGOALS)),$(BUILT), \
  $(filter $(BUILT),$(notdir $(MAKECMDGOALS)))))

all: $(BUILT:%=$(O)%)
ifneq ($(O),)
.PHONY: $(BUILT) cloth
$(BUILT) cloth: %: $(O)%
endif

deps:
	@tools/deps.sh

# In a window; without a display a picture and a film of the same run.
demo: deps
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ]; then \
	  $(MAKE) --no-print-directory $(O)mass_spring && \
	  ./$(O)mass_spring data/grid2.nodes data/grid2.tets; \
	else \
	  $(MAKE) --no-print-directory $(B)/demo && \
	  $(B)/demo; \
	fi

submit:
	@tools/submit.sh

clean:
	rm -rf build demo cloth $(BUILT)

include CME212/viewer.mk lab/lab.mk course/course.mk
