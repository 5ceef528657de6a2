// What the core takes from OpenCV, for a build of the core alone. Callers ask has_opencv() first.
#include "engine/error.h"
#include "engine/io/images/black_border.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/rectification/feature_matches.h"
#include "engine/synthesis/background_inpainting.h"
#include "engine/with_opencv.h"

namespace vantage {

bool has_opencv() { return false; }

std::vector<PointMatch> match_features(const Photograph& /*left*/, const Photograph& /*right*/,
                                       const FeatureMatchOptions& /*options*/) {
  throw Error("points that images share are found by OpenCV, which this build is without");
}

void leave_opencv_to_host() {}

Mask black_border(const Photograph& /*photograph*/) { return {}; }

std::size_t inpainting_bytes(int /*width*/, int /*height*/, int /*channels*/) { return 0; }

template <typename T>
void inpaint_background(ImageView<T> /*image*/, ImageView<const std::uint8_t> /*wanted*/,
                        ImageView<const float> /*disparity_px*/, double /*gradient_limit_px*/) {
  throw Error("holes are inpainted by OpenCV, which this build is without");
}

template void inpaint_background(ImageView<std::uint8_t>, ImageView<const std::uint8_t>,
                                 ImageView<const float>, double);
template void inpaint_background(ImageView<std::uint16_t>, ImageView<const std::uint8_t>,
                                 ImageView<const float>, double);
template void inpaint_background(ImageView<float>, ImageView<const std::uint8_t>,
                                 ImageView<const float>, double);

}  // namespace vantage
