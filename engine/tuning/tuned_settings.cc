#include "engine/tuning/tuned_settings.h"

#include <fmt/format.h>

#include "engine/error.h"

namespace vantage {

void TunedSettings::validate() const {
  for (const TuningCoordinate& coordinate : kTuningCoordinates) {
    const std::optional<int>& value = this->*coordinate.field;
    if (value && (*value < 1 || *value > coordinate.max)) {
      throw UsageError(fmt::format("{} is {}, expected a whole number from 1 to {}",
                                   coordinate.name, *value, coordinate.max));
    }
  }
}

std::string to_string(const TunedSettings& settings) {
  std::string text;
  for (const TuningCoordinate& coordinate : kTuningCoordinates) {
    if (const std::optional<int>& value = settings.*coordinate.field) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", coordinate.name, *value);
    }
  }
  return text.empty() ? "default" : text;
}

ExecutionOptions with_tuned(const ExecutionOptions& given, const TunedSettings& tuned) {
  ExecutionOptions options = given;
  const auto fill = [](std::optional<int>& field, const std::optional<int>& value) {
    field = field ? field : value;
  };
  fill(options.threads, tuned.threads);
  fill(options.strip_width_px, tuned.strip_width_px);
  fill(options.band_height_px, tuned.band_height_px);
  fill(options.iterations_per_pass, tuned.iterations_per_pass);
  return options;
}

}  // namespace vantage
