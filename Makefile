# The targets: make help
#
# Every .cpp here is one program: `make NAME` builds ./NAME. With another
# compiler, other flags or in another place:
#   make NAME CXX=clang++ CXXFLAGS=-march=native O=build/native/

STAGE  ?= tear
STAGES  = problem1 diagonals forces constraints tear
VIEWER ?= 1
CHOLMOD ?= 1
HW     ?= hw2
REAL   ?= double
OPENMP ?= 1
O       =
SANITIZE = address,undefined

PROGRAMS := $(basename $(wildcard *.cpp))
TESTS    := $(filter test_%,$(PROGRAMS))
EXAMPLES := $(filter example_%,$(PROGRAMS))
# What draws, and so needs SDL2, OpenGL, Dear ImGui and libpng:
DRAWING   = mass_spring mass_spring_% test_viewer test_screen

# Programs are built for speed and without assertions, tests and examples with
# all of them, for the debugger and under the sanitizers. Left out are checks
# that take half of the time to compile, and of which the one of addresses finds
# nearly all. Programs in QUICKLY are built in half of the time.
release  = $(if $(filter $(QUICKLY),$*),-O1,-O3) -DNDEBUG
unchecked = null,alignment,object-size,vptr,pointer-overflow
testing  = -Og -fno-omit-frame-pointer \
           $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all \
             -fno-sanitize=$(unchecked))
draws    = $(and $(filter $(DRAWING),$*),$(filter 1,$(VIEWER)))
draw_pkg = sdl2 gl imgui libpng
stage_of = $(or $(patsubst mass_spring_%,%,$(filter mass_spring_%,$*)),$(STAGE))
eigen   := $(patsubst -I%,-isystem %,$(shell pkg-config --cflags eigen3 2>/dev/null))
# Where CHOLMOD is installed it factors sparse matrices, unless CHOLMOD=0.
cholmod := $(if $(filter 1,$(CHOLMOD)),$(shell $(CXX) $(CPPFLAGS) \
  -fsyntax-only -x c++ -include suitesparse/cholmod.h /dev/null \
  >/dev/null 2>&1 && echo -DMASS_SPRING_CHOLMOD))
# No product and sum in one rounding: the same bits on every processor.
flags    = -std=c++20 -g -Wall -Wextra -fno-math-errno -ffp-contract=off \
           $(if $(filter 1,$(OPENMP)),-fopenmp) -pthread -I. $(eigen) $(cholmod) \
           $(if $(filter-out double,$(REAL)),-DREAL=$(REAL)) \
           $(if $(filter test_% example_%,$*),$(testing),$(release)) \
           $(if $(filter mass_spring%,$*),-DSTAGE=$(stage_of)) \
           $(if $(draws),-DMASS_SPRING_VIEWER \
             $(patsubst -I%,-isystem %,$(shell pkg-config --cflags $(draw_pkg) 2>/dev/null))) \
           $(CPPFLAGS) $(CXXFLAGS)
libs     = $(if $(filter test_%,$*),-lgtest_main -lgtest -lrapidcheck) \
           $(if $(filter bench%,$*),-lbenchmark) \
           $(if $(draws),$(shell pkg-config --libs $(draw_pkg) 2>/dev/null)) \
           $(LDLIBS) $(lcholmod)
lcholmod = $(cholmod:-D%=-Wl,--as-needed -lcholmod)

MAKEFLAGS += --no-builtin-rules
.PHONY: adviser-suite speed stability stability-soak cells charts charts-quick orders all deps peers-deps \
        peers-chart peers-bench demo check check-all print-tests fuzz pictures help clean \
        format submit grids FORCE
.SECONDARY:
.DELETE_ON_ERROR:

help:
	@echo 'make demo               the cloth on data/grid2: all in one command'
	@echo 'make mass_spring        the last stage; STAGE=forces another, or'
	@echo '                        make mass_spring_forces; VIEWER=0 no window'
	@echo 'make test_nodes ...     a test, under the sanitizers'
	@echo 'make orders             the order of every method, measured'
	@echo 'make check              everything that a commit must pass'
	@echo 'make speed              what a step costs here: docs/speed.md'
	@echo 'make stability          the stability maps: charts/README.md; QUICK=1'
	@echo 'make peers-bench        our graph beside other libraries: peers/README.md'
	@echo 'make data/grid4.nodes   a grid of a million nodes'
	@echo 'make submit HW=hw2      tag and push; FORCE=1 moves the tag'
	@echo 'make all | format | clean | deps'
	@echo 'programs: $(PROGRAMS)'

all: $(PROGRAMS:%=$(O)%) $(STAGES:%=$(O)mass_spring_%)

needs    = $(if $(draws),$(draw_pkg)) \
           $(if $(filter mass_spring% work_precision stability_map bench bench_% test_m% \
             test_orders test_limits test_stability test_implicit test_scene,$*),CLI11 eigen3)
missing  = echo "make $*: not all of $(strip $(needs)) is installed:" \
  "'make deps' does it$(if $(draws),; 'make $* VIEWER=0' builds without a window)" >&2
# A program is built anew when its sources or its flags have changed.
define build
@$(if $(strip $(needs)),pkg-config --exists $(needs) || { $(missing); exit 1; };) \
mkdir -p $(dir $@) && echo '$(CXX) $@' && \
$(CXX) $(flags) -MMD -MP -MF build/$@.d -MT $@ -o $@ $< $(libs)
endef
$(STAGES:%=$(O)mass_spring_%): $(O)%: mass_spring.cpp build/$(O)%.flags
	$(build)
$(PROGRAMS:%=$(O)%): $(O)%: %.cpp build/$(O)%.flags
	$(build)
ifneq ($(O),)
.PHONY: $(PROGRAMS) $(STAGES:%=mass_spring_%)
$(PROGRAMS) $(STAGES:%=mass_spring_%): %: $(O)%
endif
build/$(O)%.flags: FORCE
	@mkdir -p $(dir $@); echo '$(CXX) $(flags)' | cmp -s - $@ \
	  || echo '$(CXX) $(flags)' > $@
-include $(wildcard build/*.d build/*/*.d build/*/*/*.d)

deps:
	@tools/deps.sh
peers-deps:
	@tools/deps.sh peers

# Other libraries beside ours: see peers/README.md. About four minutes.
build/peers: peers/peers.cpp $(wildcard *.hpp)
	@mkdir -p build
	$(CXX) $(flags) -o $@ $< -lsundials_cvode -lsundials_arkode \
	  -lsundials_nvecserial -lsundials_sunlinsolspgmr \
	  -lsundials_sunnonlinsolfixedpoint -lgsl -lgslcblas $(lcholmod)
peers-chart: build/peers
	{ echo "# $$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1);" \
	    "$$($(CXX) --version | head -n 1);" \
	    "commit $$(git describe --always --dirty)"; \
	  build/peers; } > build/peers.csv
	mv build/peers.csv charts/peers.csv
	gnuplot -e "csv='charts/peers.csv'; out='charts/peers.svg'" \
	  peers/chart.gp

# Graphs and a cloth of other libraries beside ours: about two minutes.
build/graph_peers: peers/graph_peers.cpp peers/contenders.hpp $(wildcard *.hpp)
	@mkdir -p build
	$(CXX) $(flags) -march=native -isystem /usr/include/bullet -o $@ $< \
	  -lbenchmark -lBulletSoftBody -lBulletDynamics -lBulletCollision \
	  -lLinearMath
peers-bench: build/graph_peers
	@echo "$$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)," \
	  "$$($(CXX) --version | head -n 1)," \
	  "commit $$(git describe --always --dirty)"
	@taskset -c 0 build/graph_peers

demo: deps
	@$(MAKE) --no-print-directory mass_spring
	./mass_spring data/grid2.nodes data/grid2.tets

data/grid4.nodes data/grid4.tets &: make_grid
	./make_grid 1000 data/grid4
# The committed grids: what they are made by, and checked against.
grids: make_grid
	@for k in 0:5 1:25 2:50 3:100; do \
	  ./make_grid $${k#*:} $(or $(TO),data)/grid$${k%:*} || exit 1; done

check: deps
	@$(MAKE) --no-print-directory check-all

check-all:
	@tools/check.sh
print-tests:
	@echo $(TESTS)

# More of test_limits than a commit needs: grids up to 100 x 100 nodes, and
# SCENES random scenes, the methods in turn.
SCENES ?= 7000
stability-soak:
	@$(MAKE) --no-print-directory build/soak/test_limits O=build/soak/ \
	  SANITIZE= CXXFLAGS='-O3 $(CXXFLAGS)'
	LIMITS_SIDES=100 SOAK_SCENES=$(SCENES) build/soak/test_limits

# The pictures of the README and of docs, and those that test_screen compares
# with, tests/pictures: look at them. A failure exits with 3.
pictures: test_screen mass_spring mass_spring_problem1 mass_spring_diagonals mass_spring_forces
	WRITE_PICTURES=1 ASAN_OPTIONS=detect_leaks=0 ./test_screen
	./mass_spring data/grid3.* --dt 0.0005 --t-end 0.6 --strain --quiet \
	  --screenshot docs/pictures/cloth.png
	@for scene in scenes/*.toml; do name=$$(basename $$scene .toml); \
	  ./mass_spring --config $$scene --quiet $$(case $$name in \
	    (tablecloth|push) echo --strain; esac) --screenshot docs/pictures/scene-$$name.png || exit 1; \
	done
	@for run in 'step diagonals grid3' 'drag forces grid1 --damping 3' \
	  'euler problem1 grid1 --method forward-euler --dt 1e-4' \
	  'midpoint forces grid1 --method implicit-midpoint --dt 0.0333'; do \
	  set -- $$run; name=$$1 stage=$$2 grid=$$3; shift 3; \
	  ./mass_spring_$$stage data/$$grid.* "$$@" --quiet \
	    --screenshot docs/pictures/fail-$$name.png; \
	  [ $$? = 3 ] || { echo "fail-$$name does not fail"; exit 1; }; done
	tools/shrink_pictures.sh docs/pictures/*.png

# The charts, charts/README.md; QUICK=1, SCENE=grid1 or METHODS=verlet,pefrl
# draws them in build/charts.
charts: work_precision
	@$(MAKE) --no-print-directory work_precision REAL=float O=build/float/
	@QUICK='$(QUICK)' SCENE='$(SCENE)' METHODS='$(METHODS)' charts/make.sh
charts-quick:
	@$(MAKE) --no-print-directory charts QUICK=1

# How often --advise is right, docs/advice.md, on ADVISED random scenes.
ADVISED ?= 100
adviser-suite: adviser_suite
	./adviser_suite --scenes $(ADVISED) --out charts/adviser.csv
	@gnuplot -e "csv='charts/adviser.csv'; out='charts/adviser.svg'" \
	  charts/adviser.gp

# What a step costs on this machine, docs/speed.md: charts/speed.sh.
speed:
	@$(MAKE) --no-print-directory build/native/bench O=build/native/ \
	  CXXFLAGS='-march=native $(CXXFLAGS)'
	@$(MAKE) --no-print-directory build/float/bench O=build/float/ REAL=float \
	  CXXFLAGS='-march=native $(CXXFLAGS)'
	@charts/speed.sh

# The table of measured orders in docs/methods.md.
orders: test_orders
	@./test_orders | grep -e '^|' -e FAILED

# The stability maps, charts/README.md: a list of runs, each with a file of its
# own, so that a sweep goes on where it was interrupted. QUICK=1 draws in
# build/charts; `make cells` runs what $(SWEEP)/list names, and no more.
EFFORT  = $(if $(QUICK),quick,full)
SWEEP   = build/stability/$(EFFORT)
effort  = $(filter-out --full,--$(EFFORT))
stability: stability_map
	@mkdir -p $(SWEEP) && ./stability_map --list $(effort) > $(SWEEP)/list
	@$(MAKE) --no-print-directory $(if $(filter -j%,$(MAKEFLAGS)),,-j$$(nproc)) \
	  cells EFFORT=$(EFFORT) SWEEP=$(SWEEP)
	@charts/stability.sh $(EFFORT) $(SWEEP)
ifneq ($(filter cells,$(MAKECMDGOALS)),)
cells: $(patsubst %,$(SWEEP)/%.csv,$(shell cut -d' ' -f1 $(SWEEP)/list))
$(SWEEP)/%.csv: stability_map
	@./stability_map --cell $* $(effort) --out $@
	@charts/stability.sh progress $(SWEEP)
endif

# Needs clang. The inputs that it starts from: tools/corpus.
RUNS ?= 200000
build/fuzz_mesh: tools/fuzz_mesh.cpp Mesh.hpp CME212/Util.hpp CME212/Point.hpp
	@mkdir -p build
	clang++ -std=c++20 -g -O1 -Wall -Wextra -I. -o $@ $< \
	  -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all
fuzz: build/fuzz_mesh
	@mkdir -p build/corpus
	build/fuzz_mesh -runs=$(RUNS) -max_len=256 -print_final_stats=1 \
	  -artifact_prefix=build/ -verbosity=0 build/corpus tools/corpus

format:
	clang-format -i *.hpp *.cpp CME212/*.hpp tools/*.cpp

submit:
	@HW='$(HW)' FORCE='$(FORCE)' tools/submit.sh

clean:
	rm -rf build demo $(PROGRAMS) $(STAGES:%=mass_spring_%)
