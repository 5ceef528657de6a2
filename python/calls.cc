#include "python/calls.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>  // and pthread_atfork(), of the library that threads are made with

#include "engine/error.h"
#include "engine/io/files/remote_files.h"
#include "engine/message_line.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

// Set when the module is imported.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
unsigned long main_thread = 0;
std::atomic<int> calls{0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<bool> was_forked_in_a_call{false};

void note_fork() { was_forked_in_a_call = was_forked_in_a_call || calls > 0; }

}  // namespace

EngineCall::EngineCall() {
  if (was_forked_in_a_call) {
    throw Error(
        "this process was forked while another thread computed, and lacks its threads: start "
        "worker processes with the method 'spawn' or 'forkserver', or before anything computes");
  }
  ++calls;
}

EngineCall::~EngineCall() { --calls; }

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
  return bytes_of(py::module_::import("os").attr("fspath")(path));
}

std::string bytes_of(const py::handle& text) {
  py::object bytes = py::reinterpret_borrow<py::object>(text);
  if (py::isinstance<py::str>(text)) {
    bytes = py::reinterpret_steal<py::object>(
        PyUnicode_AsEncodedString(text.ptr(), "utf-8", "surrogateescape"));
    if (!bytes) {
      throw py::error_already_set();
    }
  }
  std::string found = py::reinterpret_borrow<py::bytes>(bytes);
  if (found.find('\0') != std::string::npos) {
    throw UsageError("a text holds a null character, expected none");
  }
  if (is_address(found)) {
    forget_remote_files();  // there may be another file by now
  }
  return found;
}

py::str text_of(const std::string& bytes) {
  PyObject* const text =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape");
  if (text == nullptr) {
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::str>(text);
}

void bind_calls(py::module_& module) {
  (void)::pthread_atfork(nullptr, nullptr, note_fork);
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
      PyErr_SetString(usage_error, message_line(problem.what()).c_str());
    } catch (const Error& problem) {
      PyErr_SetString(error, message_line(problem.what()).c_str());
    }
  });
}

}  // namespace vantage::python
