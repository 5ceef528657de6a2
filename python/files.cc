// Images and maps in files.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/left_out.h"
#include "engine/io/images/preview.h"
#include "engine/io/maps/map_io.h"
#include "engine/options/pair_source_settings.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/options.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

ChannelOrder order_of(bool bgr) { return bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb; }

/// NaN where floats have no data, as in files and arrays.
Photograph with_nan(Photograph photograph) {
  if (auto* const floats = std::get_if<Image<float>>(&photograph.pixels)) {
    erase_left_out(photograph.left_out, *floats);
  }
  return photograph;
}

py::array read_image(const py::object& path, bool bgr, const py::dict& options) {
  const std::string file = path_of(path);
  PhotographReading reading;
  Settings settings;
  add_reading_settings(settings, reading);
  set_options(settings, options);
  return array_of(without_gil([&] { return with_nan(read_photograph(file, reading)); }),
                  order_of(bgr));
}

void write_image(const py::object& path, const py::object& image, bool bgr) {
  const std::string file = path_of(path);
  const PixelArray pixels(image, order_of(bgr), "image");
  without_gil([&] { write_photograph(file, with_nan(pixels.copy())); });
}

/// Reads by read_disparity or read_depth. There is no report that would have notes, so all remarks
/// are warnings.
template <Image<float> (*kRead)(const std::filesystem::path&, double, std::vector<Remark>*)>
py::array read_map(const py::object& path, double scale) {
  const std::string file = path_of(path);
  std::vector<Remark> remarks;
  Image<float> map = without_gil([&] { return kRead(file, scale, &remarks); });
  for (Remark& remark : remarks) {
    remark.kind = Remark::Kind::kWarning;
  }
  RemarkWarnings().warn(remarks);
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
  declare_options(module, "read_image", ThreadOptions::kNone, add_reading_settings);
  module.def("write_image", &write_image);
  module.def("read_disparity", &read_map<read_disparity>);
  module.def("read_depth", &read_map<read_depth>);
  module.def("write_disparity", &write_map);
  module.def("write_depth", &write_depths);
  module.def("colours", &colours);
}

}  // namespace vantage::python
