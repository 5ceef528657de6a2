#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vantage_c.h"

/// @file
/// C++17 for vantage_c.h.

/// C++ for vantage_c.h, whose rules for threads, memory and pixels hold. It is compiled with your
/// program, so the library needs no compiler like yours. Functions throw Error, and std::bad_alloc
/// for #VANTAGE_NO_MEMORY; then their outputs are as they were.
namespace vantage::v0 {

/// What a function could not do; what() is the text of vantage_last_error(), one line.
class Error : public std::runtime_error {
 public:
  /// `status` of a call that failed, and its `text`.
  Error(vantage_status status, const std::string& text)
      : std::runtime_error(text), status_(status) {}
  /// #VANTAGE_ERROR or #VANTAGE_USAGE.
  [[nodiscard]] vantage_status status() const { return status_; }

 private:
  vantage_status status_;
};

/// Throws the last error of this thread, unless `status` is #VANTAGE_OK. For calls of vantage_c.h.
inline void throw_unless_ok(vantage_status status) {
  if (status == VANTAGE_NO_MEMORY) {
    throw std::bad_alloc();
  }
  if (status != VANTAGE_OK) {
    throw Error(status, vantage_last_error());
  }
}

/// Pixels in your memory: T is uint8_t, uint16_t or float, constant where they are only read.
/// Copies of an Image share its pixels.
template <typename T>
struct Image {
  T* pixels = nullptr;           ///< The upper left pixel.
  int width_px = 0;              ///< Columns, 1 to 65500.
  int height_px = 0;             ///< Rows, 1 to 65500.
  int channels = 1;              ///< 1: grey, 3: RGB, 4: RGB and alpha.
  std::ptrdiff_t row_bytes = 0;  ///< From a row to the next one; 0: rows follow each other.
  bool is_bgr = false;           ///< Whether blue is first and red third.

  /// This image as a struct of the C interface. Struct is vantage_image, or vantage_picture where T
  /// is not constant.
  template <typename Struct>
  [[nodiscard]] Struct as() const {
    Struct image{};
    image.struct_size = sizeof(Struct);
    image.pixels = pixels;
    image.width_px = width_px;
    image.height_px = height_px;
    image.row_bytes = row_bytes;
    image.channels = channels;
    image.bits = 8 * static_cast<int>(sizeof(T));
    image.is_bgr = is_bgr ? 1 : 0;
    return image;
  }
};

/// What was found in the images, assumed or corrected.
struct Remark {
  std::string text;         ///< One line.
  bool is_warning = false;  ///< Whether the maps may be wrong for it; else a note.
};

/// Two images that were matched, and their maps. It can be moved, not copied, and may outlive its
/// Matcher. Thread rule: functions may be called concurrently.
class Pair {
 public:
  /// Takes `pair`, and destroys it in the end.
  explicit Pair(vantage_pair* pair) : pair_(pair, &vantage_pair_destroy) {}

  /// Fills `map`, of the size of the images and 1 channel, with the disparities of an image in
  /// pixels, x_left - x_right; NaN where unknown. Throws Error for another shape.
  /// See vantage_pair_disparity().
  void disparity(vantage_side side, const Image<float>& map) const {
    const auto picture = map.as<vantage_picture>();
    throw_unless_ok(vantage_pair_disparity(pair_.get(), side, &picture));
  }
  /// Fills `map`, shaped as for disparity(), with the probability that a disparity is within 1 px
  /// of the true one: 0 to 1, 0 where unknown. The first call takes about as long as
  /// Matcher::match(). Throws Error for another shape. See vantage_pair_confidence().
  void confidence(vantage_side side, const Image<float>& map) const {
    const auto picture = map.as<vantage_picture>();
    throw_unless_ok(vantage_pair_confidence(pair_.get(), side, &picture));
  }
  /// Fills `view`, of the size, channels and T of the images, with what a camera at (x, y) sees. In
  /// baselines, -16 to 16: (0, 0) is the left camera, (1, 0) the right one, positive y is below.
  /// Throws Error for another shape, and beyond 16. See vantage_pair_view().
  template <typename T>
  void view(double x, double y, const Image<T>& view) const {
    const auto picture = view.template as<vantage_picture>();
    throw_unless_ok(vantage_pair_view(pair_.get(), x, y, &picture));
  }
  /// All that was found in the images, assumed or corrected. See vantage_pair_remark().
  [[nodiscard]] std::vector<Remark> remarks() const {
    std::vector<Remark> found;
    int is_warning = 0;
    while (const char* text = vantage_pair_remark(pair_.get(), found.size(), &is_warning)) {
      found.push_back({text, is_warning != 0});
    }
    return found;
  }

 private:
  std::unique_ptr<vantage_pair, decltype(&vantage_pair_destroy)> pair_;
};

/// Options and threads for many pairs; keep it from pair to pair. It can be moved, not copied.
/// Thread rule: match() may be called concurrently; calls share the threads.
class Matcher {
 public:
  /// Takes options of `vantage match` and `vantage synth`, such as Matcher({"preset=quality",
  /// "disparities=0:63"}). The defaults are the preset balanced, a range of disparities that is
  /// found for each pair, and all processors. Throws Error for an unknown option, a wrong value,
  /// and what cannot be combined. See vantage_matcher_create().
  explicit Matcher(const std::vector<std::string>& options = {}) {
    std::vector<const char*> texts;
    texts.reserve(options.size());
    for (const std::string& option : options) {
      texts.push_back(option.c_str());
    }
    vantage_matcher* matcher = nullptr;
    throw_unless_ok(vantage_matcher_create(texts.data(), texts.size(), &matcher));
    matcher_.reset(matcher);
  }

  /// Makes the maps of both images of a rectified pair of equal size and channels, which are
  /// copied. Throws Error for shapes that differ or are out of range. See vantage_match().
  template <typename T>
  [[nodiscard]] Pair match(const Image<T>& left, const Image<T>& right) const {
    const auto left_image = left.template as<vantage_image>();
    const auto right_image = right.template as<vantage_image>();
    vantage_pair* pair = nullptr;
    throw_unless_ok(vantage_match(matcher_.get(), &left_image, &right_image, &pair));
    return Pair(pair);
  }

 private:
  std::unique_ptr<vantage_matcher, decltype(&vantage_matcher_destroy)> matcher_{
      nullptr, &vantage_matcher_destroy};
};

}  // namespace vantage::v0
