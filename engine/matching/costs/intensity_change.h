#pragma once

#include <array>

namespace vantage {

/// Maps intensities of one camera to those of another: gain · intensity + offset, in grey levels
/// 0..255.
struct IntensityChange {
  double gain = 1;
  double offset = 0;

  [[nodiscard]] bool is_none() const { return gain == 1 && offset == 0; }
  friend bool operator==(const IntensityChange&, const IntensityChange&) = default;
};

/// Intensity changes of a photograph's luma and of its colour channels.
struct IntensityChanges {
  IntensityChange luma;
  std::array<IntensityChange, 3> channels;

  friend bool operator==(const IntensityChanges&, const IntensityChanges&) = default;
};

}  // namespace vantage
