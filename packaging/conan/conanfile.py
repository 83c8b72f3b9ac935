"""plumb for Conan 2: `conan create packaging/conan` in the source tree. Written against Conan's documentation, not run."""

import os
import pathlib
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Plumb(ConanFile):
    name = "plumb"
    license = "Apache-2.0"
    description = "Keeps redundant accelerometers honest"
    settings = "os", "arch", "compiler", "build_type"
    package_type = "static-library"

    def set_version(self):
        found = re.search(r"^\s*VERSION (\d+\.\d+\.\d+)$", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)
        self.version = found.group(1)

    def requirements(self):
        self.requires("tl-expected/[>=1.0.0 <2]", transitive_headers=True)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "cmake/*", "include/*", "src/*", "scripts/check_symbols", "LICENSE", "NOTICE"):
            copy(self, pattern, src=ROOT, dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("HOST", "TOOL", "TESTS"):
            toolchain.cache_variables[f"PLUMB_BUILD_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_find_mode", "none")  # plumb brings its own plumbConfig.cmake
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "plumb"))
