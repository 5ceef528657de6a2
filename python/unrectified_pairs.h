#pragma once

#include <memory>
#include <mutex>

#include "engine/vantage.h"

namespace vantage::python {

/// Matches photographs of a calibrated pair of cameras that are not rectified, of any size. Thread
/// rule: may be used concurrently.
class UnrectifiedPairs {
 public:
  /// `on_rectified`: maps are brought to the pixels of the rectified images.
  UnrectifiedPairs(StereoCalibration calibration, bool on_rectified, Execution& execution)
      : calibration_(std::move(calibration)), on_rectified_(on_rectified), execution_(execution) {}

  [[nodiscard]] bool on_rectified() const { return on_rectified_; }
  /// PairMatcher::match(); makes no volumes.
  MatchOptions match(const MatchOptions& options, const Photograph& left, const Photograph& right,
                     const MatchRequest& request, DisparityMaps& maps, MatchReport& report) const;
  /// Cameras of the rectified images of this size.
  [[nodiscard]] StereoCalibration rectified_cameras(int width_px, int height_px) const;
  [[nodiscard]] Photograph rectified(const Photograph& photograph, Side side) const;

 private:
  struct Cameras {
    Rectifier rectifier;
    std::shared_ptr<const EpipolarGrids> grids;
  };
  [[nodiscard]] std::shared_ptr<const Cameras> cameras_for(int width_px, int height_px) const;

  StereoCalibration calibration_;
  bool on_rectified_;
  Execution& execution_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Cameras> latest_;  ///< of the last size
};

}  // namespace vantage::python
