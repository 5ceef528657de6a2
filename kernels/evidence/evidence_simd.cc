#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/exp_log.h"
#include "kernels/evidence/evidence.h"
#include "kernels/evidence/gradient_norm-inl.h"
#include "kernels/feature_pairs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;
using Gradient = Features<float, 3>;

template <typename Norm>
HWY_INLINE void evidence_planes_of(const GradientRowPlanes& row, float alpha) {
  const Tag d;
  for (int k = 0; k < row.width; k += static_cast<int>(hn::Lanes(d))) {
    const Vec x = hn::LoadU(d, row.x + k);
    const Vec y = hn::LoadU(d, row.y + k);
    hn::StoreU(hn::Mul(hn::Set(d, 0.5F), Norm()(x, y)), d, row.half_norm + k);
    hn::StoreU(hn::Mul(x, hn::Set(d, alpha)), d, row.x + k);
    hn::StoreU(hn::Mul(y, hn::Set(d, alpha)), d, row.y + k);
  }
}

void evidence_planes(const GradientRowPlanes& row, float alpha, EvidenceNorm norm) {
  with_norm(norm, [&](auto of_norm) { evidence_planes_of<decltype(of_norm)>(row, alpha); });
}

template <typename Norm>
struct NegatedEvidence {
  HWY_INLINE Vec operator()(const Gradient& reference, const Gradient& partner) const {
    const Vec difference =
        Norm()(hn::Sub(reference[0], partner[0]), hn::Sub(reference[1], partner[1]));
    return hn::Sub(difference, hn::Add(reference[2], partner[2]));
  }
  HWY_INLINE Vec finish(Vec cost) const { return cost; }
};

void negated_evidence(const GradientPairs& row, EvidenceNorm norm, float* cells) {
  with_norm(norm, [&](auto of_norm) {
    compare_row<false>(row, NegatedEvidence<decltype(of_norm)>(), cells);
  });
}

/// Mask of the lanes of a vector starting at `first` that lie in `range`.
HWY_INLINE auto lanes_in(CandidateRange range, int first) {
  const hn::ScalableTag<std::int32_t> d32;
  const auto lane = hn::Add(hn::Iota(d32, 0), hn::Set(d32, first));
  return hn::RebindMask(Tag(), hn::And(hn::Lt(lane, hn::Set(d32, range.end)),
                                       hn::Gt(lane, hn::Set(d32, range.begin - 1))));
}

void evidence_to_likelihood(const EvidenceRow& row, float sigma, float epsilon, float* cells) {
  const Tag d;
  const int step = static_cast<int>(hn::Lanes(d));
  const int lanes = row.geometry.lanes();
  const int count = row.geometry.count;
  const Vec exponent_scale = hn::Set(d, kLog2E / sigma);
  const Vec min_likelihood = hn::Set(d, epsilon);
  const Vec rest = hn::Set(d, 1.0F - epsilon);
  const Vec infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  for (int j = 0; j < row.columns; ++j, cells += lanes) {
    const CandidateRange inside = row.geometry.with_partner(row.first_column + j);
    Vec minima = infinity;
    for (int lane = 0; lane < lanes; lane += step) {
      const Vec cell = hn::LoadU(d, cells + lane);
      minima = hn::Min(minima, hn::IfThenElse(lanes_in(inside, lane), cell, infinity));
    }
    const Vec min = hn::MinOfLanes(d, minima);
    for (int lane = 0; lane < lanes; lane += step) {
      const Vec exponent = hn::Mul(hn::Sub(min, hn::LoadU(d, cells + lane)), exponent_scale);
      const Vec likelihood = hn::Add(hn::Mul(rest, exp2_of_negative(exponent)), min_likelihood);
      const Vec candidate = hn::IfThenElse(lanes_in(inside, lane), likelihood, min_likelihood);
      hn::StoreU(hn::IfThenElseZero(lanes_in({0, count}, lane), candidate), d, cells + lane);
    }
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(evidence_planes);
HWY_EXPORT(negated_evidence);
HWY_EXPORT(evidence_to_likelihood);

void evidence_planes_row(const GradientRowPlanes& row, float alpha, EvidenceNorm norm) {
  HWY_DYNAMIC_DISPATCH(evidence_planes)(row, alpha, norm);
}
void negated_evidence_row(const GradientPairs& row, EvidenceNorm norm, float* cells) {
  HWY_DYNAMIC_DISPATCH(negated_evidence)(row, norm, cells);
}
void likelihood_of_evidence(const EvidenceRow& row, float sigma, float epsilon, float* cells) {
  HWY_DYNAMIC_DISPATCH(evidence_to_likelihood)(row, sigma, epsilon, cells);
}

}  // namespace vantage::kernels
#endif
