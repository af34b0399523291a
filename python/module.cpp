// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The compiled half of the Python package: thin, one function here for one of the library. Docs and
// signatures are in reckon/_reckon.pyi.
#include <pybind11/pybind11.h>

#include <string>

#include "bindings.hpp"
#include "reckon/core/build_info.hpp"
#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"

PYBIND11_MODULE(_reckon, module) {
  namespace py = pybind11;
  py::register_exception<reckon::Error>(module, "Error", PyExc_RuntimeError);
  module.attr("__version__") = std::string{reckon::build_info().version};
  module.def("set_threads", &reckon::set_thread_count, py::arg("count"));
  module.def("threads", &reckon::thread_count);
  reckon::python::bind_shapes(module);
  reckon::python::bind_simulation(module);
  reckon::python::bind_runs(module);
}
