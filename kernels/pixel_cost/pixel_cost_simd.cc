#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/cells/exp_log-inl.h"
#include "kernels/feature_pairs-inl.h"
#include "kernels/pixel_cost/pixel_cost.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;
using Grey = Features<float, 1>;
using Sampled = Features<float, 3>;

HWY_INLINE Vec squared_difference(const Grey& reference, const Grey& partner) {
  const Vec difference = hn::Sub(reference[0], partner[0]);
  return hn::Mul(difference, difference);
}

struct Squared {
  HWY_INLINE Vec operator()(const Grey& reference, const Grey& partner) const {
    return squared_difference(reference, partner);
  }
  HWY_INLINE Vec finish(Vec cost) const { return cost; }
};

struct Absolute {
  Vec truncation;
  HWY_INLINE Vec operator()(const Grey& reference, const Grey& partner) const {
    return hn::Min(hn::Abs(hn::Sub(reference[0], partner[0])), truncation);
  }
  HWY_INLINE Vec finish(Vec cost) const { return cost; }
};

struct SamplingInsensitive {
  HWY_INLINE Vec operator()(const Sampled& reference, const Sampled& partner) const {
    return hn::Min(distance(reference[0], partner[1], partner[2]),
                   distance(partner[0], reference[1], reference[2]));
  }
  HWY_INLINE Vec finish(Vec cost) const { return cost; }

 private:
  static HWY_INLINE Vec distance(Vec value, Vec low, Vec high) {
    return hn::Max(hn::Max(hn::Sub(value, high), hn::Sub(low, value)), hn::Zero(Tag()));
  }
};

/// The measurement model with its constants in registers.
struct Measurement {
  Vec exponent_scale;
  Vec epsilon;
  Vec rest;
  explicit HWY_INLINE Measurement(ContaminatedGaussian model)
      : exponent_scale(hn::Set(Tag(), model.exponent_scale)),
        epsilon(hn::Set(Tag(), model.epsilon)),
        rest(hn::Set(Tag(), 1.0F - model.epsilon)) {}
  HWY_INLINE Vec operator()(Vec squared_residual) const {
    return hn::Add(hn::Mul(rest, exp2_of_negative(hn::Mul(exponent_scale, squared_residual))),
                   epsilon);
  }
};

struct ContaminatedEnergy {
  Measurement measurement;
  HWY_INLINE Vec operator()(const Grey& reference, const Grey& partner) const {
    return hn::Sub(hn::Zero(Tag()),
                   log_of_normal(measurement(squared_difference(reference, partner))));
  }
  HWY_INLINE Vec finish(Vec energy) const { return energy; }
};

struct ContaminatedLikelihood {
  Measurement measurement;
  HWY_INLINE Vec operator()(const Grey& reference, const Grey& partner) const {
    return squared_difference(reference, partner);
  }
  HWY_INLINE Vec finish(Vec squared_residual) const { return measurement(squared_residual); }
};

void squared(const GreyPairs& row, float* cells) { compare_row<false>(row, Squared(), cells); }

void absolute(const GreyPairs& row, float truncation, float* cells) {
  compare_row<false>(row, Absolute{hn::Set(Tag(), truncation)}, cells);
}

void sampling_insensitive(const SampledPairs& row, float* cells) {
  compare_row<false>(row, SamplingInsensitive(), cells);
}

void contaminated_energy(const GreyPairs& row, ContaminatedGaussian model, float* cells) {
  compare_row<false>(row, ContaminatedEnergy{Measurement(model)}, cells);
}

void contaminated_likelihood(const GreyPairs& row, ContaminatedGaussian model, float* cells) {
  compare_row<true>(row, ContaminatedLikelihood{Measurement(model)}, cells);
}

// likelihood(value) for the candidates of each column, 0 in the other lanes.
template <class Likelihood>
HWY_INLINE void each_candidate_cell(const CellExtent& row, Likelihood likelihood, float* cells) {
  const Tag d;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    int lane = 0;
    for (; lane < row.count; lane += step) {
      const Vec value = likelihood(hn::LoadU(d, cells + lane));
      const auto is_candidate = hn::FirstN(d, static_cast<std::size_t>(row.count - lane));
      hn::StoreU(hn::IfThenElseZero(is_candidate, value), d, cells + lane);
    }
    for (; lane < row.lanes; lane += step) {
      hn::StoreU(hn::Zero(d), d, cells + lane);
    }
  }
}

void costs_to_likelihood(const CellExtent& row, ContaminatedGaussian model, float* cells) {
  const Measurement measurement(model);
  each_candidate_cell(
      row, [&](Vec cost) HWY_ATTR { return measurement(hn::Mul(cost, cost)); }, cells);
}

void energies_to_likelihood(const CellExtent& row, float* cells) {
  const Vec factor = hn::Set(Tag(), -kLog2E);
  each_candidate_cell(
      row, [&](Vec energy) HWY_ATTR { return exp2_of_negative(hn::Mul(energy, factor)); }, cells);
}

void sampling_bounds(const float* grey, int width, float* min, float* max) {
  const Tag d;
  const Vec half = hn::Set(d, 0.5F);
  for (int x = 0; x < width; x += static_cast<int>(hn::Lanes(d))) {
    const Vec at = hn::LoadU(d, grey + x);
    const Vec before = hn::Mul(half, hn::Add(at, hn::LoadU(d, grey + x - 1)));
    const Vec after = hn::Mul(half, hn::Add(at, hn::LoadU(d, grey + x + 1)));
    hn::StoreU(hn::Min(hn::Min(before, after), at), d, min + x);
    hn::StoreU(hn::Max(hn::Max(before, after), at), d, max + x);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(squared);
HWY_EXPORT(absolute);
HWY_EXPORT(sampling_insensitive);
HWY_EXPORT(contaminated_energy);
HWY_EXPORT(contaminated_likelihood);
HWY_EXPORT(costs_to_likelihood);
HWY_EXPORT(energies_to_likelihood);
HWY_EXPORT(sampling_bounds);

void squared_row(const GreyPairs& row, float* cells) { HWY_DYNAMIC_DISPATCH(squared)(row, cells); }
void absolute_row(const GreyPairs& row, float truncation, float* cells) {
  HWY_DYNAMIC_DISPATCH(absolute)(row, truncation, cells);
}
void sampling_insensitive_row(const SampledPairs& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(sampling_insensitive)(row, cells);
}
void contaminated_energy_row(const GreyPairs& row, ContaminatedGaussian model, float* cells) {
  HWY_DYNAMIC_DISPATCH(contaminated_energy)(row, model, cells);
}
void contaminated_likelihood_row(const GreyPairs& row, ContaminatedGaussian model, float* cells) {
  HWY_DYNAMIC_DISPATCH(contaminated_likelihood)(row, model, cells);
}
void likelihood_of_costs(const CellExtent& row, ContaminatedGaussian model, float* cells) {
  HWY_DYNAMIC_DISPATCH(costs_to_likelihood)(row, model, cells);
}
void likelihood_of_energies(const CellExtent& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(energies_to_likelihood)(row, cells);
}
void sampling_bounds_row(const float* grey, int width, float* min, float* max) {
  HWY_DYNAMIC_DISPATCH(sampling_bounds)(grey, width, min, max);
}

// Scalar reference.

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
#endif
