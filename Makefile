# The targets: make help. Those of the laboratory: lab/lab.mk
#
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

PROGRAMS := $(basename $(wildcard *.cpp))
DRIVERS   = mass_spring $(STAGES:%=mass_spring_%)

# The driver is built for speed, any other program for the debugger, with all
# assertions, and a program of GoogleTest under the sanitizers; FAST=1 asks for
# speed.
SANITIZE = address,undefined
# Left out: checks that take half of the time to compile, and find next to none.
unchecked = null,alignment,object-size,vptr,pointer-overflow
speed     = -O3 -DNDEBUG
debug     = -Og -fno-omit-frame-pointer
sanitizer = $(if $(SANITIZE),-fsanitize=$(SANITIZE) \
              -fno-sanitize-recover=all -fno-sanitize=$(unchecked))
system    = $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(1) 2>/dev/null))
draw_pkg  = sdl2 gl imgui libpng
stage_of  = $(or $(patsubst mass_spring_%,%,$(filter mass_spring_%,$*)),$(STAGE))
common    = -std=c++20 -g -Wall -Wextra -pthread -I. \
            $(if $(filter-out double,$(REAL)),-DREAL=$(REAL))
flags     = $(common) \
            $(if $(or $(FAST),$(filter $(DRIVERS),$*)),$(speed),$(debug)) \
            $(if $(filter $(DRIVERS),$*),-DSTAGE=$(stage_of)) \
            $(if $(filter 1,$(VIEWER)),-DMASS_SPRING_VIEWER) $(CPPFLAGS) $(CXXFLAGS)

MAKEFLAGS += --no-builtin-rules
.PHONY: help all deps demo submit format clean FORCE
.SECONDARY:
.DELETE_ON_ERROR:

help:
	@echo 'make mass_spring        the cloth, last stage; STAGE=forces another, or'
	@echo '                        make mass_spring_forces; VIEWER=0 no window'
	@echo 'make test_nodes test_edges   the tests of the graph'
	@echo 'make demo               the cloth on data/grid2: all in one command'
	@echo 'make submit HW=hw2      tag and push; FORCE=1 moves the tag'
	@echo 'make deps | clean | format'
	@echo 'make help-lab           the laboratory: ./cloth, charts, checks'
	@echo 'programs: $(PROGRAMS)'

# A program is built anew when its sources or its flags have changed.
define build
@mkdir -p $(dir $@) && echo '$(CXX) $@'; \
uses=$$($(CXX) $(flags) -M -MG $<) && draw= && test= && libs= && \
case "$$uses" in *_Viewer.hpp*|*SDLViewer.hpp*) \
  pkg-config --exists $(draw_pkg) || { echo "make $*: not all of $(draw_pkg) \
is installed: 'make deps' does it; 'make $* VIEWER=0' builds without a window" \
  >&2; exit 1; }; \
  draw='$(call system,$(draw_pkg))'; libs="$$(pkg-config --libs $(draw_pkg))";; \
esac; \
case "$$uses" in *gtest/gtest.h*) \
  test='$(if $(FAST),,$(sanitizer))'; libs="$$libs -lgtest_main -lgtest";; \
esac; \
$(CXX) $(flags) $$draw $$test -MMD -MP -MF $(B)/$*.d -MT $@ -o $@ $< $$libs $(LDLIBS)
endef
$(STAGES:%=$(O)mass_spring_%): $(O)%: mass_spring.cpp $(B)/%.flags
	$(build)
$(PROGRAMS:%=$(O)%): $(O)%: %.cpp $(B)/%.flags
	$(build)
$(B)/%.flags: FORCE
	@mkdir -p $(dir $@); echo '$(CXX) $(flags)' | cmp -s - $@ \
	  || echo '$(CXX) $(flags)' > $@

all: $(PROGRAMS:%=$(O)%) $(STAGES:%=$(O)mass_spring_%)
ifneq ($(O),)
.PHONY: $(PROGRAMS) $(STAGES:%=mass_spring_%) cloth
$(PROGRAMS) $(STAGES:%=mass_spring_%) cloth: %: $(O)%
endif

deps:
	@tools/deps.sh

# In a window; without a display a picture and a film of the same run.
demo: deps
	@if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ]; then \
	  $(MAKE) --no-print-directory mass_spring && \
	  ./mass_spring data/grid2.nodes data/grid2.tets; \
	else \
	  $(MAKE) --no-print-directory cloth && \
	  ./cloth --config data/scenes/tear.toml data/grid2.nodes data/grid2.tets; \
	fi

submit:
	@HW='$(HW)' FORCE='$(FORCE)' tools/submit.sh

clean:
	rm -rf build demo cloth $(PROGRAMS) $(STAGES:%=mass_spring_%)

include lab/lab.mk
