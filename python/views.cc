// New views of pairs.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <vector>

#include "engine/options/calibration_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/synthesis_settings.h"
#include "engine/options/wanted_views.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/matcher.h"
#include "python/options.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

/// Everything that a call of synthesize() can set.
struct ViewSetup {
  WantedViews views;
  SynthesisOptions synthesis;
  RectificationOptions rectification;
  MatchOptions match = options_with_found_range();
  std::optional<double> white_level;
  RowMode rows = RowMode::kAuto;
};

void add_view_settings(Settings& settings, ViewSetup& setup) {
  add_wanted_views(settings, setup.views);
  add_synthesis_settings(settings, setup.synthesis);
  add_kept_outline_setting(settings, setup.rectification);
  add_match_settings(settings, setup.match);
  add_white_level_setting(settings, setup.white_level);
  add_rows_setting(settings, setup.rows);
}

void rectify_pair(const StereoCalibration& calibration, const RectificationOptions& options,
                  PairWithMaps& pair, Execution& execution) {
  Rectifier rectifier(calibration, pair.left.width(), pair.left.height(), options);
  pair.cameras = rectifier.pair();
  if (rectifier.needs_rectification()) {
    const UnrectifiedImages& read = pair.unrectified.emplace(
        UnrectifiedImages{std::move(rectifier), std::move(pair.left), std::move(pair.right)});
    read.rectifier.apply(read.left, Side::kLeft, pair.left, execution);
    read.rectifier.apply(read.right, Side::kRight, pair.right, execution);
  }
}

void require_size(const DisparityMap& map, const Photograph& image, const char* name) {
  if (map.width() != image.width() || map.height() != image.height()) {
    throw UsageError(std::string(name) + ": the map has " + std::to_string(map.width()) + "x" +
                     std::to_string(map.height()) + " pixels, expected " +
                     std::to_string(image.width()) + "x" + std::to_string(image.height()) +
                     ", those of the rectified image");
  }
}

std::vector<Photograph> render(const ViewSetup& setup, std::vector<ViewPose>& poses,
                               const PairWithMaps& pair, Execution& execution) {
  complete_poses(setup.views, pair.cameras ? &*pair.cameras : nullptr, pair.left.width(),
                 pair.left.height(), poses);
  ViewRenderer renderer(pair, setup.synthesis, std::nullopt, execution);
  renderer.check(poses);
  if (poses.size() > 1) {
    renderer.fix_intensities();
  }
  std::vector<Photograph> images;
  for (const ViewPose& pose : poses) {
    RenderedView view;
    renderer.render(pose, view);
    images.push_back(std::move(view.eyes[0].image));
  }
  return images;
}

py::list synthesize(const py::object& left, const py::object& right, const py::object& left_map,
                    const py::object& right_map,
                    const std::optional<StereoCalibration>& calibration, bool bgr,
                    py::dict keywords) {
  ViewSetup setup;
  Execution& execution = take_execution(keywords);
  Settings settings;
  add_view_settings(settings, setup);
  set_options(settings, keywords);
  setup.synthesis.validate();
  setup.rectification.validate();
  setup.match.validate();
  if (left_map.is_none() != right_map.is_none()) {
    throw UsageError("one of disparity and right_disparity is missing, expected both or none");
  }
  const ChannelOrder order = bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb;
  const PixelArray left_pixels(left, order, "left");
  const PixelArray right_pixels(right, order, "right");
  PairWithMaps pair;
  Photograph* const both[] = {&pair.left, &pair.right};
  std::vector<Remark> found;
  if (!left_map.is_none()) {
    pair.maps.left.disparity_px = map_from(left_map, "disparity");
    pair.maps.right.disparity_px = map_from(right_map, "right_disparity");
  }
  std::vector<ViewPose> poses = poses_of(setup.views, read_toml);
  MatchReport report;
  std::vector<Photograph> images = on_threads_of(execution, [&] {
    pair.left = left_pixels.copy();
    pair.right = right_pixels.copy();
    require_equal_shapes(pair.left, pair.right);
    found = scale_to_white_level(both, setup.white_level);
    if (calibration) {
      rectify_pair(*calibration, setup.rectification, pair, execution);
    }
    if (!pair.maps.left.disparity_px.empty()) {
      require_size(pair.maps.left.disparity_px, pair.left, "disparity");
      require_size(pair.maps.right.disparity_px, pair.right, "right_disparity");
    }
    if (setup.rows == RowMode::kAuto) {
      correct_pair(expects_negative_disparities(setup.match), execution, pair, found);
    }
    if (pair.maps.left.disparity_px.empty()) {
      PairMatcher(setup.match, execution, RowMode::kAsIs)
          .match(pair.left, pair.right, {}, pair.maps, &report);
    }
    return render(setup, poses, pair, execution);
  });
  RemarkWarnings().warn(found);
  RemarkWarnings().warn(report.remarks);
  py::list arrays;
  for (Photograph& image : images) {
    arrays.append(array_of(std::move(image), order));
  }
  return arrays;
}

}  // namespace

void bind_views(py::module_& module) {
  module.def("synthesize", &synthesize);
  declare_options(module, "synthesize", ThreadOptions::kTaken, add_view_settings);
}

}  // namespace vantage::python
