#include "engine/matching/windows/reduced_images.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "engine/image/intensity_rows.h"
#include "engine/image/left_out.h"
#include "engine/image/memory_use.h"
#include "engine/matching/levels/level_extents.h"
#include "kernels/byte_intensity/byte_intensity.h"

namespace vantage {
namespace {

using Bytes = Image<std::uint8_t>;

void halve_rows(const Bytes& finer, int first_row, int end_row, Bytes& coarser) {
  for (int y = first_row; y < end_row; ++y) {
    kernels::halved_intensity_row(finer.row(2 * y),
                                  finer.row(std::min(2 * y + 1, finer.height() - 1)), finer.width(),
                                  coarser.row(y));
  }
}

}  // namespace

void ReducedImages::prepare(const Photograph& photograph, int reductions, Execution& execution) {
  images_.resize(static_cast<std::size_t>(reductions) + 1);
  std::vector<Bytes> levels;
  scheduler::Extent extent{photograph.width(), photograph.height()};
  for (Photograph& image : images_) {
    levels.push_back(take_image<std::uint8_t>(image, {extent.columns, extent.rows, 1}));
    extent = coarser_extent(extent);
  }
  execution.for_each_band(levels[0].height(), [&](int first_row, int end_row) {
    const auto width = static_cast<std::size_t>(levels[0].width());
    const auto work = execution.scratch().lease(sizeof(float) * width);
    auto* const intensities = reinterpret_cast<float*>(work.data());
    for (int y = first_row; y < end_row; ++y) {
      intensity_row(photograph, y, intensities);
      kernels::rounded_intensity_row(intensities, levels[0].width(), levels[0].row(y));
    }
  });
  for (std::size_t i = 1; i < levels.size(); ++i) {
    execution.for_each_band(levels[i].height(), [&](int first_row, int end_row) {
      halve_rows(levels[i - 1], first_row, end_row, levels[i]);
    });
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    images_[i].pixels = std::move(levels[i]);
    if (i > 0) {
      images_[i].left_out = half_of(i == 1 ? photograph.left_out : images_[i - 1].left_out);
    }
  }
}

std::size_t ReducedImages::held_bytes() const {
  std::size_t bytes = 0;
  for (const Photograph& image : images_) {
    bytes += vantage::held_bytes(image);
  }
  return bytes;
}

}  // namespace vantage
