#include "engine/matching/aggregation/edge_weights.h"

#include <algorithm>
#include <utility>

#include "engine/image/intensity_rows.h"
#include "engine/image/memory_use.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_extents.h"
#include "kernels/candidate_windows.h"
#include "kernels/edge_weights/edge_weights.h"
#include "kernels/intensity_diffusion/intensity_diffusion.h"

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

/// One step of anisotropic diffusion (IntensityDiffusionRow).
void diffuse(ImageView<const float> grey, double contrast, Execution& execution,
             Image<float>& diffused) {
  const int width = grey.width();
  const int height = grey.height();
  diffused.resize(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    const auto work = execution.scratch().lease(
        sizeof(float) * static_cast<std::size_t>(kernels::intensity_diffusion_work_floats(width)));
    for (int y = first_row; y < end_row; ++y) {
      kernels::IntensityDiffusionRow row;
      row.up = y > 0 ? grey.row(y - 1) : nullptr;
      row.centre = grey.row(y);
      row.down = y + 1 < height ? grey.row(y + 1) : nullptr;
      row.width = width;
      row.contrast = static_cast<float>(contrast);
      row.work = reinterpret_cast<float*>(work.data());
      row.output = diffused.row(y);
      kernels::intensity_diffusion_row(row);
    }
  });
}

/// Sets of weights of a level.
std::size_t weight_sets(const MethodParameters& parameters) {
  return static_cast<std::size_t>(
      std::max(std::min(parameters.edge_diffusion, parameters.iterations), 1));
}

}  // namespace

template <typename Weight, typename Store>
void EdgeWeightPlanes::make(ImageView<const float> grey, const MethodParameters& parameters,
                            Execution& execution, const Store& store, Planes<Weight>& planes) {
  const kernels::EdgeModel model{.min = static_cast<float>(parameters.edge_weight),
                                 .contrast = static_cast<float>(parameters.edge_contrast)};
  const int width = grey.width();
  const int height = grey.height();
  // Kernels of windows read whole vectors.
  planes.beside.resize(width + 1 + kernels::kWindowMargin, height);
  planes.above.resize(width + kernels::kWindowMargin, height + 1);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    const auto work =
        execution.scratch().lease(sizeof(float) * (static_cast<std::size_t>(width) + 1));
    auto* const weights = reinterpret_cast<float*>(work.data());
    for (int y = first_row; y < end_row; ++y) {
      const float* pixels = grey.row(y);
      weights[0] = weights[width] = 1;
      kernels::edge_weights_row(pixels, pixels + 1, width - 1, model, weights + 1);
      store(weights, width + 1, planes.beside.row(y));
      if (y > 0) {
        kernels::edge_weights_row(grey.row(y - 1), pixels, width, model, weights);
        store(weights, width, planes.above.row(y));
      }
    }
    std::fill_n(weights, width, 1.0F);
    if (first_row == 0) {
      store(weights, width, planes.above.row(0));
    }
    if (end_row == height) {
      store(weights, width, planes.above.row(height));
    }
  });
}

void EdgeWeightPlanes::prepare(ImageView<const float> grey, const MethodParameters& parameters,
                               Execution& execution) {
  if (uses_fixed_energies(parameters)) {
    const auto mu = static_cast<float>(parameters.mu);
    make(
        grey, parameters, execution,
        [mu](const float* weights, int count, kernels::FixedWeight* row) {
          kernels::fixed_weights_row(weights, count, mu, row);
        },
        fixed_);
    return;
  }
  make(
      grey, parameters, execution,
      [](const float* weights, int count, float* row) { std::copy_n(weights, count, row); },
      floats_);
}

std::size_t EdgeWeightPlanes::held_bytes() const {
  return vantage::held_bytes(floats_.beside) + vantage::held_bytes(floats_.above) +
         vantage::held_bytes(fixed_.beside) + vantage::held_bytes(fixed_.above);
}

void EdgeWeights::prepare(ImageView<const float> grey, const MethodParameters& parameters,
                          Execution& execution) {
  planes_.resize(weight_sets(parameters));
  if (parameters.edge_diffusion == 0) {
    planes_.front().prepare(grey, parameters, execution);
    return;
  }
  for (std::size_t n = 0; n < planes_.size(); ++n) {
    const Image<float>& before = diffused_[(n + 1) % 2];
    Image<float>& after = diffused_[n % 2];
    diffuse(n == 0 ? grey : before.view(), parameters.edge_contrast, execution, after);
    planes_[n].prepare(std::as_const(after).view(), parameters, execution);
  }
}

std::size_t EdgeWeights::held_bytes() const {
  std::size_t bytes = vantage::held_bytes(diffused_[0]) + vantage::held_bytes(diffused_[1]);
  for (const EdgeWeightPlanes& planes : planes_) {
    bytes += planes.held_bytes();
  }
  return bytes;
}

std::span<const EdgeWeights> EdgeWeightLevels::prepare(const Photograph& reference,
                                                       const MethodParameters& parameters,
                                                       Execution& execution) {
  if (!uses_edge_weights(parameters)) {
    return {};
  }
  const auto extents = level_extents({reference.width(), reference.height()}, parameters.levels);
  grey_.resize(extents.size());
  levels_.resize(extents.size());
  for (std::size_t level = 0; level < extents.size(); ++level) {
    Image<float>& grey = grey_[level];
    grey.resize(extents[level].columns, extents[level].rows);
    if (level == 0) {
      execution.for_each_band(grey.height(), [&](int first_row, int end_row) {
        for (int y = first_row; y < end_row; ++y) {
          intensity_row(reference, y, grey.row(y));
        }
      });
    } else {
      halve(std::as_const(grey_[level - 1]).view(), grey.view(), execution);
    }
    const MethodParameters of_level = at_level(parameters, static_cast<int>(level));
    if (of_level.iterations > 0) {
      levels_[level].prepare(std::as_const(grey).view(), of_level, execution);
    }
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
  if (!uses_edge_weights(parameters)) {
    return 0;
  }
  // Per pixel: one grey level, two diffused ones, and two weights per set.
  const std::size_t weight =
      uses_fixed_energies(parameters) ? sizeof(kernels::FixedWeight) : sizeof(float);
  const std::size_t levels = parameters.edge_diffusion > 0 ? 3 : 1;
  const auto bytes_of_level = [&](int level) {
    return 2 * weight * weight_sets(at_level(parameters, level)) + levels * sizeof(float);
  };
  return bytes_of_level(0) * pixels +
         (parameters.levels > 1 ? bytes_of_level(1) * (pixels / 3) : 0);
}

}  // namespace vantage
