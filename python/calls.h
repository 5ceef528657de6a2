#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <string>

#include "engine/execution.h"
#include "engine/rectification/stereo_calibration.h"
#include "scheduler/interruption.h"

namespace vantage::python {

/// Whether a signal handler of Python has raised, as that of Ctrl-C does. Called without the GIL,
/// by the thread that released it.
bool has_raised_signal();
/// Throws the exception of that handler.
[[noreturn]] void raise_interruption();

/// Without the GIL while it lives. A thread that comes back after the interpreter has begun to end,
/// as daemon threads do, waits here until the process is gone.
class ReleasedGil {
 public:
  ReleasedGil() : thread_(PyEval_SaveThread()) {}
  ReleasedGil(const ReleasedGil&) = delete;
  ReleasedGil& operator=(const ReleasedGil&) = delete;
  ~ReleasedGil();

 private:
  PyThreadState* thread_;
};

/// A call of the engine, while it lives. Threads of a process end in its forked children, whatever
/// they hold: where a process was forked during a call of another of its threads, the constructor
/// throws Error in the child. Thread rule: with the GIL.
class EngineCall {
 public:
  EngineCall();
  EngineCall(const EngineCall&) = delete;
  EngineCall& operator=(const EngineCall&) = delete;
  ~EngineCall();
};

/// Runs `work` without the GIL. `work` touches no Python object; what computes on an execution
/// takes on_threads_of(). Ctrl-C in the main thread ends loops of executions in it.
template <typename Work>
auto without_gil(const Work& work) {
  try {
    const EngineCall call;
    const ReleasedGil release;
    scheduler::InterruptibleScope scope(has_raised_signal);
    return work();
  } catch (const scheduler::Interrupted&) {
    raise_interruption();
  }
}

/// Like without_gil(), for work on `execution`: calls of more threads than it has wait for each
/// other. Ctrl-C in the main thread ends the wait, too.
template <typename Work>
auto on_threads_of(Execution& execution, const Work& work) {
  return without_gil([&] {
    const scheduler::SharedThreads::Call call(execution.threads());
    return work();
  });
}

/// The path that an object stands for (str, bytes, pathlib.Path). Throws TypeError; UsageError for
/// a null character.
std::string path_of(const pybind11::object& path);

/// A str or bytes as bytes: UTF-8, or a name of any bytes as os.fsencode() has it. Throws
/// UsageError for a null character.
std::string bytes_of(const pybind11::handle& text);
/// The str that os.fsdecode() makes of a name.
pybind11::str text_of(const std::string& bytes);

/// A Calibration, that of a file if it is a path, or None. Throws Error, TypeError.
std::optional<StereoCalibration> calibration_from(const pybind11::object& object);

/// Registers vantage.Error and vantage.UsageError. Called first, in the main thread's import.
void bind_calls(pybind11::module_& module);
void bind_calibration(pybind11::module_& module);
void bind_files(pybind11::module_& module);
void bind_match_result(pybind11::module_& module);
void bind_matcher(pybind11::module_& module);
void bind_metres(pybind11::module_& module);
void bind_point_clouds(pybind11::module_& module);
void bind_rectification(pybind11::module_& module);
void bind_sequence(pybind11::module_& module);
void bind_views(pybind11::module_& module);

}  // namespace vantage::python
