#include "engine/matching/noise/noise_filter.h"

#include <utility>

#include "engine/image/intensity_rows.h"
#include "engine/image/memory_use.h"
#include "kernels/intensity_diffusion/intensity_diffusion.h"

namespace vantage {
namespace {

void smooth(const Image<float>& from, double contrast, Execution& execution, Image<float>& to) {
  const int width = from.width();
  const int height = from.height();
  execution.for_each_band(height, [&](int first_row, int end_row) {
    const auto work = execution.scratch().lease(
        sizeof(float) * static_cast<std::size_t>(kernels::intensity_diffusion_work_floats(width)));
    for (int y = first_row; y < end_row; ++y) {
      kernels::intensity_diffusion_row({.up = y > 0 ? from.row(y - 1) : nullptr,
                                        .centre = from.row(y),
                                        .down = y + 1 < height ? from.row(y + 1) : nullptr,
                                        .width = width,
                                        .contrast = static_cast<float>(contrast),
                                        .work = reinterpret_cast<float*>(work.data()),
                                        .output = to.row(y)});
    }
  });
}

}  // namespace

const Photograph& SmoothedPhotograph::make(const Photograph& photograph, int channels,
                                           const NoiseFilter& filter, Execution& execution) {
  const int width = photograph.width();
  const int height = photograph.height();
  Image<float>& result = pixels_of<float>(result_);
  result.resize(width, height, channels);
  result_.left_out = Mask::borrowed(photograph.left_out.view());
  for (Image<float>& image : steps_) {
    image.resize(width, height);
  }
  for (int c = 0; c < channels; ++c) {
    execution.for_each_row(height, [&](int y) {
      if (channels == 1) {
        intensity_row(photograph, y, steps_[0].row(y));
      } else {
        channel_intensity_row(photograph, c, y, steps_[0].row(y));
      }
    });
    for (int n = 0; n < filter.steps; ++n) {
      smooth(steps_[0], filter.contrast_grey_levels, execution, steps_[1]);
      std::swap(steps_[0], steps_[1]);
    }
    execution.for_each_row(height, [&](int y) {
      const float* grey = steps_[0].row(y);
      float* pixels = result.row(y) + c;
      for (int x = 0; x < width; ++x) {
        pixels[x * channels] = grey[x] * (1 / kGreyLevelsPerUnit<float>);
      }
    });
  }
  return result_;
}

std::size_t SmoothedPhotograph::held_bytes() const {
  return vantage::held_bytes(result_) + vantage::held_bytes(steps_[0]) +
         vantage::held_bytes(steps_[1]);
}

}  // namespace vantage
