#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/examination/pair_examination.h"
#include "engine/options/setting_value.h"
#include "engine/rectification/rectified_pair.h"

namespace vantage::apps {

/// A pair and what was found.
struct ExaminedPair {
  int index = 0;  ///< in its source
  std::string name;
  PairExamination found;
};

/// What `check` found in a pair, or in some pairs of a sequence.
struct CheckedInput {
  std::vector<ExaminedPair> pairs;  ///< at least one
  int pair_count = 0;               ///< of the input
  std::optional<RectifiedPair> cameras = {};
  bool is_rectified_here = false;  ///< by the calibration
  std::size_t memory_bytes = 0;    ///< of a match, or of a run; 0 where none makes sense
  int threads = 0;
  std::string command;  ///< to type

  /// Whether a match of any of the pairs makes sense.
  [[nodiscard]] bool makes_sense() const;
  /// Most of the pairs whose points are known have negative disparities.
  [[nodiscard]] bool looks_exchanged() const;
  /// The rows of all pairs whose points are known are off.
  [[nodiscard]] bool is_unrectified() const;
  /// That all pairs need together; empty: none is known.
  [[nodiscard]] std::optional<DisparityRange> disparities() const;
  /// The longest match of a pair.
  [[nodiscard]] double seconds() const;
};

/// The findings as lines of a table.
std::string examination_text(const CheckedInput& checked);

/// The findings by name, for reports.
SettingValue examination_values(const CheckedInput& checked);

}  // namespace vantage::apps
