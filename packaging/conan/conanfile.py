"""Conan 2 recipe that builds the tree it lies in. Untested: no Conan was at hand when this was written."""
import re
from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class CrumbleConan(ConanFile):
    name = "crumble"
    description = "Real-time fracture of soft, brittle bodies with force feedback"
    license = "MIT"
    package_type = "shared-library"
    settings = "os", "arch", "compiler", "build_type"

    def _tree(self):
        return Path(self.recipe_folder).parent.parent

    def set_version(self):
        text = (self._tree() / "CMakeLists.txt").read_text()
        self.version = re.search(r"project\(crumble VERSION ([0-9.]+)", text)[1]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "capi/*", "cmake/*", "include/*", "src/*"):
            copy(self, pattern, self._tree(), self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("libccd/2.1")
        self.requires("fcl/0.7.0")
        self.requires("eigen/3.4.0", transitive_headers=True)
        self.requires("highway/1.0.3", visible=False)
        self.requires("boost/1.74.0", options={"header_only": True}, visible=False)
        self.requires("nlohmann_json/3.11.2", visible=False)

    def generate(self):
        dependencies = CMakeDeps(self)
        # the names that CMakeLists.txt asks for are those of Debian's packages
        dependencies.set_property("libccd", "cmake_file_name", "ccd")
        dependencies.set_property("libccd", "cmake_target_name", "ccd")
        dependencies.set_property("fcl", "cmake_target_name", "fcl")
        dependencies.generate()
        toolchain = CMakeToolchain(self)
        for option in ("APPS", "BENCH", "EXAMPLES", "TESTS"):
            toolchain.cache_variables[f"CRUMBLE_BUILD_{option}"] = False
        toolchain.cache_variables["CRUMBLE_WARNINGS_AS_ERRORS"] = False
        for variable, package in (("HIGHWAY", "highway"), ("BEAST", "boost")):
            include = self.dependencies[package].cpp_info.aggregated_components().includedirs[0]
            toolchain.cache_variables[f"CRUMBLE_{variable}_INCLUDE"] = include
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, Path(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        # crumble::crumble alone, and made anew by CMakeDeps: crumble::core is for those who build with CMake directly
        self.cpp_info.set_property("cmake_file_name", "crumble")
        self.cpp_info.set_property("cmake_target_name", "crumble::crumble")
        self.cpp_info.set_property("pkg_config_name", "crumble")
        self.cpp_info.libs = ["crumble"]
