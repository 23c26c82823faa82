"""Builds the module by CMake for `pip install --no-build-isolation .`: in build/release for Debian's
Python, as ./run does, else in a folder of its own."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOT = pathlib.Path(__file__).resolve().parent
DEBIAN = "/usr/bin/python3"


def build_folder():
    of_debian = os.path.exists(DEBIAN) and os.path.realpath(sys.executable) == os.path.realpath(DEBIAN)
    return ROOT / ("build/release" if of_debian else f"build/python{sys.version_info[0]}.{sys.version_info[1]}")


class BuildWithCMake(build_py):
    def run(self):
        super().run()
        build = build_folder()
        python = DEBIAN if build.name == "release" else sys.executable
        configure = ["--preset", "release", "-B", build, "-D", f"Python_EXECUTABLE={python}",
                     *([] if python == DEBIAN else ["-D", f"MACADAM_BINARY_DIR={build}/bin"])]
        for words in (*([] if (build / "build.ninja").exists() else [configure]),
                      ["--build", build, "--target", "macadam_python"],
                      ["--install", build, "--component", "wheel", "--strip", "--prefix", self.build_lib]):
            subprocess.run(["cmake", *map(str, words)], cwd=ROOT, check=True)


class BinaryDistribution(Distribution):
    def has_ext_modules(self):
        return True


setup(version=re.search(r"project\(macadam VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text("utf-8"))[1],
      cmdclass={"build_py": BuildWithCMake}, distclass=BinaryDistribution)
