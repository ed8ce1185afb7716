# The web page: make page writes $(B)/page, which any browser opens.
#
# The course's code and that of the laboratory which reads and writes no files,
# by clang++ to WebAssembly: make page-deps. lab/page/README.md

# By the newest clang that has what WebAssembly needs at run time.
PAGE_CXX ?= $(or $(patsubst %/lib/clang,%/bin/clang++,$(shell ls -d \
  /usr/lib/llvm-*/lib/clang/*/lib/wasi 2>/dev/null | sort -V | tail -n 1 | \
  sed 's|/[^/]*/lib/wasi$$||')),clang++)
page    := $(B)/page
page_o  := $(B)/page.o
# All of these rooms of the laboratory, except what reads or writes files or
# measures processor time.
page_source := $(filter-out lab/page/page_positions.cpp $(patsubst \
  %,lab/scenes/%.cpp, Interrupt Memory MeshFile NetBinary NetFile Warnings) \
  lab/stepping/Checkpoint.cpp lab/fast/FastestCpu.cpp, \
  $(wildcard $(patsubst %,lab/%/*.cpp,fast methods stability scenes stepping live page))) \
  course/web/thrown.cpp
page_objects := $(page_source:%.cpp=$(page_o)/%.o) $(page_o)/stored_scenes.o
page_target = --target=wasm32-wasi -Wno-deprecated
page_flags = $(page_target) -std=c++20 -O2 -DNDEBUG -Wall -Wextra \
  -msimd128 -I. $(call system,eigen3) -fno-math-errno -ffp-contract=off
page_names = $(sort $(shell grep -oE '\bpage_[a-z_]+' lab/page/Page.hpp))

.PHONY: page page-deps page-picture page-serve
page: $(page)/index.html $(page)/loop.webp
	@echo "$(page)/index.html: $$(du -bc $(page)/* | tail -n 1 | cut -f 1) bytes"

$(page_o)/%.o: %.cpp $(page_o)/flags
	@mkdir -p $(@D) && echo '$(PAGE_CXX) $@'
	@$(PAGE_CXX) $(page_flags) -include course/web/wasi.hpp -MMD -MP -c -o $@ $<
# This header alone: others beside it, as of /usr/include, are not for
# WebAssembly.
$(page_o)/lab/scenes/KeyValues.o: page_flags += -isystem $(page_o)/include
$(page_o)/lab/scenes/KeyValues.o: | $(page_o)/include/toml++
$(page_o)/include/toml++:
	@mkdir -p $(@D) && ln -sfn "$$(pkg-config --variable=includedir \
	  tomlplusplus)/toml++" $@
$(page_o)/flags: FORCE
	@mkdir -p $(@D); echo '$(PAGE_CXX) $(page_flags)' | cmp -s - $@ \
	  || echo '$(PAGE_CXX) $(page_flags)' > $@
$(page_o)/cloth.wasm: $(page_objects) lab/page/Page.hpp
	@echo 'link $@'
	@$(PAGE_CXX) $(page_target) -O2 -mexec-model=reactor -Wl,--no-entry \
	  -Wl,--stack-first -Wl,-z,stack-size=1048576 -Wl,--strip-all \
	  -Wl,--export=__stack_pointer -Wl,--export=page_thrown \
	  $(page_names:%=-Wl,--export=%) -o $@ $(page_objects)

$(page)/index.html: $(page_o)/cloth.wasm $(wildcard $(patsubst \
  %,lab/page/*.%,js py html css) $(patsubst %,course/web/*.%,js css py))
	@mkdir -p $(@D)
	@python3 lab/page/assemble.py $< $@
# Shown by a browser that can't run the page: half as large, 8 frames a second.
$(page)/loop.webp: docs/pictures/tear.gif
	@mkdir -p $(@D)
	@ffmpeg -loglevel error -y -i $< -vf fps=8,scale=320:-1:flags=lanczos \
	  -loop 0 -quality 40 $@

page-picture: page
	@/usr/bin/python3 lab/page/picture.py $(page)/index.html docs/pictures/page.png
	@tools/shrink_pictures.sh docs/pictures/page.png

page-deps:
	@tools/deps.sh page
page-serve: page
	@python3 -m http.server -d $(page) 8000
