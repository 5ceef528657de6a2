#pragma once

#include <string>

#include "engine/execution.h"
#include "engine/matching/options/match_options.h"
#include "scheduler/machine.h"

namespace vantage {

/// Size of the images of a pair, and whether both are 8-bit grey.
struct TunedImages {
  int width_px = 0;
  int height_px = 0;
  bool is_8_bit_grey = false;
};

/// Properties that determine the fastest plan, in classes: work of one class shares its tuning. All
/// parts are human-readable text.
struct TuningKey {
  std::string machine;  ///< processor, caches, threads and cores, NUMA nodes if there are several
  std::string threads;  ///< number available, executor, instruction set, binding if given
  /// Cost and aggregation; sizes of windows, smoothing and iterations as powers of two; whether
  /// cells are integers.
  std::string method;
  std::string size;     ///< width, height and candidates as powers of √2
  std::string version;  ///< of Vantage

  /// One line; equal only for equal keys.
  [[nodiscard]] std::string text() const;
  friend bool operator==(const TuningKey&, const TuningKey&) = default;
};

/// The key of matching such images with `match`, whose disparities are known, on `machine`.
/// `execution`: as given by the user. Uses the instruction set in use.
TuningKey make_tuning_key(const scheduler::Machine& machine, const MatchOptions& match,
                          const ExecutionOptions& execution, const TunedImages& images);

}  // namespace vantage
