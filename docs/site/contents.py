"""What is on the site, in order: groups of pages. A page is the path of its
Markdown, or a file of the site and its title."""

CONTENTS: list[tuple[str, list[str | tuple[str, str]]]] = [
    ("Start", ["README.md",
               ("page/index.html", "The laboratory in the browser"),
               "docs/site/explode.md"]),
    ("The course", [f"course/{name}.md" for name in (
        "0", "3.1", "3.2", "4.1", "4.2", "5.1", "5.2", "6.1", "6.2", "7.1",
        "7.2", "8", "own-tests", "write-up")]),
    ("The code", ["Graph.hpp", "mass_spring.hpp", "mass_spring.cpp",
                  "methods.hpp", "docs/graph.md", "docs/glossary.md"]),
    ("The laboratory", [
        "lab/README.md", "lab/methods/README.md", "lab/stability/README.md",
        "lab/scenes/README.md", "lab/advice/README.md", "lab/charts/README.md",
        "lab/try/README.md", "lab/fast/README.md", "lab/bench/README.md",
        "lab/bench/peers/README.md", "lab/page/README.md",
        "course/web/README.md",
        "docs/examples/README.md", "docs/rest.md", "docs/python.md"]),
    ("To teach and to contribute", [
        "course/README.md", "course/elsewhere.md", "course/teaching.md",
        "course/rubric.md", "data/README.md", "docs/CONTRIBUTING.md",
        "docs/site/README.md", "tools/README.md", "docs/CHANGELOG.md"]),
]
# Markdown that lies elsewhere once it is used, or is of this site alone.
LEFT_OUT = ["course/starter/README.md", "course/words/de/3.1.md"]
