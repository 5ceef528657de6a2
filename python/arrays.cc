#include "python/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "engine/io/files/checksum.h"

namespace vantage::python {
namespace py = pybind11;

py::array to_array(const py::object& object, const std::string& name) {
  if (py::isinstance<py::array>(object)) {
    // Its mask would be lost without a word.
    if (py::isinstance(object, py::module_::import("numpy").attr("ma").attr("MaskedArray"))) {
      throw UsageError(name + ": the array is masked, expected one without a mask");
    }
    return py::reinterpret_borrow<py::array>(object);
  }
  if (!py::hasattr(object, "__array_interface__") && !py::hasattr(object, "__array__")) {
    throw py::type_error(fmt::format("{} is of type {}, expected a NumPy array", name,
                                     std::string(py::str(py::type::of(object).attr("__name__")))));
  }
  // Throws what the object's __array__ raises: a tensor on a GPU, or one with gradients.
  return py::module_::import("numpy").attr("asarray")(object);
}

std::string shape_text(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i == 0 ? "" : "x") + std::to_string(array.shape(i));
  }
  return array.ndim() == 0 ? "no dimension" : text;
}

namespace {

template <typename T>
PixelBuffer<T> buffer_of(const py::array& array, ChannelOrder order) {
  const bool has_channels = array.ndim() == 3;
  const auto size = [](py::ssize_t side) {
    return static_cast<int>(std::min<py::ssize_t>(side, 1 << 30));  // refused where too large
  };
  return {.data = static_cast<const T*>(array.data()),
          .width_px = size(array.shape(1)),
          .height_px = size(array.shape(0)),
          .channels = has_channels ? size(array.shape(2)) : 1,
          .row_bytes = array.strides(0),
          .pixel_bytes = array.strides(1),
          .channel_bytes = has_channels ? array.strides(2) : 0,
          .order = order};
}

/// A copy where a stride is 0 (of np.broadcast_to()), which a PixelBuffer cannot have.
py::array without_repetition(const py::array& array) {
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    if (array.strides(i) == 0 && array.shape(i) > 1) {
      return py::module_::import("numpy").attr("ascontiguousarray")(array);
    }
  }
  return array;
}

/// Runs `work` and names the image in its errors.
template <typename Work>
auto about(const std::string& name, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw UsageError(name + ": " + error.what());
  }
}

template <typename T>
void reverse_colours(Image<T>& image) {
  for (int y = 0; y < image.height() && image.channels() >= 3; ++y) {
    for (int x = 0; x < image.width(); ++x) {
      std::swap(image.at(x, y, 0), image.at(x, y, 2));
    }
  }
}

/// An array of one value per pixel.
py::array array_of_pixels(const py::object& object, const std::string& name) {
  py::array array = to_array(object, name);
  constexpr py::ssize_t kMaxSide = 65535;
  if (array.ndim() != 2 || array.shape(0) < 1 || array.shape(1) < 1 || array.shape(0) > kMaxSide ||
      array.shape(1) > kMaxSide) {
    throw UsageError(
        fmt::format("{}: the array has the shape {}, expected HxW", name, shape_text(array)));
  }
  return array;
}

/// A copy, converted to T.
template <typename T>
Image<T> image_of(const py::array& array) {
  const py::array_t<T, py::array::c_style | py::array::forcecast> values(array);
  const auto width = static_cast<int>(array.shape(1));
  const auto height = static_cast<int>(array.shape(0));
  return Image<T>::copy_of({values.data(), width, height, 1, static_cast<std::size_t>(width)});
}

/// `image` moves into the array.
template <typename T>
py::array_t<T> owning_array(Image<T> image) {
  auto* const owner = new Image<T>(std::move(image));
  const py::capsule capsule(owner, [](void* pixels) { delete static_cast<Image<T>*>(pixels); });
  return array_over(*owner, capsule);
}

}  // namespace

void PixelArray::take_pixels(ChannelOrder order) {
  if (py::isinstance<py::array_t<std::uint8_t>>(array_)) {
    buffer_ = buffer_of<std::uint8_t>(array_, order);
  } else if (py::isinstance<py::array_t<std::uint16_t>>(array_)) {
    buffer_ = buffer_of<std::uint16_t>(array_, order);
  } else if (py::isinstance<py::array_t<float>>(array_)) {
    buffer_ = buffer_of<float>(array_, order);
  } else {
    throw UsageError(
        fmt::format("{}: the array is of {}, expected uint8, uint16 or float32 (0 to 1)", name_,
                    std::string(py::str(array_.dtype()))));
  }
}

PixelArray::PixelArray(const py::object& object, ChannelOrder order, std::string name)
    : array_(to_array(object, name)), name_(std::move(name)) {
  if (array_.ndim() != 2 && array_.ndim() != 3) {
    throw UsageError(fmt::format("{}: the array has {} dimensions ({}), expected HxW or HxWx3",
                                 name_, array_.ndim(), shape_text(array_)));
  }
  take_pixels(order);
  about(name_, [&] {
    return std::visit([](const auto& buffer) { check_pixel_buffer(buffer); }, buffer_);
  });
  array_ = without_repetition(array_);
  take_pixels(order);
}

Photograph PixelArray::photograph(const WhiteLevel& level) const {
  Photograph read = about(name_, [&] {
    return std::visit([](const auto& buffer) { return photograph_of(buffer); }, buffer_);
  });
  if (level.scales(read)) {
    read = copy();
    level.apply(read);
  }
  return read;
}

Photograph PixelArray::copy() const {
  return about(name_, [&] {
    return std::visit([](const auto& buffer) { return copied_photograph(buffer); }, buffer_);
  });
}

std::uint32_t PixelArray::checksum() const {
  const Photograph pixels = photograph();
  return std::visit(
      [](const auto& image) {
        using Value = std::remove_cvref_t<decltype(image.at(0, 0))>;
        const auto row_bytes = sizeof(Value) * static_cast<std::size_t>(image.width()) *
                               static_cast<std::size_t>(image.channels());
        const auto bytes_of = [](const Value* values, std::size_t count) {
          return std::span(reinterpret_cast<const std::uint8_t*>(values), count);
        };
        if (image.view().stride() * sizeof(Value) == row_bytes) {
          return crc32_of(
              bytes_of(image.row(0), row_bytes * static_cast<std::size_t>(image.height())));
        }
        std::vector<std::uint32_t> rows(static_cast<std::size_t>(image.height()));
        for (int y = 0; y < image.height(); ++y) {
          rows[static_cast<std::size_t>(y)] = crc32_of(bytes_of(image.row(y), row_bytes));
        }
        return crc32_of({reinterpret_cast<const std::uint8_t*>(rows.data()),
                         rows.size() * sizeof(std::uint32_t)});
      },
      pixels.pixels);
}

template <typename T>
py::array_t<T> array_over(const Image<T>& image, const py::object& owner) {
  const auto value = static_cast<py::ssize_t>(sizeof(T));
  const auto row = static_cast<py::ssize_t>(image.view().stride()) * value;
  const py::ssize_t channels = image.channels();
  if (channels == 1) {
    return py::array_t<T>({py::ssize_t{image.height()}, py::ssize_t{image.width()}}, {row, value},
                          image.row(0), owner);
  }
  return py::array_t<T>({py::ssize_t{image.height()}, py::ssize_t{image.width()}, channels},
                        {row, channels * value, value}, image.row(0), owner);
}
template py::array_t<float> array_over(const Image<float>& image, const py::object& owner);
template py::array_t<std::uint8_t> array_over(const Image<std::uint8_t>& image,
                                              const py::object& owner);

py::array array_of(Photograph photograph, ChannelOrder order) {
  return std::visit(
      [&](auto& image) -> py::array {
        if (order == ChannelOrder::kBgr) {
          reverse_colours(image);
        }
        return owning_array(std::move(image));
      },
      photograph.pixels);
}

py::array_t<float> array_of(Image<float> image) { return owning_array(std::move(image)); }

py::array_t<bool> array_of(ImageView<const std::uint8_t> mask) {
  py::array_t<bool> result({mask.height(), mask.width()});
  for (int y = 0; y < mask.height(); ++y) {
    std::transform(mask.row(y), mask.row(y) + mask.width(), result.mutable_data(y, 0),
                   [](std::uint8_t value) { return value != 0; });
  }
  return result;
}

DisparityMap map_from(const py::object& object, const std::string& name) {
  const py::array array = array_of_pixels(object, name);
  if (!py::isinstance<py::array_t<float>>(array) && !py::isinstance<py::array_t<double>>(array)) {
    throw UsageError(fmt::format("{}: the array is of {}, expected float32", name,
                                 std::string(py::str(array.dtype()))));
  }
  return image_of<float>(array);
}

Mask mask_from(const py::object& object, const std::string& name) {
  const py::array array = array_of_pixels(object, name);
  if (!py::isinstance<py::array_t<bool>>(array) &&
      !py::isinstance<py::array_t<std::uint8_t>>(array)) {
    throw UsageError(fmt::format("{}: the array is of {}, expected bool or uint8", name,
                                 std::string(py::str(array.dtype()))));
  }
  Mask mask = image_of<std::uint8_t>(array);
  for (int y = 0; y < mask.height(); ++y) {
    std::transform(mask.row(y), mask.row(y) + mask.width(), mask.row(y),
                   [](std::uint8_t value) { return value != 0 ? 255 : 0; });
  }
  return mask;
}

}  // namespace vantage::python
