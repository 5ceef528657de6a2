#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/synthesis/intensity_fit.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/view_finisher.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage {

/// The intensities are regressed on rows of the view at equal distances: at least this many, or all
/// if it has fewer. Neighbouring rows say the same.
inline constexpr int kFitRows = 64;

// Results of the parallel passes per row; reduced in row order.
struct ViewRowRecord {
  kernels::IntensitySums sums;
  int holes = 0;
};

/// Makes one view from the rows of `Warper`, RowPairWarper or SurfaceWarper.
template <typename T, typename Warper>
class ViewAssembly {
 public:
  ViewAssembly(const Warper& warper, const SynthesisOptions& options, int channels,
               Execution& execution)
      : warper_(warper),
        options_(options),
        execution_(execution),
        width_(warper.width()),
        height_(warper.height()),
        channels_(channels),
        layout_(width_, channels),
        records_memory_(
            execution.scratch().lease(sizeof(ViewRowRecord) * static_cast<std::size_t>(height_))),
        records_(reinterpret_cast<ViewRowRecord*>(records_memory_.data()),
                 static_cast<std::size_t>(height_)) {
    std::uninitialized_fill(records_.begin(), records_.end(), ViewRowRecord{});
  }

  void run(Image<T>& image, SynthesizedView& view, const std::array<IntensityFit, 4>* given_fit) {
    view.intensity = {};
    if (given_fit != nullptr) {
      view.intensity = *given_fit;
    } else if (options_.match_intensities) {
      view.intensity = fit_channels(intensity_sums(), channels_, double{kGreyLevelsPerUnit<T>});
    }
    image.resize(width_, height_, channels_);
    view.holes.resize(width_, height_);
    view.sources.resize(width_, height_);
    combine(image, view);
    if (options_.holes == HoleFilling::kInterpolate || options_.holes == HoleFilling::kMirror ||
        options_.holes == HoleFilling::kSpread) {
      fill_empty_rows(image);
    }
    std::int64_t holes = 0;
    for (const ViewRowRecord& record : records_) {
      holes += record.holes;
    }
    view.hole_fraction = static_cast<double>(holes) / (static_cast<double>(width_) * height_);
  }

  kernels::IntensitySums intensity_sums() {
    for_each_row(
        std::max(1, height_ / kFitRows), [&](int y, std::span<float> scratch, float* pair) {
          warper_.warp(y, scratch, pair);
          records_[static_cast<std::size_t>(y)].sums = kernels::intensity_sums_row(warped_in(pair));
        });
    kernels::IntensitySums total;
    for (const ViewRowRecord& record : records_) {
      total.add(record.sums);
    }
    return total;
  }

 private:
  [[nodiscard]] kernels::WarpedPairRow warped_in(const float* pair) const {
    return layout_.row_in(pair, options_.disparity_gradient_limit_px);
  }

  // Calls body(y, scratch memory, memory for a pair of warped scanlines) for every `step`th row,
  // from step / 2 on.
  template <typename Body>
  void for_each_row(int step, const Body& body) {
    const std::size_t scratch_floats = warper_.scratch_floats();
    const int first_y = step / 2;
    execution_.for_each_band((height_ - first_y + step - 1) / step, [&](int first, int end) {
      const auto memory =
          execution_.scratch().lease((scratch_floats + layout_.floats) * sizeof(float));
      auto* scratch = reinterpret_cast<float*>(memory.data());
      float* const pair = scratch + scratch_floats;
      for (int y = first_y + step * first; y < first_y + step * end; y += step) {
        body(y, std::span<float>(scratch, scratch_floats), pair);
      }
    });
  }

  // Returns the number of holes. `pair` has the disparities then.
  int blend_row(int y, const kernels::BlendWeights& weights, std::span<float> scratch, float* pair,
                const kernels::BlendedRow<T>& row) const {
    if constexpr (requires { warper_.blends(); }) {
      if (warper_.blends()) {
        return warper_.blend(y, weights, scratch, pair, row);
      }
    }
    warper_.warp(y, scratch, pair);
    return kernels::blend_row(warped_in(pair), weights, channels_, row);
  }

  void combine(Image<T>& image, SynthesizedView& view) {
    const double alpha = warper_.alpha();
    kernels::BlendWeights weights =
        blend_weights(view.intensity, alpha, options_.gamma, double{kGreyLevelsPerUnit<T>});
    weights.trust_at_ends = ViewFinisher<T>::trust_at_ends(options_, alpha);
    ViewFinisher<T> finisher(options_, alpha, outline_places(), image.view(), view.sources.view(),
                             execution_);
    for_each_row(1, [&](int y, std::span<float> scratch, float* pair) {
      const auto memory =
          execution_.scratch().lease(static_cast<std::size_t>(width_) * sizeof(float));
      auto* disparity_px = reinterpret_cast<float*>(memory.data());
      const int row_holes = blend_row(y, weights, scratch, pair,
                                      kernels::BlendedRow<T>{.pixels = image.row(y),
                                                             .disparity_px = disparity_px,
                                                             .holes = view.holes.row(y),
                                                             .sources = view.sources.row(y)});
      records_[static_cast<std::size_t>(y)].holes = row_holes;
      finisher.finish_row({y, warped_in(pair), disparity_px, row_holes});
    });
    finisher.finish_view();
  }

  [[nodiscard]] OutlinePlaces outline_places() const {
    if constexpr (requires { warper_.camera_offsets(); }) {
      return warper_.camera_offsets();
    } else {
      return [this](const SurfaceEdge& edge) { return warper_.coverage(edge); };
    }
  }

  [[nodiscard]] bool empty_row(int y) const {
    return records_[static_cast<std::size_t>(y)].holes == width_;
  }

  // A row without pixels copies the nearest row that has some; the upper one on a tie.
  void fill_empty_rows(Image<T>& image) {
    const std::size_t values =
        static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
    int y = 0;
    while (y < height_) {
      const int begin = y;
      while (y < height_ && empty_row(y)) {
        ++y;
      }
      const bool has_upper = begin > 0;
      const bool has_lower = y < height_;
      for (int row = begin; row < y && (has_upper || has_lower); ++row) {
        const bool from_upper = has_upper && (!has_lower || row - (begin - 1) <= y - row);
        std::copy_n(image.row(from_upper ? begin - 1 : y), values, image.row(row));
      }
      ++y;
    }
  }

  const Warper& warper_;
  const SynthesisOptions& options_;
  Execution& execution_;
  int width_;
  int height_;
  int channels_;
  WarpedPairLayout layout_;
  scheduler::ScratchPool::Lease records_memory_;
  std::span<ViewRowRecord> records_;
};

/// Sums in grey levels.
template <typename T, typename Warper>
kernels::IntensitySums grey_level_sums(ViewAssembly<T, Warper>& synthesis) {
  kernels::IntensitySums sums = synthesis.intensity_sums();
  const double unit{kGreyLevelsPerUnit<T>};
  for (int c = 0; c < 4; ++c) {
    sums.left[c] *= unit;
    sums.right[c] *= unit;
    sums.left_right[c] *= unit * unit;
    sums.left_left[c] *= unit * unit;
  }
  return sums;
}

}  // namespace vantage
