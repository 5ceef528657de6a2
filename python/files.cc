// Images and maps in files.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/left_out.h"
#include "engine/io/images/preview.h"
#include "engine/io/maps/map_io.h"
#include "engine/options/given_map_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/metres.h"
#include "python/options.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

ChannelOrder order_of(bool bgr) { return bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb; }

py::array read_image(const py::object& path, bool bgr, const py::dict& options) {
  const std::string file = path_of(path);
  PhotographReading reading;
  Settings settings;
  add_reading_settings(settings, reading);
  set_options(settings, options);
  Photograph photograph = without_gil([&] { return read_photograph(file, reading); });
  if (auto* const floats = std::get_if<Image<float>>(&photograph.pixels)) {
    erase_left_out(photograph.left_out, *floats);  // NaN again, as in the file
  }
  return array_of(std::move(photograph), order_of(bgr));
}

void write_image(const py::object& path, const py::object& image, bool bgr) {
  const std::string file = path_of(path);
  const PixelArray pixels(image, order_of(bgr), "image");
  without_gil([&] { write_photograph(file, pixels.copy()); });
}

/// Of a file: there is no report that would have notes.
void warn_of_assumed(std::vector<Remark>& remarks) {
  for (Remark& remark : remarks) {
    remark.kind = Remark::Kind::kWarning;
  }
  RemarkWarnings().warn(remarks);
}

py::array read_map(const py::object& path, double scale,
                   const std::optional<StereoCalibration>& calibration, py::dict keywords) {
  const std::string file = path_of(path);
  Execution& execution = take_execution(keywords);
  GivenMapOptions given;
  MetricOptions options;
  Settings settings;
  settings.choice<MapQuantity>(
      "given", given.quantity,
      {{"disparity", MapQuantity::kDisparity}, {"depth", MapQuantity::kDepth}}, "");
  add_rig_scale_settings(settings, options.rig, RigUse::kDepths);
  set_options(settings, keywords);
  if (!given.holds_depths() && (calibration || keywords.size() > 1)) {
    throw UsageError("cameras have no effect without given=\"depth\"");
  }
  given.depth_scale = scale;
  std::vector<Remark> remarks;
  // Reading alone does not wait for other work on the threads.
  if (!given.holds_depths()) {
    DisparityMap map = without_gil([&] { return read_disparity(file, scale, &remarks); });
    warn_of_assumed(remarks);
    return array_of(std::move(map));
  }
  DisparityMap map = on_threads_of(execution, [&] {
    const auto camera = [&](int width, int height) {
      const DisparityMap size(width, height);
      return metric_camera({.disparity_px = size.view()}, calibration, options,
                           MetricOutput::kDepth)
          .camera.scale;
    };
    return read_given_map(file, given, camera, execution, remarks);
  });
  if (scale == 0) {
    warn_of_assumed(remarks);
  }
  return array_of(std::move(map));
}

void write_map(const py::object& path, const py::object& disparity) {
  const std::string file = path_of(path);
  const DisparityMap map = map_from(disparity, "disparity");
  without_gil([&] { write_disparity(file, map.view()); });
}

void write_depths(const py::object& path, const py::object& depth) {
  const std::string file = path_of(path);
  DisparityMap depth_m = map_from(depth, "depth");
  // Depths that the file cannot hold are unknown, as in what the program writes.
  const auto largest_m = static_cast<float>(largest_depth_m(file));
  for (int y = 0; y < depth_m.height(); ++y) {
    std::replace_if(
        depth_m.row(y), depth_m.row(y) + depth_m.width(), [&](float z) { return z > largest_m; },
        std::numeric_limits<float>::quiet_NaN());
  }
  without_gil([&] { write_depth(file, depth_m.view()); });
}

py::array colours(const py::object& disparity, const py::object& limits) {
  const DisparityMap map = map_from(disparity, "disparity");
  PreviewRange range;
  if (limits.is_none()) {
    range = choose_preview_range(map.view());
  } else {
    try {
      const auto given = limits.cast<std::pair<float, float>>();
      range = {given.first, given.second};
    } catch (const py::cast_error&) {
      throw UsageError(
          fmt::format("limits is {}, expected two numbers", std::string(py::repr(limits))));
    }
  }
  return array_of({colour_preview(map.view(), range.min_px, range.max_px)}, ChannelOrder::kRgb);
}

}  // namespace

void bind_files(py::module_& module) {
  module.def("read_image", &read_image);
  module.def("write_image", &write_image);
  module.def("read_disparity", &read_map);
  module.def("write_disparity", &write_map);
  module.def("write_depth", &write_depths);
  module.def("colours", &colours);
}

}  // namespace vantage::python
