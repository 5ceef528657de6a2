// Depths, points and surfaces of disparity maps.
#include "python/metres.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "engine/options/match_settings.h"
#include "engine/options/metric_settings.h"
#include "engine/reprojection/ply_file.h"
#include "engine/view_geometry/depth_resolution.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/options.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;

namespace {

void add_metric_settings(Settings& settings, MetricOptions& options, MetricOutput output,
                         MapKind map) {
  if (map == MapKind::kArray) {
    add_reference_setting(settings, options.side);
  }
  add_rig_scale_settings(settings, options.rig);
  if (output == MetricOutput::kPoints) {
    add_cloud_settings(settings, options.cloud);
  } else if (output == MetricOutput::kDepth) {
    add_max_depth_setting(settings, options.cloud.max_depth);
  } else if (output == MetricOutput::kDepthResolution) {
    add_disparity_resolution_setting(settings, options.disparity_resolution_px);
  }
}

template <MetricOutput output, MapKind map>
void declare_metric_options(py::module_& module, const char* call) {
  declare_options<MetricOptions>(
      module, call, map == MapKind::kArray ? ThreadOptions::kTaken : ThreadOptions::kNone,
      [](Settings& settings, MetricOptions& options) {
        add_metric_settings(settings, options, output, map);
      },
      {"already-rectified"});
}

}  // namespace

void require_no_file_options(const RigScale& rig) {
  if (rig.images_are_rectified) {
    throw UsageError(
        "already-rectified is of files, expected Calibration.load(path, already_rectified=True)");
  }
}

MetricOptions metric_options(MetricOutput output, MapKind map, const py::dict& keywords) {
  MetricOptions options;
  Settings settings;
  add_metric_settings(settings, options, output, map);
  set_options(settings, keywords);
  options.cloud.validate();
  require_disparity_resolution(options.disparity_resolution_px);
  require_no_file_options(options.rig);
  return options;
}

MetricCamera metric_camera(const MetricMap& map,
                           const std::optional<StereoCalibration>& calibration,
                           const MetricOptions& options, MetricOutput output) {
  const std::string name = !calibration                ? ""
                           : calibration->file.empty() ? "calibration"
                                                       : calibration->file;
  if (name.empty() && map.known != nullptr && *map.known && !options.rig.focal_length_px &&
      !options.rig.baseline_m) {
    return **map.known;
  }
  options.rig.validate(name);
  const int width = map.disparity_px.width();
  const int height = map.disparity_px.height();
  if (output == MetricOutput::kDepthResolution) {
    if (name.empty() && !options.rig.focal_length_px) {
      throw UsageError("--depth-resolution needs --calibration or --focal-length");
    }
  } else {
    options.rig.require_given(name, output == MetricOutput::kPoints ? "cloud" : "depth");
  }
  if (!calibration) {
    return {options.rig.camera(width, height, map.side, false), std::string(kCameraFrame)};
  }
  if (!calibration->is_rectified) {
    throw Error("the calibration is not one of rectified images, expected that of rectify()");
  }
  StereoCalibration cameras = *calibration;
  cameras.file = name;
  const double unit = output == MetricOutput::kDepthResolution
                          ? options.rig.unit_of(cameras).value_or(1)
                          : options.rig.required_unit_of(cameras);
  return {map_camera(rectified_pair(cameras, width, height), map.side, unit),
          std::string(kCameraFrame)};
}

Image<float> depths(const MetricMap& map, const MetricCamera& camera, const MetricOptions& options,
                    Execution& execution) {
  Image<float> depths_m;
  depth_map(map.disparity_px, camera.camera.scale, options.cloud.max_depth.value_or(kNoMaxDepth),
            execution, depths_m);
  return depths_m;
}

Image<float> depth_resolutions(const MetricMap& map, const MetricCamera& camera,
                               const MetricOptions& options, double default_step_px,
                               Execution& execution) {
  const double step_px = options.disparity_resolution_px.value_or(default_step_px);
  if (!(step_px > 0 && std::isfinite(step_px))) {
    throw UsageError(fmt::format("disparity-resolution is {}, expected a number above 0", step_px));
  }
  Image<float> resolution;
  depth_resolution_map(map.disparity_px, camera.camera.scale, step_px, execution, resolution);
  return resolution;
}

namespace {

using Calibration = std::optional<StereoCalibration>;

/// Of maps without levels, whose winners have fractions.
constexpr double kFractionalStep_px = 0.1;

/// Makes a map of a disparity map: depths or their resolution.
py::array to_metres(MetricOutput output, const py::object& disparity,
                    const Calibration& calibration, py::dict keywords) {
  Execution& execution = take_execution(keywords);
  const MetricOptions options = metric_options(output, MapKind::kArray, keywords);
  const DisparityMap map = map_from(disparity, "disparity");
  const MetricMap source{.disparity_px = map.view(), .side = options.side};
  return array_of(on_threads_of(execution, [&] {
    const MetricCamera camera = metric_camera(source, calibration, options, output);
    if (output == MetricOutput::kDisparity) {
      Image<float> disparity_px;
      disparity_map(map.view(), camera.camera.scale, execution, disparity_px);
      return disparity_px;
    }
    return output == MetricOutput::kDepth
               ? depths(source, camera, options, execution)
               : depth_resolutions(source, camera, options, kFractionalStep_px, execution);
  }));
}

/// Arrays that belong to a map, and their source of points.
class MapArrays {
 public:
  MapArrays(const py::object& disparity, const py::object& image, const py::object& unmatched,
            const py::object& confidence, bool bgr, py::dict keywords)
      : execution_(take_execution(keywords)),
        map_(map_from(disparity, "disparity")),
        options_(metric_options(MetricOutput::kPoints, MapKind::kArray, keywords)),
        image_(image, bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb, "image") {
    WhiteLevelSearch search;
    search.add(image_.photograph());
    white_level_ = search.found();
    RemarkWarnings().warn(white_level_.remarks);
    if (!unmatched.is_none()) {
      unmatched_ = mask_from(unmatched, "unmatched");
    }
    if (!confidence.is_none()) {
      confidence_ = map_from(confidence, "confidence");
    } else if (options_.cloud.reads_confidence()) {
      throw UsageError("cloud-min-confidence and cloud-confidence need a map, expected confidence");
    }
  }

  /// Calls make(source, options, execution) without the GIL.
  template <typename Make>
  auto with_source(const Calibration& calibration, const Make& make) const {
    return on_threads_of(execution_, [&] {
      const Photograph photograph = image_.photograph(white_level_);
      const MetricCamera camera =
          metric_camera({.disparity_px = map_.view(), .side = options_.side}, calibration, options_,
                        MetricOutput::kPoints);
      return make(CloudSource{.disparity_px = map_.view(),
                              .colours = &photograph,
                              .unmatched = unmatched_.view(),
                              .confidence = confidence_.view(),
                              .camera = camera.camera},
                  options_.cloud, execution_, camera.frame);
    });
  }

 private:
  Execution& execution_;
  DisparityMap map_;
  MetricOptions options_;
  PixelArray image_;
  WhiteLevel white_level_;
  Mask unmatched_;
  Image<float> confidence_;
};

FramedCloud to_cloud(const py::object& disparity, const py::object& image,
                     const Calibration& calibration, const py::object& unmatched,
                     const py::object& confidence, bool bgr, const py::dict& keywords) {
  return MapArrays(disparity, image, unmatched, confidence, bgr, keywords)
      .with_source(calibration, make_cloud);
}

FramedMesh to_mesh(const py::object& disparity, const py::object& image,
                   const Calibration& calibration, const py::object& unmatched,
                   const py::object& confidence, bool bgr, const py::dict& keywords) {
  return MapArrays(disparity, image, unmatched, confidence, bgr, keywords)
      .with_source(calibration, make_mesh);
}

/// Points in the unit of the calibration.
py::array to_points(const py::object& disparity, const StereoCalibration& calibration,
                    py::dict keywords) {
  Execution& execution = take_execution(keywords);
  Side side = Side::kLeft;
  Settings settings;
  add_reference_setting(settings, side);
  set_options(settings, keywords);
  const DisparityMap map = map_from(disparity, "disparity");
  if (!calibration.is_rectified) {
    throw Error("the calibration is not one of rectified images, expected that of rectify()");
  }
  return array_of(on_threads_of(execution, [&] {
    Image<float> points;
    reproject(map.view(), map_camera(rectified_pair(calibration, map.width(), map.height()), side),
              kNoMaxDepth, execution, points);
    return points;
  }));
}

}  // namespace

void bind_metres(py::module_& module) {
  module.def("depth", [](const py::object& disparity, const Calibration& calibration,
                         const py::dict& keywords) {
    return to_metres(MetricOutput::kDepth, disparity, calibration, keywords);
  });
  module.def("depth_resolution", [](const py::object& disparity, const Calibration& calibration,
                                    const py::dict& keywords) {
    return to_metres(MetricOutput::kDepthResolution, disparity, calibration, keywords);
  });
  module.def("disparity",
             [](const py::object& depth, const Calibration& calibration, const py::dict& keywords) {
               return to_metres(MetricOutput::kDisparity, depth, calibration, keywords);
             });
  module.def("cloud", &to_cloud);
  module.def("mesh", &to_mesh);
  module.def("reproject", &to_points);
  using enum MetricOutput;
  declare_metric_options<kDepth, MapKind::kArray>(module, "depth");
  declare_metric_options<kDepthResolution, MapKind::kArray>(module, "depth_resolution");
  declare_metric_options<kDisparity, MapKind::kArray>(module, "disparity");
  declare_metric_options<kPoints, MapKind::kArray>(module, "cloud");
  declare_metric_options<kPoints, MapKind::kArray>(module, "mesh");
  declare_metric_options<kDepth, MapKind::kResult>(module, "MatchResult.depth");
  declare_metric_options<kDepthResolution, MapKind::kResult>(module,
                                                             "MatchResult.depth_resolution");
  declare_metric_options<kPoints, MapKind::kResult>(module, "MatchResult.cloud");
  declare_metric_options<kPoints, MapKind::kResult>(module, "MatchResult.mesh");
  declare_options(module, "reproject", ThreadOptions::kTaken, add_reference_setting);
}

}  // namespace vantage::python
