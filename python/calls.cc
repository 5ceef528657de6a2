#include "python/calls.h"

#include <chrono>
#include <exception>
#include <thread>

#include "engine/error.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

// Set when the module is imported.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
unsigned long main_thread = 0;

}  // namespace

ReleasedGil::~ReleasedGil() {
  try {
    PyEval_RestoreThread(thread_);
  } catch (...) {
    // Python unwinds such a thread to end it, which must not pass through destructors.
    while (true) {
      std::this_thread::sleep_for(std::chrono::hours(1));
    }
  }
}

bool has_raised_signal() {
  // Only the main thread runs signal handlers.
  if (PyThread_get_thread_ident() != main_thread) {
    return false;
  }
  const py::gil_scoped_acquire acquire;
  return PyErr_CheckSignals() != 0;
}

void raise_interruption() { throw py::error_already_set(); }

std::string path_of(const py::object& path) {
  const py::object text = py::module_::import("os").attr("fspath")(path);
  return py::module_::import("os").attr("fsdecode")(text).cast<std::string>();
}

void bind_calls(py::module_& module) {
  main_thread =
      py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  // Kept for as long as the interpreter lives.
  static PyObject* const error =
      PyErr_NewExceptionWithDoc("vantage.Error",
                                "The input cannot be processed. The text is one line: what, where, "
                                "what was expected.",
                                PyExc_RuntimeError, nullptr);
  static PyObject* const usage_error = [] {
    const py::tuple bases = py::make_tuple(py::handle(error), py::handle(PyExc_ValueError));
    return PyErr_NewExceptionWithDoc("vantage.UsageError",
                                     "An option or an argument that is invalid for any data.",
                                     bases.ptr(), nullptr);
  }();
  module.attr("Error") = py::handle(error);
  module.attr("UsageError") = py::handle(usage_error);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) {
        std::rethrow_exception(thrown);
      }
    } catch (const UsageError& problem) {
      PyErr_SetString(usage_error, problem.what());
    } catch (const Error& problem) {
      PyErr_SetString(error, problem.what());
    }
  });
}

}  // namespace vantage::python
