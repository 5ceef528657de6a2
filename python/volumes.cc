// Volumes of the disparity space as arrays.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include "engine/options/volume_output.h"
#include "engine/out_of_memory.h"
#include "python/calls.h"
#include "python/matcher.h"
#include "python/options.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

double in_mib(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

/// Keeps rows of a volume in memory, pixel by pixel.
class MemoryVolume final : public VolumeSink {
 public:
  /// `rows`: the only ones to keep; empty: all. Throws Error in start() for more than `max_bytes`.
  MemoryVolume(std::optional<VolumeRows> rows, std::size_t max_bytes)
      : rows_(rows), max_bytes_(max_bytes) {}

  void start(const VolumeShape& shape) override {
    shape_ = shape;
    if (!rows_) {
      rows_ = VolumeRows{0, shape.height_px};
    }
    if (rows_->end > shape.height_px) {
      throw UsageError(fmt::format("volume-rows is {}:{}, expected rows within 0:{}", rows_->begin,
                                   rows_->end - 1, shape.height_px - 1));
    }
    const std::size_t row_values =
        static_cast<std::size_t>(shape.width_px) * static_cast<std::size_t>(shape.candidates());
    const std::size_t values = row_values * static_cast<std::size_t>(rows_->end - rows_->begin);
    if (values * sizeof(float) > max_bytes_) {
      throw Error(fmt::format(
          "the volume takes {:.0f} MiB, expected at most {:.0f}: ask for some rows, or raise "
          "max_bytes",
          in_mib(values * sizeof(float)), in_mib(max_bytes_)));
    }
    values_.reset(new (std::nothrow) float[values]);
    if (!values_) {
      throw OutOfMemory(fmt::format("a volume of {:.0f} MiB", in_mib(values * sizeof(float))));
    }
  }

  void write(int x, int y, int columns, const float* values) override {
    if (y < rows_->begin || y >= rows_->end) {
      return;
    }
    const auto candidates = static_cast<std::size_t>(shape_.candidates());
    const auto pixel =
        static_cast<std::size_t>(y - rows_->begin) * static_cast<std::size_t>(shape_.width_px) +
        static_cast<std::size_t>(x);
    std::copy_n(values, candidates * static_cast<std::size_t>(columns),
                values_.get() + pixel * candidates);
  }

  [[nodiscard]] const VolumeShape& shape() const { return shape_; }
  [[nodiscard]] VolumeRows rows() const { return *rows_; }

  /// The values move into it.
  [[nodiscard]] py::array_t<float> array() {
    std::vector<py::ssize_t> sides = {rows_->end - rows_->begin, shape_.width_px};
    if (shape_.disparities_y) {
      sides.push_back(shape_.disparities_y->count());
    }
    sides.push_back(shape_.row_candidates());
    float* const values = values_.release();
    const py::capsule owner(values, [](void* data) { delete[] static_cast<float*>(data); });
    return py::array_t<float>(sides, values, owner);
  }

 private:
  std::optional<VolumeRows> rows_;
  std::size_t max_bytes_;
  VolumeShape shape_;
  std::unique_ptr<float[]> values_;
};

/// Half of the machine's memory.
std::size_t default_max_bytes(const Execution& execution) {
  const std::size_t memory = execution.machine().memory_bytes;
  return memory > 0 ? memory / 2 : std::numeric_limits<std::size_t>::max();
}

}  // namespace

py::tuple Matcher::volume(const ImageArguments& arguments, const py::dict& keywords) const {
  check(arguments);
  if (unrectified_) {
    throw UsageError(
        "a volume cannot be had with unrectified: candidates differ by fractions from pixel to "
        "pixel");
  }
  std::size_t max_bytes = default_max_bytes(*setup_.execution);
  py::dict options = keywords.attr("copy")();
  if (const py::object given = options.attr("pop")("max_bytes", py::none()); !given.is_none()) {
    if (!py::isinstance<py::int_>(given) || given < py::int_(0)) {
      throw UsageError(fmt::format("max_bytes is {}, expected a whole number of at least 0",
                                   std::string(py::repr(given))));
    }
    max_bytes = given.cast<std::size_t>();
  }
  VolumeOutput output;
  Settings settings;
  add_volume_settings(settings, output);
  set_options(settings, options);
  output.file = "array";  // there is an output
  check_volume(output, setup_.options);
  MatchedImages images = arguments.images(setup_.white_level);
  MemoryVolume volume(output.rows, max_bytes);
  on_threads_of(*setup_.execution, [&] {
    const Side side = images.side(setup_.options.reference);
    const VolumeRequest request{side, output.kind, output.level, &volume};
    DisparityMaps maps;
    images.match(matcher_, images.read(),
                 {.left = side == Side::kLeft,
                  .right = side == Side::kRight,
                  .unmatched = false,
                  .volumes = {&request, 1}},
                 maps);
  });
  warnings_.warn(images.remarks());
  const VolumeShape shape = volume.shape();
  const auto range = [](const DisparityRange& disparities) {
    return py::make_tuple(disparities.min, disparities.max);
  };
  return py::make_tuple(
      volume.array(), range(shape.disparities), 1.0 / shape.steps_per_px,
      shape.disparities_y ? py::object(range(*shape.disparities_y)) : py::none(),
      shape.content == VolumeContent::kProbabilities ? "probabilities" : "energies", output.level,
      volume.rows().begin);
}

}  // namespace vantage::python
