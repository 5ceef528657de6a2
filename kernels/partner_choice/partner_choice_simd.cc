#include "kernels/simd-inl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/cells/exp_log-inl.h"
#include "kernels/cells/exp_log.h"
#include "kernels/partner_choice/partner_choice.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;

struct Energies {
  HWY_INLINE Vec energy(Vec cells) const { return cells; }
  HWY_INLINE Vec cells(Vec energy, const PartnerCells& /*row*/, int /*lane*/) const {
    return energy;
  }
};

struct Likelihoods {
  HWY_INLINE Vec energy(Vec cells) const {
    return hn::Neg(
        log_of_normal(hn::Max(cells, hn::Set(Tag(), std::numeric_limits<float>::min()))));
  }
  HWY_INLINE Vec cells(Vec energy, const PartnerCells& row, int lane) const {
    const Tag d;
    const Vec likelihood = exp2_of_negative(hn::Mul(energy, hn::Set(d, -kLog2E)));
    const std::size_t candidates =
        lane < row.count ? static_cast<std::size_t>(row.count - lane) : 0;
    return hn::IfThenElseZero(hn::FirstN(d, HWY_MIN(candidates, hn::Lanes(d))), likelihood);
  }
};

// Mask of the lanes of a vector from `first` on that lie in `range`.
HWY_INLINE auto lanes_in(CandidateRange range, int first) {
  const hn::ScalableTag<std::int32_t> d32;
  const auto lane = hn::Add(hn::Iota(d32, 0), hn::Set(d32, first));
  return hn::RebindMask(Tag(), hn::And(hn::Lt(lane, hn::Set(d32, range.end)),
                                       hn::Gt(lane, hn::Set(d32, range.begin - 1))));
}

template <typename Meaning>
HWY_INLINE void choose(const PartnerCells& row, const Meaning& meaning, float* HWY_RESTRICT cells) {
  const Tag d;
  const int step = static_cast<int>(hn::Lanes(d));
  const int half = (row.partners + 1) / 2;
  const Vec infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  const Vec one = hn::Set(d, 1.0F);
  const Vec partners = hn::Set(d, static_cast<float>(row.partners));
  const Vec scale = hn::Set(d, std::sqrt(static_cast<float>(row.partners)));
  HWY_ALIGN float best[kMaxPartners / 2 * hn::MaxLanes(d)];
  for (int j = 0; j < row.columns; ++j) {
    for (int lane = 0; lane < row.lanes; lane += step) {
      const std::ptrdiff_t place = static_cast<std::ptrdiff_t>(j) * row.lanes + lane;
      for (int k = 0; k < half; ++k) {
        hn::Store(infinity, d, best + k * step);
      }
      Vec sum_all = hn::Zero(d);
      for (int p = 0; p < row.partners; ++p) {
        const Vec energy = meaning.energy(hn::LoadU(d, row.cells + p * row.partner_stride + place));
        sum_all = hn::Add(sum_all, energy);
        // Sorted into the smallest so far.
        Vec larger =
            hn::IfThenElse(lanes_in(row.seen[p * row.columns + j], lane), energy, infinity);
        for (int k = 0; k < HWY_MIN(half, p + 1); ++k) {
          const Vec other = hn::Load(d, best + k * step);
          hn::Store(hn::Min(other, larger), d, best + k * step);
          larger = hn::Max(other, larger);
        }
      }
      Vec sum = hn::Zero(d);
      Vec count = hn::Zero(d);
      for (int k = 0; k < half; ++k) {
        const Vec energy = hn::Load(d, best + k * step);
        const auto is_seen = hn::Lt(energy, infinity);
        sum = hn::Add(sum, hn::IfThenElseZero(is_seen, energy));
        count = hn::Add(count, hn::IfThenElseZero(is_seen, one));
      }
      const Vec mean = hn::IfThenElse(hn::Gt(count, hn::Zero(d)), hn::Div(sum, hn::Max(count, one)),
                                      hn::Div(sum_all, partners));
      hn::StoreU(meaning.cells(hn::Mul(mean, scale), row, lane), d, cells + place);
    }
  }
}

void choose_energies(const PartnerCells& row, float* HWY_RESTRICT cells) {
  choose(row, Energies(), cells);
}
void choose_likelihoods(const PartnerCells& row, float* HWY_RESTRICT cells) {
  choose(row, Likelihoods(), cells);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(choose_energies);
HWY_EXPORT(choose_likelihoods);

void choose_energies_row(const PartnerCells& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(choose_energies)(row, cells);
}
void choose_likelihoods_row(const PartnerCells& row, float* cells) {
  HWY_DYNAMIC_DISPATCH(choose_likelihoods)(row, cells);
}

}  // namespace vantage::kernels
#endif
