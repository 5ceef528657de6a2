#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/out_of_memory.h"

namespace vantage {

/// A view of pixels owned elsewhere. Channels are interleaved: the value of channel c at column x
/// is row(y)[x · channels + c]. Rows are `stride` values apart. Cheap to copy; does not keep the
/// pixels alive. `T` may be const.
template <typename T>
class ImageView {
 public:
  ImageView() = default;
  ImageView(T* data, int width, int height, int channels, std::size_t stride)
      : data_(data), width_(width), height_(height), channels_(channels), stride_(stride) {}
  /// A view of mutable pixels is also a view of constant ones.
  template <typename U>
  requires(std::is_same_v<T, const U>)
      ImageView(const ImageView<U>& other)  // NOLINT(google-explicit-constructor)
      : ImageView(other.data(), other.width(), other.height(), other.channels(), other.stride()) {}

  [[nodiscard]] T* data() const { return data_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] bool empty() const { return width_ == 0 || height_ == 0; }
  [[nodiscard]] T* row(int y) const { return data_ + stride_ * static_cast<std::size_t>(y); }
  [[nodiscard]] T& at(int x, int y, int channel = 0) const {
    return row(y)[x * channels_ + channel];
  }

 private:
  T* data_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
  std::size_t stride_ = 0;
};

/// Owns pixels, unless borrowed(). Move-only; copy() makes copies. Rows of its own are 64-byte
/// aligned, and their pitch is never a multiple of 2 KiB, so that neighbouring rows do not compete
/// for the same cache sets. T is uint8_t, uint16_t or float. Thread rule: as for a plain array.
template <typename T>
class Image {
 public:
  Image() = default;
  /// Pixels are uninitialised. Dimensions ≥ 0, channels ≥ 1. Throws OutOfMemory.
  Image(int width, int height, int channels = 1) { resize(width, height, channels); }
  Image(Image&& other) noexcept { *this = std::move(other); }
  Image& operator=(Image&& other) noexcept {
    memory_ = std::move(other.memory_);
    capacity_ = std::exchange(other.capacity_, 0);
    view_ = std::exchange(other.view_, {});
    return *this;
  }

  /// Changes the shape; contents are then undefined. Memory is reused if it suffices.
  void resize(int width, int height, int channels = 1) {
    const std::size_t row_bytes =
        sizeof(T) * static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    std::size_t pitch = (row_bytes + kAlignment - 1) / kAlignment * kAlignment;
    if (pitch > 0 && pitch % 2048 == 0) {
      pitch += kAlignment;
    }
    const std::size_t bytes = pitch * static_cast<std::size_t>(height);
    if (bytes > capacity_) {
      memory_.reset();
      capacity_ = 0;
      void* memory = ::operator new (bytes, std::align_val_t{kAlignment}, std::nothrow);
      if (memory == nullptr) {
        throw OutOfMemory("an image of " + std::to_string(width) + "x" + std::to_string(height) +
                          " pixels (" + std::to_string(bytes >> 20U) + " MiB)");
      }
      memory_.reset(static_cast<T*>(memory));
      capacity_ = bytes;
    }
    view_ = ImageView<T>(memory_.get(), width, height, channels, pitch / sizeof(T));
  }

  void fill(T value) {
    for (int y = 0; y < height(); ++y) {
      std::fill_n(row(y), static_cast<std::size_t>(width()) * static_cast<std::size_t>(channels()),
                  value);
    }
  }

  /// An image whose pixels are those of `source`, which must outlive it: only to be read.
  [[nodiscard]] static Image borrowed(ImageView<const T> source) {
    Image result;
    result.view_ = ImageView<T>(const_cast<T*>(source.data()), source.width(), source.height(),
                                source.channels(), source.stride());
    return result;
  }

  [[nodiscard]] Image copy() const { return copy_of(view()); }
  [[nodiscard]] static Image copy_of(ImageView<const T> source) {
    Image result(source.width(), source.height(), source.channels());
    for (int y = 0; y < source.height(); ++y) {
      std::copy_n(
          source.row(y),
          static_cast<std::size_t>(source.width()) * static_cast<std::size_t>(source.channels()),
          result.row(y));
    }
    return result;
  }

  [[nodiscard]] ImageView<T> view() { return view_; }
  [[nodiscard]] ImageView<const T> view() const { return view_; }
  [[nodiscard]] int width() const { return view_.width(); }
  [[nodiscard]] int height() const { return view_.height(); }
  [[nodiscard]] int channels() const { return view_.channels(); }
  [[nodiscard]] bool empty() const { return view_.empty(); }
  [[nodiscard]] T* row(int y) { return view_.row(y); }
  [[nodiscard]] const T* row(int y) const { return view_.row(y); }
  [[nodiscard]] T& at(int x, int y, int channel = 0) { return view_.at(x, y, channel); }
  [[nodiscard]] const T& at(int x, int y, int channel = 0) const { return view_.at(x, y, channel); }

 private:
  static constexpr std::size_t kAlignment = 64;
  struct Free {
    void operator()(T* memory) const noexcept {
      ::operator delete (memory, std::align_val_t{kAlignment});
    }
  };
  std::unique_ptr<T, Free> memory_;
  std::size_t capacity_ = 0;
  ImageView<T> view_;
};

/// Disparities in pixels of the map's own grid: d = x_left − x_right for both maps, NaN = unknown.
using DisparityMap = Image<float>;
/// 255 = set, 0 = not.
using Mask = Image<std::uint8_t>;

}  // namespace vantage
