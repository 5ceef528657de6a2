#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "engine/execution.h"

namespace vantage {

/// Settings that affect speed only. Empty fields are left to the cost model.
struct TunedSettings {
  std::optional<int> threads = std::nullopt;              ///< 1..1024
  std::optional<int> strip_width_px = std::nullopt;       ///< 1..65500
  std::optional<int> band_height_px = std::nullopt;       ///< 1..65500
  std::optional<int> iterations_per_pass = std::nullopt;  ///< 1..10000
  std::optional<int> frames_in_flight = std::nullopt;     ///< of a sequence, 1..64

  /// Throws UsageError naming the field, its value and its limits.
  void validate() const;

  friend bool operator==(const TunedSettings&, const TunedSettings&) = default;
};

/// One field of TunedSettings.
struct TuningCoordinate {
  std::string_view name;  ///< as the option on the command line
  std::optional<int> TunedSettings::*field;
  int max = 1;  ///< the largest value
};

/// All coordinates, in search order.
inline constexpr std::array<TuningCoordinate, 5> kTuningCoordinates = {
    TuningCoordinate{"threads", &TunedSettings::threads, 1024},
    TuningCoordinate{"in-flight", &TunedSettings::frames_in_flight, 64},
    TuningCoordinate{"strip-width", &TunedSettings::strip_width_px, 65500},
    TuningCoordinate{"iterations-per-pass", &TunedSettings::iterations_per_pass, 10000},
    TuningCoordinate{"band-height", &TunedSettings::band_height_px, 65500}};

/// "threads 2, strip-width 321", or "default" if all is left to the cost model.
std::string to_string(const TunedSettings& settings);

/// `given`, with empty fields taken from `tuned`.
ExecutionOptions with_tuned(const ExecutionOptions& given, const TunedSettings& tuned);

}  // namespace vantage
