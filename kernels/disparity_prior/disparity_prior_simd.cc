#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>

#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/exp_log.h"
#include "kernels/cells/lane_sums-inl.h"
#include "kernels/disparity_prior/disparity_prior.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// min(k²/4, 1) for the candidates of a vector of lanes.
class ShareOfDepth {
 public:
  HWY_INLINE ShareOfDepth(const DisparityPriorRow& row, int column)
      : offset_(hn::Set(FloatTag(), row.candidate(column))),
        inverse_reach_(hn::Set(FloatTag(), row.inverse_reach())) {}
  HWY_INLINE FloatVec operator()(int lane) const {
    const FloatTag d;
    const FloatVec i = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<float>(lane)));
    const FloatVec k = hn::Mul(hn::Sub(i, offset_), inverse_reach_);
    return hn::Min(hn::Mul(k, k), hn::Set(d, 1.0F));
  }

 private:
  FloatVec offset_;
  FloatVec inverse_reach_;
};

HWY_INLINE float mean_above_min(const float* cells, int count) {
  const FloatTag d;
  LaneBlock16 sums;
  LaneBlock16 min;
  sums.fill(hn::Zero(d));
  min.fill(hn::Set(d, cells[0]));
  const int whole = count / kLaneMultiple * kLaneMultiple;
  for (int lane = 0; lane < whole; lane += kLaneMultiple) {
    for (int p = 0; p < kParts; ++p) {
      const FloatVec v = hn::LoadU(d, cells + lane + p * kFloatLanes);
      sums.part[p] = hn::Add(sums.part[p], v);
      min.part[p] = hn::Min(min.part[p], v);
    }
  }
  if (whole < count) {
    for (int p = 0; p < kParts; ++p) {
      const int lane = whole + p * kFloatLanes;
      const auto counts = hn::FirstN(d, static_cast<std::size_t>(std::max(count - lane, 0)));
      const FloatVec v = hn::LoadU(d, cells + lane);
      sums.part[p] = hn::Add(sums.part[p], hn::IfThenElseZero(counts, v));
      min.part[p] = hn::Min(min.part[p], hn::IfThenElse(counts, v, min.part[p]));
    }
  }
  const float mean = hn::GetLane(sum_lanes(sums)) / static_cast<float>(count);
  return std::max(mean - hn::GetLane(min_lanes(min)), 0.0F);
}

void energies_with_prior(const DisparityPriorRow& row, float* HWY_RESTRICT cells) {
  const FloatTag d;
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    if (!row.has_prior(j)) {
      continue;
    }
    const float contrast = std::min(mean_above_min(cells, row.count), row.max_contrast);
    const FloatVec scale = hn::Set(d, row.weight * contrast);
    const ShareOfDepth share(row, j);
    for (int lane = 0; lane < row.lanes; lane += kFloatLanes) {
      const FloatVec v = hn::LoadU(d, cells + lane);
      hn::StoreU(hn::Add(v, hn::Mul(scale, share(lane))), d, cells + lane);
    }
  }
}

void likelihoods_with_prior(const DisparityPriorRow& row, float* HWY_RESTRICT cells) {
  const FloatTag d;
  const FloatVec exponent_scale = hn::Set(d, prior_exponent_scale(row.weight));
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    if (!row.has_prior(j)) {
      continue;
    }
    const ShareOfDepth share(row, j);
    for (int lane = 0; lane < row.lanes; lane += kFloatLanes) {
      const FloatVec factor =
          exp2_of_negative(hn::Mul(exponent_scale, share(row.first_candidate + lane)));
      hn::StoreU(hn::Mul(hn::LoadU(d, cells + lane), factor), d, cells + lane);
    }
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(energies_with_prior);
HWY_EXPORT(likelihoods_with_prior);

void energies_with_prior_row(const DisparityPriorRow& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(energies_with_prior)(row, cells);
}
void likelihoods_with_prior_row(const DisparityPriorRow& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(likelihoods_with_prior)(row, cells);
}

}  // namespace vantage::kernels
#endif
