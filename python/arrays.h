#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <variant>

#include "engine/vantage.h"

namespace vantage::python {

/// The pixels of an array, which keeps them alive. Made with the GIL; used with or without it.
class PixelArray {
 public:
  /// A NumPy array, or what has one (PIL images): uint8, uint16 or float32, H×W or H×W×C. Throws
  /// TypeError for other objects, UsageError, which starts with `name`, for other arrays.
  PixelArray(const pybind11::object& object, ChannelOrder order, std::string name);

  /// Reads the pixels in place where their layout allows and nothing is to be scaled. Throws Error,
  /// which starts with the name.
  [[nodiscard]] Photograph photograph(const WhiteLevel& level = {}) const;
  [[nodiscard]] Photograph copy() const;
  /// CRC-32 of all pixels.
  [[nodiscard]] std::uint32_t checksum() const;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  /// Sets buffer_.
  void take_pixels(ChannelOrder order);

  pybind11::array array_;
  std::string name_;
  std::variant<PixelBuffer<std::uint8_t>, PixelBuffer<std::uint16_t>, PixelBuffer<float>> buffer_;
};

/// The pixels of `image` as an array that keeps `owner` alive.
template <typename T>
pybind11::array_t<T> array_over(const Image<T>& image, const pybind11::object& owner);

/// Arrays that own their pixels. Of photographs, in this order.
pybind11::array array_of(Photograph photograph, ChannelOrder order);
pybind11::array_t<float> array_of(Image<float> image);
/// True where the mask is set.
pybind11::array_t<bool> array_of(ImageView<const std::uint8_t> mask);

/// `object` as an array. Throws TypeError that starts with `name` for what has none, UsageError for
/// a masked one.
pybind11::array to_array(const pybind11::object& object, const std::string& name);
/// "480x640x3".
std::string shape_text(const pybind11::array& array);

/// An H×W array of bool or uint8, where 0 is false, as a mask. Throws UsageError.
Mask mask_from(const pybind11::object& object, const std::string& name);
/// An H×W array of floats (float32 or float64) as a map. Throws UsageError.
DisparityMap map_from(const pybind11::object& object, const std::string& name);

}  // namespace vantage::python
