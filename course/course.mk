# The teaching kit: course/README.md

# A value given to a target reaches its program by the environment, whatever it
# holds: never expanded, and read by no shell.
$(foreach name,DIR DUE FEEDBACK FILE JSON LEVEL OUT RESULTS STARTER TIMES,\
  $(if $(filter command environment override,$(firstword $(origin $(name)))),\
    $(eval override $(name) := $$(value $(name)))$(eval export $(name))))

.PHONY: starter solution constants
starter solution:
	@python3 course/kit/starter.py $@
constants:
	@python3 course/kit/constants.py

# ---- What make demo leaves without a display: no more than it needs is built.
$(B)/demo: course/demo.cpp $(or $(viewer_lib),no_picture)
	@mkdir -p $(dir $@) && echo '$(CXX) $@'
	@$(CXX) $(common) -O1 -DNDEBUG -DMASS_SPRING_VIEWER $(draw_flags) \
	  $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -MT $@ \
	  -MF $@.d -o $@ $< $(draw_libs)
.PHONY: no_picture
no_picture:
	@echo 'a picture needs $(draw_pkg), which pkg-config does not find' >&2; exit 2

# ---- The grader
.PHONY: grade autograder kit-check mistakes class grade-tests
# HW has a default, for who submits: here it counts if it is given.
grade class: override HW := $(if $(filter HW=%,$(MAKEOVERRIDES)),$(HW))
grade:
	@tools/deps.sh grade && python3 course/kit/grade.py
class:
	@tools/deps.sh grade && python3 course/kit/whole_class.py
grade-tests:
	@tools/deps.sh grade && python3 course/kit/grade_tests.py
autograder:
	@python3 course/kit/autograder.py
kit-check mistakes: override HW :=
kit-check mistakes:
	@tools/deps.sh grade && python3 course/kit/kit_check.py \
	  $(filter mistakes,$@)

# ---- The pages
.PHONY: course-pictures
course-pictures:
	@python3 course/pictures/draw.py

# ---- Figures of the pages: course/web/README.md
.PHONY: web-figures
web-figures:
	@python3 course/web/web.py figures $(B)/figures
