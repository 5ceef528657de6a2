#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/source_position/source_position.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <bool kTranslation, class D64>
HWY_INLINE void find_positions(D64 d64, const SourceProjection& source,
                               const SourcePositionRow& row, int first, int end,
                               const SourcePositions& positions) {
  const hn::Rebind<float, D64> d32;
  const hn::Rebind<std::int32_t, D64> di32;
  const auto unknown = hn::Set(d32, std::numeric_limits<float>::quiet_NaN());
  const auto nowhere = hn::Set(d32, -std::numeric_limits<float>::infinity());
  const auto infinity_disparity = hn::Set(d64, source.infinity_disparity_px);
  const auto parallax0 = hn::Set(d64, source.parallax[0]);
  const auto parallax1 = hn::Set(d64, source.parallax[1]);
  const auto parallax2 = hn::Set(d64, source.parallax[2]);
  const double* g = source.homography;
  const double v = row.line;
  const auto line = hn::Set(d64, v);
  const auto step0 = hn::Set(d64, g[0]);
  const auto step1 = hn::Set(d64, g[3]);
  const auto step2 = hn::Set(d64, g[6]);
  const auto start0 = hn::Set(d64, g[1] * v + g[2]);
  const auto start1 = hn::Set(d64, g[4] * v + g[5]);
  const auto start2 = hn::Set(d64, g[7] * v + g[8]);
  const auto min = hn::Set(d64, -1.0);
  const auto max_x = hn::Set(d64, row.source_width - 0.5);
  const auto max_y = hn::Set(d64, row.source_height - 0.5);
  for (int i = first; i < end; i += static_cast<int>(hn::Lanes(d64))) {
    const auto nearness = hn::LoadU(d32, row.nearness + i);
    auto known = hn::Gt(nearness, nowhere);
    const auto q = hn::PromoteTo(d64, hn::IfThenElseZero(known, nearness));
    // Not Iota(d64, i): only a constant start avoids a detour through memory.
    const auto u = hn::Add(hn::Iota(d64, 0), hn::Set(d64, i));
    auto x = u;
    auto y = line;
    auto d = hn::Add(q, infinity_disparity);
    // Mul, Add and Sub, never fused: results must not depend on the instruction set.
    if constexpr (kTranslation) {
      x = hn::Sub(u, hn::Mul(parallax0, d));
      y = hn::Sub(line, hn::Mul(parallax1, d));
    } else {
      const auto inverse_ratio = hn::Sub(hn::Add(hn::Mul(step2, u), start2), hn::Mul(parallax2, q));
      const auto is_seen = hn::Gt(inverse_ratio, hn::Set(d64, kMinDepthRatio));
      const auto one = hn::Set(d64, 1.0);
      const auto depth_ratio = hn::Div(one, hn::IfThenElse(is_seen, inverse_ratio, one));
      x = hn::Mul(hn::Sub(hn::Add(hn::Mul(step0, u), start0), hn::Mul(parallax0, q)), depth_ratio);
      y = hn::Mul(hn::Sub(hn::Add(hn::Mul(step1, u), start1), hn::Mul(parallax1, q)), depth_ratio);
      d = hn::Add(hn::Mul(q, depth_ratio), infinity_disparity);
      // 1 where visible, as floats: masks of other lane sizes do not convert.
      known = hn::And(known,
                      hn::Gt(hn::DemoteTo(d32, hn::IfThenElseZero(is_seen, one)), hn::Zero(d32)));
    }
    x = hn::Min(hn::Max(x, min), max_x);
    y = hn::Min(hn::Max(y, min), max_y);
    const auto whole_x = hn::Floor(x);
    const auto whole_y = hn::Floor(y);
    const auto known_int = hn::RebindMask(di32, known);
    hn::StoreU(hn::IfThenElseZero(known_int, hn::DemoteTo(di32, whole_x)), di32,
               positions.column + i);
    hn::StoreU(hn::IfThenElseZero(known_int, hn::DemoteTo(di32, whole_y)), di32,
               positions.line + i);
    hn::StoreU(hn::IfThenElseZero(known, hn::DemoteTo(d32, hn::Sub(x, whole_x))), d32,
               positions.fraction_x + i);
    hn::StoreU(hn::IfThenElseZero(known, hn::DemoteTo(d32, hn::Sub(y, whole_y))), d32,
               positions.fraction_y + i);
    hn::StoreU(hn::IfThenElse(known, hn::DemoteTo(d32, d), unknown), d32,
               positions.disparity_px + i);
    hn::StoreU(hn::IfThenElse(known, nearness, unknown), d32, positions.nearness + i);
  }
}

template <bool kTranslation>
HWY_INLINE void find_all(const SourceProjection& given_source, const SourcePositionRow& given_row,
                         const SourcePositions& given_positions) {
  const hn::ScalableTag<double> d64;
  const hn::CappedTag<double, 1> d64_one;
  // Local copies: stores cannot alias them.
  const SourceProjection source = given_source;
  const SourcePositionRow row = given_row;
  const SourcePositions positions = given_positions;
  const int whole_vectors = row.count - row.count % static_cast<int>(hn::Lanes(d64));
  find_positions<kTranslation>(d64, source, row, 0, whole_vectors, positions);
  find_positions<kTranslation>(d64_one, source, row, whole_vectors, row.count, positions);
}

void find_any(const SourceProjection& source, const SourcePositionRow& row,
              const SourcePositions& positions) {
  if (source.is_translation) {
    find_all<true>(source, row, positions);
  } else {
    find_all<false>(source, row, positions);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(find_any);

void source_positions_row(const SourceProjection& source, const SourcePositionRow& row,
                          const SourcePositions& positions) {
  HWY_DYNAMIC_DISPATCH(find_any)(source, row, positions);
}

}  // namespace vantage::kernels
#endif
