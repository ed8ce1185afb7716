# The site: make site writes $(B)/site. docs/site/README.md

site := $(B)/site

.PHONY: site
site: page web-figures
	@python3 docs/site/make_site.py $(site) $(page) $(B)/figures
