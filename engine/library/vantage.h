#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vantage_c.h"

/// C++ for vantage_c.h, which says what all of it means. It is compiled with your program, so the
/// library needs no compiler like yours; C++17. Functions throw Error.
namespace vantage::v0 {

/// what(): vantage_last_error(). std::bad_alloc is thrown where memory ends.
class Error : public std::runtime_error {
 public:
  Error(vantage_status status, const std::string& text)
      : std::runtime_error(text), status_(status) {}
  /// VANTAGE_ERROR or VANTAGE_USAGE.
  [[nodiscard]] vantage_status status() const { return status_; }

 private:
  vantage_status status_;
};

inline void throw_unless_ok(vantage_status status) {
  if (status == VANTAGE_NO_MEMORY) {
    throw std::bad_alloc();
  }
  if (status != VANTAGE_OK) {
    throw Error(status, vantage_last_error());
  }
}

/// Pixels in your memory: T is uint8_t, uint16_t or float. row_bytes, is_bgr: see vantage_image.
template <typename T>
struct Image {
  T* pixels = nullptr;
  int width_px = 0;
  int height_px = 0;
  int channels = 1;
  std::ptrdiff_t row_bytes = 0;
  bool is_bgr = false;

  /// As vantage_image or, of a T that is not constant, as vantage_picture.
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

struct Remark {
  std::string text;
  bool is_warning = false;
};

/// Two images that were matched. Moved, not copied; functions may be called concurrently.
class Pair {
 public:
  explicit Pair(vantage_pair* pair) : pair_(pair) {}

  /// vantage_pair_disparity()
  void disparity(vantage_side side, const Image<float>& map) const {
    const auto picture = map.as<vantage_picture>();
    throw_unless_ok(vantage_pair_disparity(pair_.get(), side, &picture));
  }
  /// vantage_pair_confidence()
  void confidence(vantage_side side, const Image<float>& map) const {
    const auto picture = map.as<vantage_picture>();
    throw_unless_ok(vantage_pair_confidence(pair_.get(), side, &picture));
  }
  /// vantage_pair_view()
  template <typename T>
  void view(double x, double y, const Image<T>& view) const {
    const auto picture = view.template as<vantage_picture>();
    throw_unless_ok(vantage_pair_view(pair_.get(), x, y, &picture));
  }
  /// All of vantage_pair_remark().
  [[nodiscard]] std::vector<Remark> remarks() const {
    std::vector<Remark> found;
    int is_warning = 0;
    while (const char* text = vantage_pair_remark(pair_.get(), found.size(), &is_warning)) {
      found.push_back({text, is_warning != 0});
    }
    return found;
  }

 private:
  struct Destroy {
    void operator()(vantage_pair* pair) const { vantage_pair_destroy(pair); }
  };
  std::unique_ptr<vantage_pair, Destroy> pair_;
};

/// Options and threads for many pairs. Moved, not copied; match() may be called concurrently.
class Matcher {
 public:
  /// vantage_matcher_create(): Matcher({"preset=quality", "disparities=0:63"}).
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

  /// vantage_match()
  template <typename T>
  [[nodiscard]] Pair match(const Image<T>& left, const Image<T>& right) const {
    const auto left_image = left.template as<vantage_image>();
    const auto right_image = right.template as<vantage_image>();
    vantage_pair* pair = nullptr;
    throw_unless_ok(vantage_match(matcher_.get(), &left_image, &right_image, &pair));
    return Pair(pair);
  }

 private:
  struct Destroy {
    void operator()(vantage_matcher* matcher) const { vantage_matcher_destroy(matcher); }
  };
  std::unique_ptr<vantage_matcher, Destroy> matcher_;
};

}  // namespace vantage::v0
