# The teaching kit: course/README.md

# As it was given, whatever it holds: never expanded, and read by no shell.
override OUT := $(value OUT)

.PHONY: starter solution
starter solution: export OUT := $(OUT)
starter solution:
	@python3 course/kit/starter.py $@
