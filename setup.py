"""Lets pip install what `make python` builds: see docs/python.md."""
import pathlib
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class Make(build_ext):
    """Builds the package by make."""

    def run(self) -> None:
        if self.inplace:
            sys.exit("mass_spring is not installed by -e: after make python, "
                     "PYTHONPATH=build/python finds it")
        subprocess.run(["make", "-j2", "python", f"PYTHON={sys.executable}"],
                       check=True)
        shutil.copytree("build/python/mass_spring",
                        pathlib.Path(self.build_lib, "mass_spring"),
                        dirs_exist_ok=True)


version = subprocess.run(["make", "-s", "python-version"], check=True,
                         capture_output=True, text=True).stdout.strip()
setup(version=version,
      ext_modules=[Extension("mass_spring.__init__", [])],
      py_modules=[], packages=[], cmdclass={"build_ext": Make})
