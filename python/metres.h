#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "engine/options/rig_scale.h"
#include "engine/vantage.h"
#include "python/point_clouds.h"

namespace vantage::python {

/// What a map is turned into; kDisparity: a depth map.
enum class MetricOutput { kDepth, kDepthResolution, kPoints, kDisparity };

/// Options of that, as 'vantage match' has them.
struct MetricOptions {
  RigScale rig;
  CloudOptions cloud;
  std::optional<double> disparity_resolution_px;
  Side side = Side::kLeft;  ///< of a map that is an array
};

/// The map that is turned: a MatchResult knows its side, of an array it is an option.
enum class MapKind { kResult, kArray };

/// Throws UsageError for an option that only reading a calibration could follow.
void require_no_file_options(const RigScale& rig);

/// Reads them from keyword arguments. Throws UsageError.
MetricOptions metric_options(MetricOutput output, MapKind map, const pybind11::dict& keywords);

/// The camera of outputs in metres, and what a file says of its frame.
struct MetricCamera {
  MapCamera camera;
  std::string frame;
};

/// A map in the frame of a rectified pair.
struct MetricMap {
  ImageView<const float> disparity_px;
  Side side = Side::kLeft;
  const std::optional<MetricCamera>* known = nullptr;  ///< used where no other camera is given
};

/// Throws UsageError where neither `calibration` nor options say what the camera is, Error where
/// its scale is not known and `output` is in metres.
MetricCamera metric_camera(const MetricMap& map,
                           const std::optional<StereoCalibration>& calibration,
                           const MetricOptions& options, MetricOutput output);

Image<float> depths(const MetricMap& map, const MetricCamera& camera, const MetricOptions& options,
                    Execution& execution);
Image<float> depth_resolutions(const MetricMap& map, const MetricCamera& camera,
                               const MetricOptions& options, double default_step_px,
                               Execution& execution);

}  // namespace vantage::python
