# Untried: see README.md.
from spack.package import *


class Tyndall(CMakePackage):
    """Light transport in participating media as VTK filters and a ParaView plugin."""

    url = "ADDRESS-OF-THE-RELEASE-0.2.0.tar.gz"
    license("BSD-3-Clause")
    version("0.2.0", sha256="CHECKSUM")

    variant("paraview", default=True, description="Plugin for ParaView; without it, module for plain VTK")
    variant("openvdb", default=True, description="Read and write .vdb")
    variant("openexr", default=True, description="Read .exr")
    variant("mpi", default=True, description="Several ranks solve one scene together")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.20:", type="build")
    depends_on("paraview@5.11: +python +shared", when="+paraview")
    depends_on("paraview +mpi", when="+paraview +mpi")
    depends_on("vtk@9.1: +python", when="~paraview")
    depends_on("vtk +mpi", when="~paraview +mpi")
    depends_on("mpi", when="+mpi")
    depends_on("openvdb@10:", when="+openvdb")
    depends_on("openexr@3:", when="+openexr")
    depends_on("glm")
    depends_on("eigen@3.3:")
    depends_on("opencl-clhpp")
    depends_on("ocl-icd")
    depends_on("pocl +icd", type="run")  # the device: a CPU; clusters with GPUs have their own

    def cmake_args(self):
        options = ("paraview", "openvdb", "openexr", "mpi")
        arguments = [self.define_from_variant("TYNDALL_WITH_" + option.upper(), option) for option in options]
        if self.spec.satisfies("+openvdb"):
            arguments.append(self.define("CMAKE_MODULE_PATH", self.spec["openvdb"].prefix.lib.cmake.OpenVDB))
        return arguments + [self.define("TYNDALL_BUILD_TESTING", False), self.define("TYNDALL_WITH_HELP", False)]
