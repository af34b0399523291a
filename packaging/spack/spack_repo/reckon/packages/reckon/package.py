# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
import pathlib

from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Reckon(CMakePackage):
    """Level-set discrete element method for grains of any shape, for geomechanics."""

    # The checkout that this recipe lies in.
    git = pathlib.Path(__file__).resolve().parents[6].as_uri()

    license("BSD-3-Clause")

    version("main", branch="main")

    variant("mpi", default=True, description="One simulation on several processes")
    variant("zoltan", default=True, when="+mpi", description="Balance the load of several processes")
    variant("openmp", default=True, description="Threads inside a process")
    variant("report", default=True, description="The page of `reckon report` and `reckon watch`; fetches its packages by npm")
    variant("ct", default=False, description="Grains from X-ray volumes, by the Insight Toolkit")
    variant("python", default=False, description="The Python package")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("fmt@9:")
    depends_on("eigen@3.4:")
    depends_on("hdf5@1.10:")
    depends_on("hdf5~mpi", when="~mpi")
    depends_on("tomlplusplus@3.3:")
    depends_on("cli11@2.3:")
    depends_on("highway@1:")
    depends_on("zlib-api")
    depends_on("libtiff@4.5:")
    depends_on("mpi", when="+mpi")
    depends_on("zoltan", when="+zoltan")
    depends_on("node-js@18:", when="+report", type="build")
    depends_on("npm", when="+report", type="build")
    depends_on("itk@5.2:", when="+ct")
    depends_on("googletest", type="test")
    with when("+python"):
        extends("python@3.11:")
        depends_on("py-pybind11@2.10:", type=("build", "link"))
        depends_on("py-numpy", type=("build", "run"))
        depends_on("py-tomli-w", type=("build", "run"))

    conflicts("%gcc@:11")
    conflicts("%clang@:13")

    def cmake_args(self):
        arguments = [
            self.define_from_variant("RECKON_MPI", "mpi"),
            self.define_from_variant("RECKON_ZOLTAN", "zoltan"),
            self.define_from_variant("RECKON_OPENMP", "openmp"),
            self.define_from_variant("RECKON_REPORT", "report"),
            self.define_from_variant("RECKON_CT", "ct"),
            self.define_from_variant("RECKON_PYTHON", "python"),
            self.define("RECKON_BUILD_TESTS", self.run_tests),
        ]
        if self.spec.satisfies("+python"):
            arguments.append(self.define("RECKON_PYTHON_DIR", python_platlib))
            arguments.append(self.define("Python_EXECUTABLE", python.path))
        return arguments

    @run_after("install", when="+python")
    def install_python_package(self):
        with working_dir(self.build_directory):
            cmake("--install", ".", "--component", "python")
