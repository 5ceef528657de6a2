// vantage._vantage: what the package vantage is made of. The interface that users see, with its
// documentation, is python/vantage/__init__.py.
#include <pybind11/pybind11.h>

#include "engine/io/files/remote_files.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/io/store/store_files.h"
#include "python/calls.h"

PYBIND11_MODULE(_vantage, module) {
  // cv2 may be in this process, with settings of its own.
  vantage::leave_opencv_to_host();
  module.attr("__version__") = VANTAGE_VERSION;
  vantage::install_remote_files(vantage::make_store_files([] { return false; }));
  // Transfers end before the libraries that they use are unloaded.
  pybind11::module_::import("atexit").attr("register")(
      pybind11::cpp_function([] { vantage::install_remote_files(nullptr); }));
  vantage::python::bind_calls(module);
  vantage::python::bind_calibration(module);
  vantage::python::bind_rectification(module);
  vantage::python::bind_point_clouds(module);
  vantage::python::bind_match_result(module);
  vantage::python::bind_matcher(module);
  vantage::python::bind_metres(module);
  vantage::python::bind_views(module);
  vantage::python::bind_files(module);
  vantage::python::bind_sequence(module);
}
