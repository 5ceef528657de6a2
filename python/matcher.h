#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "apps/match_settings.h"
#include "engine/vantage.h"
#include "python/arrays.h"

namespace vantage::python {

/// Options of matching, and the threads to use.
struct MatchSetup {
  MatchOptions options = apps::options_with_found_range();
  Execution* execution = nullptr;
};

/// Takes all options of matching from keyword arguments. Throws UsageError.
MatchSetup match_setup(pybind11::dict keywords);

/// What to compute at once.
struct Wanted {
  bool right = false;
  bool confidence = false;
};

/// The maps of a pair. Those that were not wanted at once are computed when they are asked for,
/// from the arrays of the images, which must then be as they were. Thread rule: one thread at a
/// time, as the GIL has it.
class MatchResult {
 public:
  MatchResult(const PairMatcher& matcher, Execution& execution, PixelArray left, PixelArray right,
              Wanted wanted);
  /// Of images that the result keeps: they cannot change.
  MatchResult(const PairMatcher& matcher, Execution& execution,
              std::pair<Photograph, Photograph> images);

  pybind11::array_t<float> disparity(const pybind11::object& self) const;
  pybind11::object disparity_y(const pybind11::object& self) const;
  pybind11::array_t<float> right_disparity(const pybind11::object& self);
  pybind11::array_t<bool> unmatched() const;
  pybind11::array_t<bool> right_unmatched();
  pybind11::array_t<float> confidence(const pybind11::object& self);
  /// In colours, as `vantage match --preview` shows it; in RGB order.
  pybind11::array preview() const;
  [[nodiscard]] std::pair<int, int> disparities() const {
    return {options_.disparities.min, options_.disparities.max};
  }

 private:
  [[nodiscard]] const MatchedMap& map() const { return maps_.of(options_.reference); }
  void compute_rest(Wanted wanted, const char* asked_for);
  [[nodiscard]] MatchRequest request(Wanted wanted) const;

  Execution& execution_;
  MatchOptions options_;  ///< with the range that was searched
  std::optional<std::pair<PixelArray, PixelArray>> arrays_;
  std::optional<std::pair<Photograph, Photograph>> images_;
  std::pair<std::uint32_t, std::uint32_t> checksums_;  ///< of arrays_
  Wanted has_;
  DisparityMaps maps_;
};

}  // namespace vantage::python
