#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/io/images/preview.h"
#include "engine/matching/selection/cyclopean_map.h"
#include "engine/vantage.h"
#include "python/matched_images.h"
#include "python/metres.h"
#include "python/spare_maps.h"
#include "python/unrectified_pairs.h"

namespace vantage::python {

/// What to compute beside the reference's map.
struct Wanted {
  bool other = false;  ///< the map of the other image of the pair
  bool confidence = false;
  bool posterior = false;
  [[nodiscard]] bool covers(const Wanted& all) const {
    return (other || !all.other) && (confidence || !all.confidence) &&
           (posterior || !all.posterior);
  }
  [[nodiscard]] Wanted with(const Wanted& more) const {
    return {other || more.other, confidence || more.confidence, posterior || more.posterior};
  }
};

/// Mean and variance of p(d).
struct PosteriorMaps {
  Image<float> mean_px;
  Image<float> variance_px2;
};

/// Maps of images.
struct ComputedMaps {
  MatchOptions options;           ///< with the range that was searched
  RowMode rows = RowMode::kAsIs;  ///< of what else is computed of the images
  DisparityMaps maps;
  Wanted has;
  MatchReport report = {};
  PosteriorMaps posterior = {};
  std::optional<CyclopeanMap> cyclopean = std::nullopt;
  std::optional<MetricCamera> camera = std::nullopt;   ///< where it is known
  std::optional<PreviewRange> preview = std::nullopt;  ///< default: the range that was searched
  /// Nothing else can be computed of the images alone.
  bool is_final = false;
  bool on_photographs = false;  ///< the images are not rectified
};

/// The maps of images. Those that were not wanted at once are computed when they are asked for,
/// from the arrays of the images, which must then be as they were. Thread rule: one thread at a
/// time, as the GIL has it.
class MatchResult {
 public:
  /// `unrectified`: what matches the images instead of `matcher`, with its options; null: nothing.
  /// `spare`: takes the memory of the maps and gets it back.
  MatchResult(const PairMatcher& matcher, Execution& execution, MatchedImages images, Wanted wanted,
              std::shared_ptr<const UnrectifiedPairs> unrectified,
              std::shared_ptr<SpareMaps> spare);
  /// Of maps that have been computed.
  MatchResult(Execution& execution, MatchedImages images, ComputedMaps computed)
      : execution_(execution), images_(std::move(images)), computed_(std::move(computed)) {}
  MatchResult(const MatchResult&) = delete;
  MatchResult& operator=(const MatchResult&) = delete;
  ~MatchResult() {
    if (spare_) {
      spare_->give(std::move(computed_.maps));
    }
  }

  pybind11::array_t<float> disparity(const pybind11::object& self) const;
  pybind11::object disparity_y(const pybind11::object& self) const;
  pybind11::array_t<float> right_disparity(const pybind11::object& self);
  pybind11::array_t<bool> unmatched() const;
  pybind11::array_t<bool> right_unmatched();
  pybind11::array_t<float> confidence(const pybind11::object& self);
  pybind11::array_t<float> posterior_mean(const pybind11::object& self);
  pybind11::array_t<float> posterior_variance(const pybind11::object& self);
  pybind11::array_t<float> cyclopean(const pybind11::object& self);
  pybind11::array_t<std::uint8_t> cyclopean_occlusion(const pybind11::object& self);
  /// For people: its size and range.
  [[nodiscard]] std::string text() const;
  /// In colours, as `vantage match --preview` shows it; in RGB order.
  pybind11::array preview() const;
  pybind11::array depth(const std::optional<StereoCalibration>& calibration,
                        const pybind11::dict& keywords) const;
  pybind11::array depth_resolution(const std::optional<StereoCalibration>& calibration,
                                   const pybind11::dict& keywords) const;
  FramedCloud cloud(const std::optional<StereoCalibration>& calibration,
                    const pybind11::dict& keywords);
  FramedMesh mesh(const std::optional<StereoCalibration>& calibration,
                  const pybind11::dict& keywords);
  /// Of the match that made the map of the reference.
  [[nodiscard]] const MatchReport& report() const { return computed_.report; }
  [[nodiscard]] std::vector<std::string> remarks() const;
  [[nodiscard]] MapShares shares() const { return computed_.report.shares.value_or(MapShares()); }
  [[nodiscard]] std::pair<int, int> disparities() const {
    return {computed_.options.disparities.min, computed_.options.disparities.max};
  }

 private:
  [[nodiscard]] Side side() const { return images_.side(computed_.options.reference); }
  [[nodiscard]] const MatchedMap& map() const { return computed_.maps.of(side()); }
  [[nodiscard]] MetricMap metric_map() const {
    return {.disparity_px = map().disparity_px.view(), .side = side(), .known = &computed_.camera};
  }
  /// Computes what is missing of `wanted`.
  void require(Wanted wanted, const char* asked_for);
  void require_right(const char* asked_for);
  const CyclopeanMap& require_cyclopean(const char* asked_for);
  void match(const PairMatcher& matcher, const std::vector<Photograph>& photographs, Wanted wanted,
             ComputedMaps& computed) const;
  template <typename Make>
  auto make_points(const std::optional<StereoCalibration>& calibration,
                   const pybind11::dict& keywords, const Make& make);

  /// Throws UsageError unless the map is of rectified pixels.
  void require_rectified(const char* asked_for) const;
  /// `given`, or those of photographs that are not rectified.
  [[nodiscard]] std::optional<StereoCalibration> cameras(
      const std::optional<StereoCalibration>& given) const;

  Execution& execution_;
  MatchedImages images_;
  std::shared_ptr<const UnrectifiedPairs> unrectified_;  ///< null: pairs are rectified
  std::shared_ptr<SpareMaps> spare_;                     ///< null: none
  ComputedMaps computed_;
};

}  // namespace vantage::python
