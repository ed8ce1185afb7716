# What measures, draws and searches: make help-lab. Results lie in the folder
# results of their room; a quick run draws in $(B)/charts.

.PHONY: adviser-suite charts compile_commands.json crossings figures fuzz grids \
        method-costs orders peers-chart peers-deps pictures reference speed \
        stability stability-soak try

help-lab:
	@echo 'make cloth              the laboratory: ./cloth --help; lab/README.md'
	@echo 'make test_NAME          a test of tests/, as build/test_NAME'
	@echo 'make quick | check | check-full   what a commit must pass, in 2 and 6'
	@echo '                        minutes; all else'
	@echo 'make try FILE=mine.hpp  what a step of your own is worth; STEP=my_step:'
	@echo '                        lab/try/README.md'
	@echo 'make charts             work and precision: lab/charts/README.md;'
	@echo '                        QUICK=1, SCENE=grid1, METHODS=verlet,pefrl'
	@echo 'make figures            draws all charts, corrects the numbers in the text'
	@echo 'make stability          the stability maps, on all cores; QUICK=1'
	@echo 'make stability-soak     thousands of random scenes at the safe step'
	@echo 'make crossings          drawn scenes against an independent oracle;'
	@echo '                        N=600 SEED=7 PROMISE=healthy FIELD="drag dt=auto"'
	@echo 'make orders             the order of every method, measured'
	@echo 'make method-costs       what a step costs in steps of Verlet'
	@echo 'make speed              what a step costs here: lab/bench/README.md'
	@echo 'make adviser-suite      how often --advise is right: lab/advice/README.md'
	@echo 'make peers-deps peers-chart   other libraries beside ours'
	@echo 'make pictures           the pictures of the documents'
	@echo 'make page | page-serve | page-deps   the web page: lab/page/README.md'
	@echo 'make python-deps python   the module for Python: docs/python.md'
	@echo 'make site               the course and the laboratory as a web site'
	@echo 'make reference          the contracts of all headers, by Doxygen'
	@echo 'make grids | data/grid4.nodes   the grids; one of a million nodes'
	@echo 'make fuzz               the parsers of meshes; RUNS=200000, needs clang'
	@echo 'programs: cloth $(sort $(filter-out cloth,$(LAB_PROGRAMS)) $(call names,$(lab_others)))'

sub  = $(MAKE) --no-print-directory
draw = python3 lab/charts/draw.py

# Scenes drawn from the table of fields keep what a run promises.
crossings: $(B)/cloth
	@/usr/bin/python3 tests/crossings/crossings.py $< $(N:%=--scenes %) $(SEED:%=--seed %) \
	  $(PROMISE:%=--promise %) $(FIELD:%=--field %) $(LEAST:%=--least %)

# How each source is compiled, for editors and clangd.
compile_commands.json:
	@$(MAKE) -Bn all cloth $(LAB_TESTS:%=$(B)/%) | python3 -c 'import json, os, re, sys; print(json.dumps( \
	  [{"directory": os.getcwd(), "command": line.strip(), "file": found[1]} for line in sys.stdin \
	  if (found := re.search(r" -c -o \S+ (\S+\.cpp)$$", line))], indent=1))' > $@

# The contracts of all headers as a web site in build/reference.
reference:
	@tools/deps.sh reference
	@mkdir -p $(B) && printf '%s\n' PROJECT_NAME=mass_spring QUIET=YES RECURSIVE=YES \
	  'INPUT=. README.md' 'FILE_PATTERNS=*.hpp' EXCLUDE_PATTERNS='*/build/* */tests/* */course/*' \
	  USE_MDFILE_AS_MAINPAGE=README.md JAVADOC_AUTOBRIEF=YES EXTRACT_ALL=YES SOURCE_BROWSER=YES \
	  USE_MATHJAX=YES HAVE_DOT=NO GENERATE_LATEX=NO WARN_LOGFILE=/dev/null OUTPUT_DIRECTORY=$(B) \
	  HTML_OUTPUT=reference | doxygen -
	@echo '$(B)/reference/index.html: the contract of each class and function'

# All charts, and the figures of the text, from the CSV files as they are.
figures:
	@$(draw)
	@python3 lab/charts/figures.py --write

# ---- A step of your own: lab/try/README.md. As it was given: FILE is read by
# no shell.
override FILE := $(value FILE)
override STEP := $(value STEP)
try: export FILE := $(FILE)
try: export STEP := $(STEP)
override RECORD := $(value RECORD)
try:
	@echo "make try: compiles and measures the step in $${FILE:-no file}," \
	  "within a minute" >&2
	@tools/deps.sh grade draw && python3 lab/try/try.py

# ---- Charts: lab/charts/README.md

charts: work_precision
	@MEASURED="$(measured_on)" BUILD='$(B)' QUICK='$(QUICK)' SCENE='$(SCENE)' METHODS='$(METHODS)' \
	  lab/charts/make.sh

# Cells of an earlier program are measured anew.
EFFORT = $(if $(QUICK),quick,full)
SWEEP  = $(B)/stability/$(EFFORT)
maps_in = $(if $(QUICK),$(B)/charts,lab/charts/results)
stability: stability_map
	@mkdir -p $(SWEEP) $(maps_in)
	@find $(SWEEP) -name '*.csv' ! -newer $(B)/stability_map -delete
	@$(B)/stability_map $(SWEEP) --effort $(EFFORT)
	@cp $(SWEEP)/stability_*.csv $(maps_in)
	@sed -i "1i # $(measured_on)" $(maps_in)/stability_limits.csv
	@$(draw) stability_limits --folder $(maps_in)

# More of test_limits than a commit needs: grids up to 100 x 100 nodes, and
# SCENES random scenes, the methods in turn; and 1,000 by --dt auto.
SCENES ?= 7000
stability-soak:
	@$(sub) test_limits B=$(B)/soak SANITIZE= CXXFLAGS='-O3 $(CXXFLAGS)'
	LIMITS_SIDES=100 SOAK_SCENES=$(SCENES) $(B)/soak/test_limits
	@$(sub) test_step_control B=$(B)/soak SANITIZE= CXXFLAGS='-O3 $(CXXFLAGS)'
	SOAK_SCENES=1000 SOAK_SECONDS=60 $(B)/soak/test_step_control

# The table of measured orders in lab/methods/README.md.
orders: test_orders
	@$(B)/test_orders | grep -e '^|' -e FAILED

# Cost of a step, in steps of Verlet: to the methods' cards.
method-costs: bench_methods
	@$(B)/bench_methods > $(B)/costs.sed
	@sed -i "s|^  // .*, commit .*|  // $(measured_on)|" lab/methods/Method.hpp
	@sed -i -f $(B)/costs.sed lab/methods/*.hpp

# ---- Advice: lab/advice/README.md, on ADVISED random scenes from seed FIRST.

ADVISED ?= 60
FIRST   ?= 901
adviser-suite: $(B)/cloth
	lab/advice/suite.py --cloth $< --out $(B)/adviser.csv --first $(FIRST) \
	  --scenes $(ADVISED) --by-hand $(if $(JOBS),--jobs $(JOBS))
	@sed -i "1i # $(measured_on)" $(B)/adviser.csv
	@mv $(B)/adviser.csv lab/advice/results
	@$(draw) adviser

# ---- Speed: lab/bench/README.md

# g++ 12 takes the undefined vectors in its own AVX-512 headers for mistakes.
native = -march=native -Wno-maybe-uninitialized
speed:
	@$(sub) bench B=$(B)/native CXXFLAGS='$(native) $(CXXFLAGS)'
	@MEASURED="$(measured_on)" lab/bench/speed.sh $(B)/native/bench

# Written whole: a run that fails leaves the results alone.
# A tree that differs from its last commit is measured "after" that.
measured_on = $$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), \
  $$($(CXX) --version | head -n 1), commit \
  $$(git diff --quiet HEAD -- . ':!*/results/*' || printf 'after ')$$(git \
  describe --always)

# Other libraries beside ours: lab/bench/peers/README.md
peers := lab/bench/peers
$(eval $(call program,$(B)/peers,$(B),$(peers)/peers.cpp,$(speed), \
  -lsundials_cvode -lsundials_arkode -lsundials_nvecserial \
  -lsundials_sunnonlinsolfixedpoint -lgsl -lgslcblas))

peers-deps:
	@tools/deps.sh peers
peers-chart: $(B)/peers
	@{ echo "# $(measured_on)" && $(B)/peers; } > $(B)/peers.csv
	@mv $(B)/peers.csv lab/bench/results/peers.csv
	@$(draw) peers

# ---- Grids and pictures

data/grid4.nodes data/grid4.tets &: data/make_grid.py
	$< 1000 data/grid4
# The committed grids: what they are made by, and checked against.
grids:
	@for k in 0:5 1:25 2:50 3:100; do \
	  data/make_grid.py $${k#*:} $(or $(TO),data)/grid$${k%:*} || exit 1; done

# Look at them. Those in tests/pictures are what test_screen compares with.
# A failure exits with 3.
pictures: test_screen $(B)/cloth
	WRITE_PICTURES=1 ASAN_OPTIONS=detect_leaks=0 $(B)/test_screen
	@draw() { $(B)/cloth --quiet --screenshot "docs/pictures/$$@"; }; set -e; \
	scenes=data/scenes; \
	draw cloth.png --config $$scenes/tear.toml data/grid3.* --dt 0.0005 \
	  --t-end 0.6 --strain; \
	for scene in $(filter-out $(STAGES),$(call names,$(wildcard data/scenes/*.toml))); do \
	  draw scene-$$scene.png --config $$scenes/$$scene.toml \
	    $$(case $$scene in (tablecloth|push|mixed) echo --strain; esac); done; \
	for scene in step path below-the-limit drag forward-euler midpoint; do status=0; \
	  draw fail-$$scene.png --config $$scenes/failures/$$scene.toml \
	    || status=$$?; \
	  [ $$status = 3 ] || { echo "$$scene does not fail" >&2; exit 1; }; done
	@tools/strip.sh $(B)/cloth docs/pictures/stages.png $(STAGES)
	@tools/shrink_pictures.sh docs/pictures/*.png
	@$(B)/cloth --quiet --config data/scenes/tear.toml data/grid2.* \
	  --t-end 1.2 --slow-motion 10 --record $(B)/loop.mp4
	@tools/loop.sh $(B)/loop.mp4 docs/pictures/tear.gif

# ---- Fuzzing. The inputs that it starts from: tools/corpus.

RUNS ?= 200000
$(B)/fuzz_mesh: tests/fuzz_mesh.cpp $(patsubst %,lab/scenes/%.cpp,MeshFile NetBinary NetFile \
                Interrupt) lab/scenes/MeshFile.hpp lab/scenes/NetFile.hpp CME212/Mesh.hpp CME212/Util.hpp \
                CME212/Point.hpp
	@mkdir -p $(B)
	clang++ -std=c++20 -g -O1 -Wall -Wextra -I. -o $@ $(filter %.cpp,$^) \
	  -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all
fuzz: $(B)/fuzz_mesh
	@mkdir -p $(B)/corpus
	$< -runs=$(RUNS) -max_len=256 -print_final_stats=1 \
	  -artifact_prefix=$(B)/ -verbosity=0 $(B)/corpus tools/corpus
