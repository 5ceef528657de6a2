#include "engine/image/transposed.h"

#include <cstdint>
#include <opencv2/core.hpp>
#include <variant>

namespace vantage {
namespace {

// cv::transpose() does not change its source, but cv::Mat has no view of constant pixels.
template <typename T>
cv::Mat wrap(ImageView<const T> image) {
  return {image.height(), image.width(), CV_MAKETYPE(cv::DataType<T>::depth, image.channels()),
          const_cast<T*>(image.data()),  // NOLINT(cppcoreguidelines-pro-type-const-cast)
          image.stride() * sizeof(T)};
}

template <typename T>
Image<T> transpose(ImageView<const T> image) {
  if (image.empty()) {
    return {};
  }
  Image<T> result(image.height(), image.width(), image.channels());
  cv::Mat target = wrap<T>(result.view());
  cv::transpose(wrap(image), target);
  return result;
}

}  // namespace

Photograph transposed(const Photograph& photograph) {
  return std::visit(
      [&]<typename T>(const Image<T>& image) {
        return Photograph{transpose<T>(image.view()), photograph.origin,
                          transposed(photograph.left_out.view())};
      },
      photograph.pixels);
}

DisparityMap transposed(ImageView<const float> map) { return transpose(map); }
Mask transposed(ImageView<const std::uint8_t> mask) { return transpose(mask); }

}  // namespace vantage
