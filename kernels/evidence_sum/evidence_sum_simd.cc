#include "kernels/simd-inl.h"

#include <algorithm>

#include "kernels/evidence/gradient_norm-inl.h"
#include "kernels/evidence_sum/evidence_sum.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;

template <typename Norm>
HWY_INLINE Vec evidence(const GradientBlock& reference, const GradientBlock& partner, int j) {
  const Tag d;
  const Vec dx = hn::Sub(hn::LoadU(d, reference.x + j), hn::LoadU(d, partner.x + j));
  const Vec dy = hn::Sub(hn::LoadU(d, reference.y + j), hn::LoadU(d, partner.y + j));
  const Vec norms =
      hn::Add(hn::LoadU(d, reference.half_norm + j), hn::LoadU(d, partner.half_norm + j));
  return hn::Sub(norms, Norm()(dx, dy));
}

HWY_INLINE void next_row(GradientBlock& block) {
  block.x += block.row_stride;
  block.y += block.row_stride;
  block.half_norm += block.row_stride;
}

template <typename Norm>
double sum_of(const EvidenceBlock& block) {
  const Tag d;
  constexpr int kStep = static_cast<int>(hn::MaxLanes(Tag()));
  constexpr int kVectors = kLaneMultiple / kStep;
  GradientBlock reference = block.reference;
  GradientBlock partner = block.partner;
  const int whole = block.columns / kLaneMultiple * kLaneMultiple;
  const int rest = block.columns - whole;
  Vec sums[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    sums[v] = hn::Zero(d);
  }
  for (int row = 0; row < block.rows; ++row) {
    for (int j = 0; j < whole; j += kLaneMultiple) {
#pragma GCC unroll 4
      for (int v = 0; v < kVectors; ++v) {
        sums[v] = hn::Add(sums[v], evidence<Norm>(reference, partner, j + v * kStep));
      }
    }
    for (int v = 0; v * kStep < rest; ++v) {
      const auto counted = hn::FirstN(d, static_cast<std::size_t>(rest - v * kStep));
      sums[v] = hn::Add(sums[v], hn::IfThenElseZero(counted, evidence<Norm>(reference, partner,
                                                                            whole + v * kStep)));
    }
    next_row(reference);
    next_row(partner);
  }
  float lanes[kLaneMultiple];
  for (int v = 0; v < kVectors; ++v) {
    hn::StoreU(sums[v], d, lanes + v * kStep);
  }
  return pairwise_sum(lanes);
}

double evidence_sum_simd(const EvidenceBlock& block) {
  return with_norm(block.norm, [&](auto norm) { return sum_of<decltype(norm)>(block); });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(evidence_sum_simd);

double evidence_sum(const EvidenceBlock& block) {
  return HWY_DYNAMIC_DISPATCH(evidence_sum_simd)(block);
}

double pairwise_sum(const float* lanes) {
  double sums[kLaneMultiple];
  std::copy_n(lanes, kLaneMultiple, sums);
  for (int half = kLaneMultiple / 2; half > 0; half /= 2) {
    for (int lane = 0; lane < half; ++lane) {
      sums[lane] += sums[lane + half];
    }
  }
  return sums[0];
}

}  // namespace vantage::kernels
#endif
