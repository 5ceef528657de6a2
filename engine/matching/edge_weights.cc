#include "engine/matching/edge_weights.h"

#include <algorithm>
#include <utility>

#include "engine/image/grey_levels.h"
#include "engine/matching/coarse_to_fine.h"
#include "engine/memory_use.h"

namespace vantage {
namespace {

void halve(ImageView<const float> finer, ImageView<float> coarser, Execution& execution) {
  const int last_column = finer.width() - 1;
  execution.for_each_band(coarser.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const float* upper = finer.row(2 * y);
      const float* lower = finer.row(std::min(2 * y + 1, finer.height() - 1));
      for (int x = 0; x < coarser.width(); ++x) {
        const int right = std::min(2 * x + 1, last_column);
        coarser.at(x, y) = 0.25F * ((upper[2 * x] + upper[right]) + (lower[2 * x] + lower[right]));
      }
    }
  });
}

}  // namespace

void EdgeWeights::prepare(ImageView<const float> grey, const kernels::EdgeModel& model,
                          Execution& execution) {
  const int width = grey.width();
  const int height = grey.height();
  beside_.resize(width + 1, height);
  above_.resize(width, height + 1);
  std::fill_n(above_.row(0), width, 1.0F);
  std::fill_n(above_.row(height), width, 1.0F);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const float* pixels = grey.row(y);
      float* beside = beside_.row(y);
      beside[0] = beside[width] = 1;
      kernels::edge_weights_row(pixels, pixels + 1, width - 1, model, beside + 1);
      if (y > 0) {
        kernels::edge_weights_row(grey.row(y - 1), pixels, width, model, above_.row(y));
      }
    }
  });
}

std::size_t EdgeWeights::held_bytes() const {
  return vantage::held_bytes(beside_) + vantage::held_bytes(above_);
}

bool uses_edge_weights(const MethodParameters& parameters) {
  return parameters.aggregation == Aggregation::kBayes && parameters.edge_weight < 1;
}

std::span<const EdgeWeights> EdgeWeightLevels::prepare(const Photograph& reference,
                                                       const MethodParameters& parameters,
                                                       Execution& execution) {
  if (!uses_edge_weights(parameters)) {
    return {};
  }
  const auto extents = level_extents({reference.width(), reference.height()}, parameters.levels);
  const kernels::EdgeModel model{.least = static_cast<float>(parameters.edge_weight),
                                 .contrast = static_cast<float>(parameters.edge_contrast)};
  grey_.resize(extents.size());
  levels_.resize(extents.size());
  for (std::size_t level = 0; level < extents.size(); ++level) {
    Image<float>& grey = grey_[level];
    grey.resize(extents[level].columns, extents[level].rows);
    if (level == 0) {
      execution.for_each_band(grey.height(), [&](int first_row, int end_row) {
        for (int y = first_row; y < end_row; ++y) {
          grey_levels_row(reference, y, grey.row(y));
        }
      });
    } else {
      halve(std::as_const(grey_[level - 1]).view(), grey.view(), execution);
    }
    levels_[level].prepare(grey.view(), model, execution);
  }
  return levels_;
}

std::size_t EdgeWeightLevels::held_bytes() const {
  std::size_t bytes = 0;
  for (const Image<float>& grey : grey_) {
    bytes += vantage::held_bytes(grey);
  }
  for (const EdgeWeights& level : levels_) {
    bytes += level.held_bytes();
  }
  return bytes;
}

std::size_t edge_weight_bytes(const MethodParameters& parameters, std::size_t pixels) {
  // Two weights and a grey level a pixel, of all levels.
  constexpr std::size_t kPlanes = 3;
  return uses_edge_weights(parameters) ? kPlanes * sizeof(float) * (pixels + pixels / 3) : 0;
}

}  // namespace vantage
