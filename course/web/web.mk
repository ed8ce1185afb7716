# The cloth as a web page, of the Graph.hpp and mass_spring.hpp of this folder.

web_room     := $(dir $(lastword $(MAKEFILE_LIST)))
web_packages  = clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 \
                libclang-rt-19-dev-wasm32 python3

.PHONY: web web-deps
web:
	@command -v python3 >/dev/null || \
	  { echo 'make web: python3 is missing: make web-deps'; exit 2; }
	@python3 $(web_room)web.py page $(O)web.html $(STAGE)
web-deps:
	@command -v apt-get >/dev/null || { echo 'make web-deps: needs Debian or \
	Ubuntu, whose packages it installs: $(web_packages)'; exit 2; }
	@set -x; $(if $(filter 0,$(shell id -u)),,sudo) apt-get -y install \
	  --no-install-recommends $(web_packages)
