# Spack recipe of Spindrift, for a checkout; its dependencies are compared with CMakeLists.txt (tests/docs/names_test.py), the recipe itself has not
# been run: no Spack was at hand. SPDX-License-Identifier: Apache-2.0
#   spack repo add ci/packaging/spack && spack dev-build --source-path . spindrift@main
from spack.package import *


class Spindrift(CMakePackage):
    """Coupled simulation of floating offshore wind turbines: a rotor in compressible air, a sea of particles, moored bodies."""

    license("Apache-2.0")
    version("main")   # spack dev-build takes the sources from the checkout

    variant("cgns", default=True, description="Read and write CGNS grids")
    variant("pictures", default=False, description="Pictures and films of runs")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.21:", type="build")
    depends_on("ninja", type="build")
    depends_on("mpi")
    depends_on("hdf5@1.10: +mpi")
    depends_on("eigen@3.4:")
    depends_on("metis@5:")
    depends_on("hypre@2.26:")
    depends_on("zlib-api")
    depends_on("cgns +hdf5 +parallel", when="+cgns")
    depends_on("fmt@9:")
    depends_on("spdlog@1.10:")
    depends_on("nlohmann-json@3.11:")
    depends_on("tomlplusplus@3.3:")
    depends_on("cli11@2.2:")
    depends_on("yaml-cpp@0.7:")
    depends_on("python@3.11:", type="run")
    depends_on("py-numpy", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-jinja2", type="run")
    depends_on("vtk +python", when="+pictures", type="run")
    depends_on("ffmpeg", when="+pictures", type="run")

    generator("ninja")

    def cmake_args(self):
        return [self.define("SPINDRIFT_PROCESSOR", "x86-64-v3"), self.define("SPINDRIFT_TESTS", False), self.define("SPINDRIFT_PERF", False),
                self.define("CMAKE_DISABLE_FIND_PACKAGE_CGNS", self.spec.satisfies("~cgns"))]

    def setup_run_environment(self, env):
        env.prepend_path("PYTHONPATH", self.prefix.lib.python3.join("dist-packages"))
        env.set("SPINDRIFT_PYTHON", self.spec["python"].command.path)
