# The targets: make help. The laboratory: lab/lab.mk; for teachers: course.mk
# Every .cpp here is one program: `make NAME` builds ./NAME. What it includes
# decides what it is linked with: a viewer brings SDL2 and OpenGL, gtest brings
# GoogleTest.

STAGE  ?= tear
STAGES  = problem1 diagonals forces constraints tear
VIEWER ?= 1
HW     ?= hw2
# Programs are built as $(O)NAME, all else in $(B).
O       =
B      ?= build

# tools/submit.sh gets these as they were given: make expands nothing in them.
override HW    := $(value HW)
override FORCE := $(value FORCE)
export HW FORCE

PROGRAMS := $(basename $(wildcard *.cpp))
DRIVERS  := mass_spring $(STAGES:%=mass_spring_%)
OTHERS   := $(filter-out $(DRIVERS),$(PROGRAMS))

# mass_spring is built for speed; any other program for the debugger, with all
# assertions, and with the sanitizers if it uses GoogleTest. FAST=1: for speed.
common    = -std=c++20 -g -Wall -Wextra -pthread -I.
speed     = $(or $(SPEED),-O3) -DNDEBUG -g1
debug     = -Og -fno-omit-frame-pointer
SANITIZE  = address,undefined
# Left out: checks that double the time to compile and find next to nothing.
unchecked = null,alignment,object-size,vptr,pointer-overflow
sanitizer = $(if $(SANITIZE),-fsanitize=$(SANITIZE) \
              -fno-sanitize-recover=all -fno-sanitize=$(unchecked))
# The compiler's options for the program $*.
stage     = $(or $(patsubst mass_spring_%,%,$(filter mass_spring_%,$*)),$(STAGE))
# sqrt() need not set errno: a twelfth of the instructions of a step.
mode      = $(if $(filter $(DRIVERS),$*),$(speed) -fno-math-errno \
              -DSTAGE=$(stage), \
              $(if $(FAST),$(speed),$(debug)))
flags     = $(common) $(mode) $(if $(filter 1,$(VIEWER)),-DMASS_SPRING_VIEWER) \
            $(CPPFLAGS) $(CXXFLAGS)

MAKEFLAGS += --no-builtin-rules
.PHONY: help all deps demo submit format clean FORCE
.SECONDARY .DELETE_ON_ERROR:

help:
	@echo 'make mass_spring        the cloth, last stage; STAGE=forces another, or'
	@echo '                        make mass_spring_forces; VIEWER=0 no window'
	@echo 'make test_nodes test_edges   the tests of the graph'
	@echo 'make demo               the cloth on data/grid2: all in one command'
	@echo 'make web                your cloth as one file, web.html; web-deps first'
	@echo 'make submit HW=hw2      tag and push; FORCE=1 moves the tag'
	@echo 'make starter OUT=DIR    what students start from; solution OUT=DIR'
	@echo 'make deps | clean | format'
	@echo 'make help-lab           the laboratory: ./cloth, charts, checks'
	@echo 'programs: $(PROGRAMS)'

gtest_libs = $(shell pkg-config --libs gtest_main 2>/dev/null || \
               echo -lgtest_main -lgtest)

# How to build a program, and $(B)/NAME.uses: what it includes, and so what it
# is linked with. NAME.uses is as new as a source dated in the future, or make
# would never end.
define build
@mkdir -p $(@D) && echo '$(CXX) $@$(no_window)'
@$(CXX) $(flags) $(draw_flags) $(if $(test),$(call system,gtest) \
  $(if $(FAST),,$(sanitizer))) \
  -o $@ $< $(draw_libs) $(if $(test),$(gtest_libs)) $(LDLIBS)
endef
define find_uses
@$(CXX) $(flags) -M -MG -MP -MT '$(O)$* $@' $< >$@
@! grep -q CME212/SDLViewer.hpp $@ || echo '$(O)$*: $(viewer_lib)' >>$@
@! grep -q gtest/gtest.h $@ || echo '$(O)$*: test = 1' >>$@
@for f in $^; do [ ! "$$f" -nt $@ ] || touch -r "$$f" $@; done
endef

$(DRIVERS:%=$(O)%): $(O)%: mass_spring.cpp $(B)/%.flags
	$(build)
$(OTHERS:%=$(O)%): $(O)%: %.cpp $(B)/%.flags
	$(build)
$(DRIVERS:%=$(B)/%.uses): $(B)/%.uses: mass_spring.cpp $(B)/%.flags
	$(find_uses)
$(OTHERS:%=$(B)/%.uses): $(B)/%.uses: %.cpp $(B)/%.flags
	$(find_uses)
# This file changes when the options do; then the program is built again.
$(B)/%.flags: FORCE
	@mkdir -p $(@D); echo '$(CXX) $(flags)' | cmp -s - $@ \
	  || echo '$(CXX) $(flags)' > $@

all: $(DRIVERS:%=$(O)%) $(OTHERS:%=$(O)%)
wanted = $(if $(filter all,$(MAKECMDGOALS)),$(DRIVERS) $(OTHERS), \
           $(filter $(DRIVERS) $(OTHERS),$(notdir $(MAKECMDGOALS))))
-include $(wanted:%=$(B)/%.uses)

deps:
	@tools/deps.sh

# In a window; without a display a picture and a film of the same run.
demo:
	@tools/deps.sh build window $$([ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] || echo film)
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
	rm -rf build demo cloth web.html $(DRIVERS) $(OTHERS)

include CME212/viewer.mk lab/lab.mk course/course.mk course/web/web.mk
