#include "engine/synthesis/view_finisher.h"

#include <algorithm>
#include <utility>

#include "engine/synthesis/background_inpainting.h"
#include "engine/synthesis/background_texture.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/hole_fill/hole_fill.h"
#include "kernels/soft_edges/soft_edges.h"

namespace vantage {
namespace {

// At a hole, the last background pixel is mixed with the surface that occluded the rest.
constexpr int kMixedPx = 1;

// Weight of an image whose surface ends at a pixel, relative to one where it continues.
constexpr float kTrustAtEnds = 0.1F;

}  // namespace

template <typename T>
ViewFinisher<T>::ViewFinisher(const SynthesisOptions& options, double alpha, OutlinePlaces outlines,
                              ImageView<T> image, ImageView<std::uint8_t> sources,
                              Execution& execution)
    : options_(options),
      alpha_(alpha),
      softens_(softens(options, alpha)),
      outlines_(std::move(outlines)),
      keeps_rows_(needs_whole_image(options.holes) ||
                  (softens_ && std::holds_alternative<EdgeCoverage>(outlines_))),
      image_(image),
      sources_(sources),
      execution_(execution) {
  if (keeps_rows_) {
    kept_memory_ = execution.scratch().lease(row_bytes(image.width()) *
                                             static_cast<std::size_t>(image.height()));
  }
  if (options.holes == HoleFilling::kInterpolate) {
    const auto height = static_cast<std::size_t>(image.height());
    hole_rows_memory_ = execution_.scratch().lease(sizeof(HoleRow) * height);
    hole_rows_ = {reinterpret_cast<HoleRow*>(hole_rows_memory_.data()), height};
    if (!keeps_rows_) {
      bands_.emplace(image.height(), row_bytes(image.width()), execution_);
    }
  }
}

template <typename T>
bool ViewFinisher<T>::softens(const SynthesisOptions& options, double alpha) {
  return options.soft_edges && alpha > 0 && alpha < 1;
}

template <typename T>
float ViewFinisher<T>::trust_at_ends(const SynthesisOptions& options, double alpha) {
  return softens(options, alpha) ? kTrustAtEnds : 1.0F;
}

template <typename T>
std::size_t ViewFinisher<T>::row_bytes(int width) {
  return sizeof(float) * (row_floats(width + 1, 1) + row_floats((3 * width + 3) / 4, 1));
}

template <typename T>
std::size_t ViewFinisher<T>::working_bytes(const SynthesisOptions& options, int width, int height,
                                           int channels) {
  if (!needs_whole_image(options.holes)) {
    return 0;
  }
  std::size_t bytes = row_bytes(width) * static_cast<std::size_t>(height);
  if (options.holes == HoleFilling::kInpaint) {
    bytes += inpainting_bytes(width, height, channels);
  } else if (options.holes == HoleFilling::kTexture) {
    bytes += texture_synthesis_bytes(width, height);
  }
  return bytes;
}

template <typename T>
std::size_t ViewFinisher<T>::surface_outline_bytes(int width, int height, int channels) {
  return row_bytes(width) * static_cast<std::size_t>(height) +
         outline_bytes(width, height, channels, sizeof(T));
}

template <typename T>
typename ViewFinisher<T>::RowMemory ViewFinisher<T>::row_memory(std::byte* memory) const {
  auto* disparity_px = reinterpret_cast<float*>(memory);
  auto* filled = reinterpret_cast<std::uint8_t*>(disparity_px + row_floats(image_.width() + 1, 1));
  auto* outlines = reinterpret_cast<std::int32_t*>(disparity_px + image_.width());
  return {disparity_px, outlines, filled, filled + image_.width()};
}

template <typename T>
typename ViewFinisher<T>::RowMemory ViewFinisher<T>::kept_row(int y) const {
  return row_memory(kept_memory_.data() + row_bytes(image_.width()) * static_cast<std::size_t>(y));
}

template <typename T>
ImageView<const float> ViewFinisher<T>::kept_disparity() const {
  return {kept_row(0).disparity_px, image_.width(), image_.height(), 1,
          row_bytes(image_.width()) / sizeof(float)};
}

template <typename T>
ImageView<const std::uint8_t> ViewFinisher<T>::kept_filled() const {
  return {kept_row(0).filled, image_.width(), image_.height(), 1, row_bytes(image_.width())};
}

template <typename T>
void ViewFinisher<T>::fill_row(const BlendedScanline& row, const RowMemory& memory) {
  const int width = image_.width();
  kernels::fill_holes_row(
      kernels::HoleFillRow<T>{.pixels = image_.row(row.y),
                              .disparity_px = row.disparity_px,
                              .width = width,
                              .channels = image_.channels(),
                              .gradient_limit_px = row.warped.gradient_limit_px,
                              .mixed_px = softens_ ? kMixedPx : 0,
                              .filled_disparity_px = memory.disparity_px,
                              .filled = memory.filled},
      options_.holes == HoleFilling::kMirror || options_.holes == HoleFilling::kTexture);
  std::uint8_t* sources = sources_.row(row.y);
  const std::uint8_t* filled = memory.filled;  // no member: stores of bytes cannot alias it
  for (int x = 0; x < width; ++x) {
    sources[x] = static_cast<std::uint8_t>(sources[x] & ~filled[x]);
  }
}

template <typename T>
void ViewFinisher<T>::finish_row(const BlendedScanline& row) {
  const bool is_completed_later = bands_ || keeps_rows_;
  const bool fills = options_.holes != HoleFilling::kNone && row.holes > 0;
  if (!is_completed_later && !fills && !softens_) {
    return;
  }
  scheduler::ScratchPool::Lease lease;
  if (!is_completed_later) {
    lease = execution_.scratch().lease(row_bytes(image_.width()));
  }
  const RowMemory memory = keeps_rows_ ? kept_row(row.y)
                           : bands_    ? row_memory(bands_->row(row.y))
                                       : row_memory(lease.data());
  make_row(row, memory);
  if (!is_completed_later) {
    mix_outlines(row.y, memory);
  } else if (bands_) {
    bands_->complete(
        row.y, [this](int first, int end) { interpolate_rows(first, end); },
        [this](int first, int end) {
          for (int y = first; y < end; ++y) {
            mix_outlines(y, row_memory(bands_->row(y)));
          }
        });
  }
}

template <typename T>
void ViewFinisher<T>::make_row(const BlendedScanline& row, const RowMemory& memory) {
  const int width = image_.width();
  if (options_.holes != HoleFilling::kNone && row.holes > 0) {
    fill_row(row, memory);
  } else {
    std::copy_n(row.disparity_px, width, memory.disparity_px);
    std::fill_n(memory.filled, width, std::uint8_t{0});
  }
  if ((bands_ || keeps_rows_) && row.holes == width) {
    std::fill_n(memory.filled, width, std::uint8_t{255});
  }
  if (!hole_rows_.empty()) {
    hole_rows_[static_cast<std::size_t>(row.y)] = {memory.filled, memory.disparity_px};
  }
  *memory.outlines = 0;
  if (const auto* offsets = std::get_if<std::array<double, 2>>(&outlines_);
      softens_ && offsets != nullptr) {
    *memory.outlines =
        kernels::outline_shares_row({.disparity_px = memory.disparity_px,
                                     .left_disparity_px = row.warped.left_disparity_px,
                                     .right_disparity_px = row.warped.right_disparity_px,
                                     .width = width,
                                     .gradient_limit_px = row.warped.gradient_limit_px,
                                     .alpha = static_cast<float>(alpha_),
                                     .left_offset = (*offsets)[0],
                                     .right_offset = (*offsets)[1]},
                                    memory.shares);
  }
}

template <typename T>
void ViewFinisher<T>::mix_outlines(int y, const RowMemory& memory) {
  if (*memory.outlines > 0) {
    kernels::mix_outlines_row(memory.shares, image_.width(), image_.channels(), image_.row(y));
  }
}

template <typename T>
void ViewFinisher<T>::interpolate_rows(int first, int end) {
  interpolate_background(image_, hole_rows_, first, end, options_.disparity_gradient_limit_px,
                         execution_);
}

template <typename T>
void ViewFinisher<T>::finish_view() {
  if (!keeps_rows_) {
    return;
  }
  const int height = image_.height();
  const double limit_px = options_.disparity_gradient_limit_px;
  if (options_.holes == HoleFilling::kInterpolate) {
    execution_.for_each_band(height, [&](int first, int end) { interpolate_rows(first, end); });
  } else if (options_.holes == HoleFilling::kInpaint) {
    inpaint_background(image_, kept_filled(), kept_disparity(), limit_px);
  } else if (options_.holes == HoleFilling::kTexture) {
    synthesize_background_texture(image_, kept_filled(), kept_disparity(), limit_px, execution_);
  }
  if (const auto* coverage = std::get_if<EdgeCoverage>(&outlines_); softens_ && coverage) {
    soften_outlines(*coverage, kept_disparity(), static_cast<float>(limit_px), image_, execution_);
  } else {
    execution_.for_each_row(height, [&](int y) { mix_outlines(y, kept_row(y)); });
  }
}

template class ViewFinisher<std::uint8_t>;
template class ViewFinisher<std::uint16_t>;
template class ViewFinisher<float>;

}  // namespace vantage
