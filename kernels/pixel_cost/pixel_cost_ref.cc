#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/pixel_cost/pixel_cost.h"

namespace vantage::kernels {
namespace {

/// Mean over channels of compare(reference, partner); both map a plane number to a value.
template <int kPlanes, typename Compare>
float mean_cost(const FeaturePairs<float, kPlanes>& row, int j, int i, const Compare& compare) {
  float sum = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& channel = row.channel[static_cast<std::size_t>(c)];
    sum += compare(
        [&](std::size_t plane) { return channel.reference[plane][j]; },
        [&](std::size_t plane) { return channel.partner[plane][j * row.partner_step + i]; });
  }
  return row.channels > 1 ? sum * (1.0F / 3.0F) : sum;
}

template <int kPlanes, typename Compare>
void for_each_cell(const FeaturePairs<float, kPlanes>& row, float* cells, const Compare& compare) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      cells[j * row.lanes + i] = mean_cost(row, j, i, compare);
    }
  }
}

float square(float value) { return value * value; }

float measurement(ContaminatedGaussian model, float squared_residual) {
  return (1.0F - model.epsilon) * exp2_of_negative(model.exponent_scale * squared_residual) +
         model.epsilon;
}

constexpr auto kSquaredDifference = [](const auto& reference, const auto& partner) {
  return square(reference(0) - partner(0));
};

/// Distance of `value` from [low, high]; 0 inside.
float distance(float value, float low, float high) {
  return std::max(std::max(value - high, low - value), 0.0F);
}

}  // namespace

void squared_row_ref(const GreyPairs& row, float* cells) {
  for_each_cell(row, cells, kSquaredDifference);
}

void absolute_row_ref(const GreyPairs& row, float truncation, float* cells) {
  for_each_cell(row, cells, [&](const auto& reference, const auto& partner) {
    return std::min(std::abs(reference(0) - partner(0)), truncation);
  });
}

void sampling_insensitive_row_ref(const SampledPairs& row, float* cells) {
  for_each_cell(row, cells, [](const auto& reference, const auto& partner) {
    return std::min(distance(reference(0), partner(1), partner(2)),
                    distance(partner(0), reference(1), reference(2)));
  });
}

void contaminated_energy_row_ref(const GreyPairs& row, ContaminatedGaussian model, float* cells) {
  for_each_cell(row, cells, [&](const auto& reference, const auto& partner) {
    return 0.0F - log_of_normal(measurement(model, kSquaredDifference(reference, partner)));
  });
}

void contaminated_likelihood_row_ref(const GreyPairs& row, ContaminatedGaussian model,
                                     float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      cells[j * row.lanes + i] =
          i < row.count ? measurement(model, mean_cost(row, j, i, kSquaredDifference)) : 0.0F;
    }
  }
}

void likelihood_of_costs_ref(const CellExtent& row, ContaminatedGaussian model, float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      float& cell = cells[j * row.lanes + i];
      cell = i < row.count ? measurement(model, square(cell)) : 0.0F;
    }
  }
}

void likelihood_of_energies_ref(const CellExtent& row, float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      float& cell = cells[j * row.lanes + i];
      cell = i < row.count ? exp2_of_negative(cell * -kLog2E) : 0.0F;
    }
  }
}

void sampling_bounds_row_ref(const float* grey, int width, float* min, float* max) {
  for (int x = 0; x < width; ++x) {
    const float before = 0.5F * (grey[x] + grey[x - 1]);
    const float after = 0.5F * (grey[x] + grey[x + 1]);
    min[x] = std::min({before, after, grey[x]});
    max[x] = std::max({before, after, grey[x]});
  }
}

}  // namespace vantage::kernels
