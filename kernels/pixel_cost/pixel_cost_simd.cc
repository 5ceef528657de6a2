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

}  // namespace vantage::kernels
#endif
