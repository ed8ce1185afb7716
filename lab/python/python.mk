# The module mass_spring for Python, in build/python: docs/python.md

.PHONY: python python-deps python-is python-flags python-version
# The first Python that has NumPy.
PYTHON ?= $(shell python3 -c 'import numpy' 2>/dev/null && echo python3 \
            || echo /usr/bin/python3)
python_has = $(shell $(PYTHON) -c 'import sysconfig; print(sysconfig.$(1))')
# Where Python's own headers and pybind11's are.
python_flags = $(if $(wildcard lab/python), \
  -isystem $(call python_has,get_path("include")) \
  $(shell $(PYTHON) -m pybind11 --includes 2>/dev/null))
package    = $(B)/python/mass_spring
module     = $(package)/__init__$(call python_has,get_config_var("EXT_SUFFIX"))

python-is:
	@echo $(PYTHON)
python-flags:
	@echo $(python_flags)
python-version:
	@sed -n 's/.*version = "\(.*\)";/\1/p' lab/fast/Version.hpp
python:
	@+$(sub) $(module) $(package)/__init__.pyi
$(package)/__init__.pyi: lab/python/mass_spring.pyi
	@mkdir -p $(@D) && cp $< $@ && touch $(@D)/py.typed
$(package)/__init__%: $(B)/lab/python/module.o $(B)/liblab.a
	@mkdir -p $(@D) && echo 'link $@'
	@$(CXX) $(lab_flags) $(speed) -shared -o $@ $^ $(LDLIBS)
$(B)/lab/python/module.o: unit_flags = -O1 $(python_flags)

python-deps:
	@tools/deps.sh build lab python
