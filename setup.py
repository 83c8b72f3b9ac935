"""Builds the module with CMake. PLUMB_BUILD_DIR names a build of plumb to take the libraries from; else build/pip."""

import os
import pathlib
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        build = os.environ.get("PLUMB_BUILD_DIR")
        if not build:
            build = ROOT / "build" / "pip"
            options = ["-G", "Ninja"] if shutil.which("ninja") else []
            options += [
                "-DCMAKE_BUILD_TYPE=Release",
                "-DPLUMB_BUILD_TESTS=OFF",
                "-DPLUMB_ALL_CAPACITIES=OFF",
                "-DPLUMB_BUILD_PYTHON=ON",
                f"-DPython_EXECUTABLE={sys.executable}",
            ]
            subprocess.run(["cmake", "-S", ROOT, "-B", build, *options], check=True)
        subprocess.run(["cmake", "--build", build, "--parallel", str(os.cpu_count()), "--target", "plumb_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        built = pathlib.Path(build) / "python" / target.name
        if not built.exists():
            raise SystemExit(f"{built} was not built: that build is for another Python than {sys.executable}")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(built, target)


setup(ext_modules=[Extension("plumb", sources=[])], packages=[], py_modules=[], cmdclass={"build_ext": CMakeBuild})
