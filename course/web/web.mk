# The cloth as a web page, of the Graph.hpp and mass_spring.hpp of this folder.

web_room := $(dir $(lastword $(MAKEFILE_LIST)))

.PHONY: web web-deps
web:
	@command -v python3 >/dev/null || \
	  { echo 'make web: python3 is missing: make web-deps'; exit 2; }
	@python3 $(web_room)web.py page $(O)web.html $(STAGE)
web-deps:
	@tools/deps.sh web
