# The site: make site writes $(B)/site. docs/site/README.md

site    := $(B)/site
release := $(B)/release

.PHONY: site release
site: page web-figures
	@python3 docs/site/make_site.py $(site) $(page) $(B)/figures

# The files attached to a release: .github/workflows/release.yml
release: site
	@rm -rf $(release) && mkdir -p $(release)
	@python3 course/kit/autograder.py
	@OUT=$(release)/starter python3 course/kit/starter.py starter
	@cd $(release) && python3 -m zipfile -c starter.zip starter && rm -r starter
	@cd $(B) && python3 -m zipfile -c release/site.zip site
	@cp $(page)/index.html $(release)/page.html
	@awk '/^## /{n++; next} n == 1' docs/CHANGELOG.md >$(release)/notes.md
	@ls -l $(release)
release: export OUT := $(release)/autograder.zip
