// Rectification of pairs.
#include "python/rectification.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <utility>
#include <vector>

#include "engine/options/pair_source_settings.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/options.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

struct RectifiedImages {
  Photograph left;
  Photograph right;
  StereoCalibration calibration;
  StereoCalibration cameras;  ///< of the given images
  std::optional<double> row_error_px;
  PixelRectangle valid;
};

RectifiedImages rectify(const Photograph& left, const Photograph& right,
                        const std::optional<StereoCalibration>& given,
                        const RectificationOptions& options, Execution& execution) {
  const int width = left.width();
  const int height = left.height();
  if (right.width() != width || right.height() != height) {
    throw Error(
        fmt::format("the left image has {}x{} pixels and the right one {}x{}, expected "
                    "equal sizes",
                    width, height, right.width(), right.height()));
  }
  Rectification rectification;
  if (given) {
    rectification.calibration = *given;
  } else {
    rectification.matches = match_features(left, right);
    rectification.estimate = estimate_rig(rectification.matches, width, height);
    rectification.calibration = rectification.estimate->calibration;
  }
  Rectifier rectifier(rectification.calibration, width, height, options);
  RectifiedImages result;
  const auto apply = [&] {
    rectifier.apply(left, Side::kLeft, result.left, execution);
    rectifier.apply(right, Side::kRight, result.right, execution);
    blacken_left_out(result.left);
    blacken_left_out(result.right);
  };
  apply();
  if (!given) {
    const std::vector<PointMatch> found = match_features(result.left, result.right);
    rectification.remaining = vertical_error(found);
    improve_rectification(rectification, rectifier, found, options);
    require_success(rectification, found.size(), "left and right");
    result.row_error_px = rectification.remaining->rms_px;
    apply();
  }
  result.cameras = rectification.calibration;
  result.calibration = rectified_calibration(rectifier.pair(), result.cameras);
  result.valid = rectifier.pair().valid;
  return result;
}

py::tuple to_rectify(const py::object& left, const py::object& right,
                     const std::optional<StereoCalibration>& calibration, double kept_outline,
                     bool bgr, py::dict keywords) {
  Execution& execution = take_execution(keywords);
  Settings settings;
  std::optional<double> white_level;
  add_white_level_setting(settings, white_level);
  set_options(settings, keywords);
  const RectificationOptions options{kept_outline};
  options.validate();
  const ChannelOrder order = bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb;
  const PixelArray left_pixels(left, order, "left");
  const PixelArray right_pixels(right, order, "right");
  std::vector<Remark> scaled;
  RectifiedImages result = on_threads_of(execution, [&] {
    Photograph pair[] = {left_pixels.copy(), right_pixels.copy()};
    Photograph* const both[] = {&pair[0], &pair[1]};
    scaled = scale_to_white_level(both, white_level);
    return rectify(std::move(pair[0]), std::move(pair[1]), calibration, options, execution);
  });
  RemarkWarnings().warn(scaled);
  return py::make_tuple(
      array_of(std::move(result.left), order), array_of(std::move(result.right), order),
      result.calibration, result.cameras, result.row_error_px,
      py::make_tuple(result.valid.x, result.valid.y, result.valid.width, result.valid.height));
}

}  // namespace

StereoCalibration rectified_calibration(const RectifiedPair& pair,
                                        const StereoCalibration& cameras) {
  StereoCalibration calibration;
  calibration.left.matrix = pair.left.matrix;
  calibration.right.matrix = pair.right.matrix;
  calibration.translation = {-pair.baseline, 0, 0};
  calibration.image_size = {pair.width_px, pair.height_px};
  calibration.is_rectified = true;
  calibration.format = "rectified calibration";
  calibration.file = cameras.file;
  calibration.metres_per_unit = cameras.metres_per_unit;
  calibration.has_scale = cameras.has_scale;
  return calibration;
}

void bind_rectification(py::module_& module) {
  module.def("rectify", &to_rectify);
  declare_options(module, "rectify", ThreadOptions::kTaken, add_white_level_setting);
}

}  // namespace vantage::python
