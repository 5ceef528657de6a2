#include "kernels/simd-inl.h"

#include <algorithm>
#include <limits>

#include "kernels/surface_splat/quad_gaps.h"
#include "kernels/surface_splat/surface_splat.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Columns that are processed together; a multiple of every vector length.
constexpr int kBlock = 64;
static_assert(kBlock <= kSplatPadding);

// At most 16 lanes, the number of mask bits stored here.
using Tag = hn::CappedTag<float, 16>;
using TagInt = hn::RebindToSigned<Tag>;
using Vec = hn::VFromD<Tag>;
using VecInt = hn::VFromD<TagInt>;

// Writes the upper row's pixels from column `begin` into the band. Pixels outside the band or after
// the row's end write −inf to the first position, which has no effect.
HWY_INLINE void splat_pixels(const SplatRows& rows, const SplatBand& band, int begin) {
  const Tag d;
  const TagInt di;
  const int count = std::min(kBlock, rows.count - begin);
  const auto before = hn::Set(di, -1);
  const auto width = hn::Set(di, band.width);
  const auto lines = hn::Set(di, band.lines);
  const auto first_line = hn::Set(di, band.first_line);
  const auto stride = hn::Set(di, static_cast<std::int32_t>(band.stride));
  const auto nowhere = hn::Set(d, -std::numeric_limits<float>::infinity());
  HWY_ALIGN std::int32_t place[kBlock];
  HWY_ALIGN float nearness[kBlock];
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const auto column = hn::LoadU(di, rows.upper.column + begin + i);
    const auto line = hn::Sub(hn::LoadU(di, rows.upper.line + begin + i), first_line);
    const auto inside = hn::And(hn::And(hn::Gt(column, before), hn::Lt(column, width)),
                                hn::And(hn::Gt(line, before), hn::Lt(line, lines)));
    hn::Store(hn::IfThenElseZero(inside, hn::Add(hn::Mul(line, stride), column)), di, place + i);
    hn::Store(hn::IfThenElse(hn::RebindMask(d, inside),
                             hn::LoadU(d, rows.upper.nearness + begin + i), nowhere),
              d, nearness + i);
  }
  float* HWY_RESTRICT lines_of_band = band.nearness;
#pragma GCC unroll 4
  for (int i = 0; i < count; ++i) {
    float& nearest = lines_of_band[place[i]];
    nearest = std::max(nearest, nearness[i]);
  }
}

// One value of the four corners of a quad, per lane.
struct Corners {
  VecInt a, b, c, d;
};

HWY_INLINE Corners load_corners(const std::int32_t* upper, const std::int32_t* lower) {
  const TagInt di;
  return {hn::LoadU(di, upper), hn::LoadU(di, upper + 1), hn::LoadU(di, lower),
          hn::LoadU(di, lower + 1)};
}

HWY_INLINE VecInt min(const Corners& at) {
  return hn::Min(hn::Min(at.a, at.b), hn::Min(at.c, at.d));
}

HWY_INLINE VecInt max(const Corners& at) {
  return hn::Max(hn::Max(at.a, at.b), hn::Max(at.c, at.d));
}

HWY_INLINE VecInt extent(const Corners& at) { return hn::Sub(max(at), min(at)); }

// True where the span of the corners overlaps [first, end).
HWY_INLINE auto reaches(const Corners& at, int first, int end) {
  const TagInt di;
  return hn::And(hn::Gt(max(at), hn::Set(di, first - 1)), hn::Lt(min(at), hn::Set(di, end)));
}

// Bit i: there may be gaps inside the band between the pixels of the quad of upper columns begin +
// i and begin + i + 1, because two corners of an edge or triangle on one surface land more than one
// column or line apart.
HWY_INLINE std::uint64_t find_gaps(const SplatRows& rows, const SplatBand& band, int begin) {
  const Tag d;
  const TagInt di;
  const auto one = hn::Set(di, 1);
  const auto limit = hn::Set(d, rows.gradient_limit_px);
  std::uint64_t gaps = 0;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const int at = begin + i;
    const Corners column = load_corners(rows.upper.column + at, rows.lower.column + at);
    const Corners line = load_corners(rows.upper.line + at, rows.lower.line + at);
    if (hn::AllFalse(di, hn::Gt(hn::Max(extent(column), extent(line)), one))) {
      continue;
    }
    const auto upper_a = hn::LoadU(d, rows.upper.disparity_px + at);
    const auto upper_b = hn::LoadU(d, rows.upper.disparity_px + at + 1);
    const auto lower_c = hn::LoadU(d, rows.lower.disparity_px + at);
    const auto lower_d = hn::LoadU(d, rows.lower.disparity_px + at + 1);
    const auto joined = [&](Vec p, Vec q)
                            HWY_ATTR { return hn::Le(hn::Abs(hn::Sub(p, q)), limit); };
    const auto apart = [&](VecInt p, VecInt q, VecInt r, VecInt s) HWY_ATTR {
      return hn::RebindMask(d,
                            hn::Gt(hn::Max(hn::Abs(hn::Sub(p, q)), hn::Abs(hn::Sub(r, s))), one));
    };
    const auto ab = joined(upper_a, upper_b);
    const auto ac = joined(upper_a, lower_c);
    const auto bd = joined(upper_b, lower_d);
    const auto cd = joined(lower_c, lower_d);
    const auto edges = hn::Or(hn::Or(hn::And(ab, apart(column.a, column.b, line.a, line.b)),
                                     hn::And(ac, apart(column.a, column.c, line.a, line.c))),
                              hn::Or(hn::And(bd, apart(column.b, column.d, line.b, line.d)),
                                     hn::And(cd, apart(column.c, column.d, line.c, line.d))));
    const auto diagonals = hn::Or(hn::And(hn::Or(hn::And(ab, ac), hn::And(bd, cd)),
                                          apart(column.b, column.c, line.b, line.c)),
                                  hn::And(hn::Or(hn::And(ab, bd), hn::And(ac, cd)),
                                          apart(column.a, column.d, line.a, line.d)));
    std::uint8_t bits[8] = {};
    const auto inside = hn::And(reaches(column, 0, band.width),
                                reaches(line, band.first_line, band.first_line + band.lines));
    hn::StoreMaskBits(d, hn::And(hn::Or(edges, diagonals), hn::RebindMask(d, inside)), bits);
    gaps |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << i;
  }
  const int count = rows.count - begin;
  return count < kBlock ? gaps & ((std::uint64_t{1} << count) - 1) : gaps;
}

// Bit i: the quad of upper columns begin + i and begin + i + 1 has known corners, but is not a
// single surface.
HWY_INLINE std::uint64_t find_torn(const SplatRows& rows, int begin) {
  const Tag d;
  const auto limit = hn::Set(d, rows.gradient_limit_px);
  std::uint64_t torn = 0;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const int at = begin + i;
    const auto upper_a = hn::LoadU(d, rows.upper.disparity_px + at);
    const auto upper_b = hn::LoadU(d, rows.upper.disparity_px + at + 1);
    const auto lower_c = hn::LoadU(d, rows.lower.disparity_px + at);
    const auto lower_d = hn::LoadU(d, rows.lower.disparity_px + at + 1);
    const auto joined = [&](Vec p, Vec q)
                            HWY_ATTR { return hn::Le(hn::Abs(hn::Sub(p, q)), limit); };
    const auto is_known = [&](Vec p) HWY_ATTR { return hn::Eq(p, p); };
    const auto one_surface = hn::And(hn::And(joined(upper_a, upper_b), joined(upper_a, lower_c)),
                                     hn::And(joined(upper_b, lower_d), joined(lower_c, lower_d)));
    const auto some = hn::Or(hn::Or(is_known(upper_a), is_known(upper_b)),
                             hn::Or(is_known(lower_c), is_known(lower_d)));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::AndNot(one_surface, some), bits);
    torn |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << i;
  }
  const int count = rows.count - begin;
  return count < kBlock ? torn & ((std::uint64_t{1} << count) - 1) : torn;
}

// Exact targets of a row's pixels starting at one column, and the adjacent integers.
struct BlockTargets {
  double u[kBlock + 1];
  double v[kBlock + 1];
  std::int32_t first_column[kBlock + 1];
  std::int32_t last_column[kBlock + 1];
  std::int32_t first_line[kBlock + 1];
  std::int32_t last_line[kBlock + 1];
};

// first_whole() and last_whole() of targets.
template <class D64, class V>
HWY_INLINE void store_whole(D64 d, V target, const std::int32_t* rounded, std::int32_t* first,
                            std::int32_t* last) {
  const hn::Rebind<std::int32_t, D64> di32;
  const auto outside = hn::Set(d, kOutsidePx);
  const auto one = hn::Set(d, 1.0);
  const auto whole = hn::PromoteTo(d, hn::LoadU(di32, rounded));
  const auto is_above = hn::Gt(hn::Sub(target, outside), whole);
  const auto is_below = hn::Lt(hn::Add(target, outside), whole);
  hn::StoreU(hn::DemoteTo(di32, hn::Add(whole, hn::IfThenElseZero(is_above, one))), di32, first);
  hn::StoreU(hn::DemoteTo(di32, hn::Sub(whole, hn::IfThenElseZero(is_below, one))), di32, last);
}

// Targets of pixels [first, end) of the row, relative to column `begin`; same steps as
// exact_target().
template <bool kTranslation, class D64>
HWY_INLINE void find_targets(D64 d, const SplatRows& rows, const ProjectedRow& row, int line,
                             int begin, int first, int end, BlockTargets& targets) {
  const hn::Rebind<float, D64> d32;
  const auto parallax0 = hn::Set(d, rows.view.parallax[0]);
  const auto parallax1 = hn::Set(d, rows.view.parallax[1]);
  const auto parallax2 = hn::Set(d, rows.view.parallax[2]);
  const double* h = rows.view.homography;
  const double y = line;
  const auto step0 = hn::Set(d, h[0]);
  const auto step1 = hn::Set(d, h[3]);
  const auto step2 = hn::Set(d, h[6]);
  const auto start0 = hn::Set(d, h[1] * y + h[2]);
  const auto start1 = hn::Set(d, h[4] * y + h[5]);
  const auto start2 = hn::Set(d, h[7] * y + h[8]);
  for (int i = first; i < end; i += static_cast<int>(hn::Lanes(d))) {
    const auto disparity = hn::PromoteTo(d, hn::LoadU(d32, row.disparity_px + begin + i));
    const auto x = hn::Add(hn::Iota(d, 0), hn::Set(d, rows.first_column + begin + i));
    auto u = x;
    auto v = u;
    if constexpr (kTranslation) {
      u = hn::Add(x, hn::Mul(parallax0, disparity));
      v = hn::Add(hn::Set(d, y), hn::Mul(parallax1, disparity));
    } else {
      const auto depth_ratio =
          hn::Add(hn::Add(hn::Mul(step2, x), start2), hn::Mul(parallax2, disparity));
      const auto scale = hn::Div(hn::Set(d, 1.0), depth_ratio);
      u = hn::Mul(hn::Add(hn::Add(hn::Mul(step0, x), start0), hn::Mul(parallax0, disparity)),
                  scale);
      v = hn::Mul(hn::Add(hn::Add(hn::Mul(step1, x), start1), hn::Mul(parallax1, disparity)),
                  scale);
    }
    hn::StoreU(u, d, targets.u + i);
    hn::StoreU(v, d, targets.v + i);
    store_whole(d, u, row.column + begin + i, targets.first_column + i, targets.last_column + i);
    store_whole(d, v, row.line + begin + i, targets.first_line + i, targets.last_line + i);
  }
}

template <bool kTranslation>
HWY_INLINE void find_targets(const SplatRows& rows, int begin, BlockTargets& upper,
                             BlockTargets& lower) {
  const hn::ScalableTag<double> d;
  const hn::CappedTag<double, 1> d_one;
  find_targets<kTranslation>(d, rows, rows.upper, rows.line, begin, 0, kBlock, upper);
  find_targets<kTranslation>(d_one, rows, rows.upper, rows.line, begin, kBlock, kBlock + 1, upper);
  find_targets<kTranslation>(d, rows, rows.lower, rows.line + 1, begin, 0, kBlock, lower);
  find_targets<kTranslation>(d_one, rows, rows.lower, rows.line + 1, begin, kBlock, kBlock + 1,
                             lower);
}

// Bit i: the quad of columns begin + i and begin + i + 1 has no gaps: it is one surface, its edges
// have no gaps, and pixels have landed on the (at most four) positions inside.
HWY_INLINE std::uint64_t find_complete(const SplatRows& rows, const BlockTargets& upper,
                                       const BlockTargets& lower, int begin) {
  const Tag d;
  const TagInt di;
  const auto one = hn::Set(di, 1);
  const auto limit = hn::Set(d, rows.gradient_limit_px);
  std::uint64_t complete = 0;
  for (int i = 0; i < kBlock; i += static_cast<int>(hn::Lanes(d))) {
    const int at = begin + i;
    const Corners column = load_corners(rows.upper.column + at, rows.lower.column + at);
    const Corners line = load_corners(rows.upper.line + at, rows.lower.line + at);
    const auto first_u = min(load_corners(upper.first_column + i, lower.first_column + i));
    const auto last_u = max(load_corners(upper.last_column + i, lower.last_column + i));
    const auto first_v = min(load_corners(upper.first_line + i, lower.first_line + i));
    const auto last_v = max(load_corners(upper.last_line + i, lower.last_line + i));
    const auto is_landed_on = [&](VecInt u, VecInt v) HWY_ATTR {
      const auto is_at = [&](VecInt corner_u, VecInt corner_v)
                             HWY_ATTR { return hn::And(hn::Eq(u, corner_u), hn::Eq(v, corner_v)); };
      return hn::Or(hn::Or(is_at(column.a, line.a), is_at(column.b, line.b)),
                    hn::Or(is_at(column.c, line.c), is_at(column.d, line.d)));
    };
    const auto landed_on =
        hn::And(hn::And(is_landed_on(first_u, first_v), is_landed_on(last_u, first_v)),
                hn::And(is_landed_on(first_u, last_v), is_landed_on(last_u, last_v)));
    // Distance between the ends of an edge along its axis, in the direction of surfaces seen from
    // the front. Above 1 there is a gap.
    const auto distance = [&](EdgeDirection edge, VecInt column_to, VecInt line_to) HWY_ATTR {
      const auto along = edge.along_lines ? hn::Sub(line_to, line.a) : hn::Sub(column_to, column.a);
      return edge.sign > 0 ? along : hn::Neg(along);
    };
    const auto extent = hn::Max(hn::Max(hn::Sub(last_u, first_u), hn::Sub(last_v, first_v)),
                                hn::Max(distance(rows.right_edge, column.b, line.b),
                                        distance(rows.lower_edge, column.c, line.c)));
    const auto upper_a = hn::LoadU(d, rows.upper.disparity_px + at);
    const auto upper_b = hn::LoadU(d, rows.upper.disparity_px + at + 1);
    const auto lower_c = hn::LoadU(d, rows.lower.disparity_px + at);
    const auto lower_d = hn::LoadU(d, rows.lower.disparity_px + at + 1);
    const auto joined = [&](Vec p, Vec q)
                            HWY_ATTR { return hn::Le(hn::Abs(hn::Sub(p, q)), limit); };
    const auto one_surface = hn::And(hn::And(joined(upper_a, upper_b), joined(upper_a, lower_c)),
                                     hn::And(joined(upper_b, lower_d), joined(lower_c, lower_d)));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(
        d, hn::And(one_surface, hn::RebindMask(d, hn::AndNot(hn::Gt(extent, one), landed_on))),
        bits);
    complete |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << i;
  }
  return complete;
}

HWY_INLINE QuadCorner corner_at(const BlockTargets& targets, const ProjectedRow& row, int begin,
                                int i) {
  return {.u = targets.u[i],
          .v = targets.v[i],
          .nearness = row.nearness[begin + i],
          .disparity_px = row.disparity_px[begin + i],
          .column = row.column[begin + i],
          .line = row.line[begin + i]};
}

// Number of quads with possible gaps in a block from which testing all of them together is faster.
constexpr std::size_t kManyGaps = 12;

HWY_NOINLINE void fill_gaps(const SplatRows& rows, const SplatBand& band, int begin,
                            std::uint64_t gaps) {
  if (hwy::PopCount(gaps) < kManyGaps) {
    for (; gaps != 0; gaps &= gaps - 1) {
      const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(gaps));
      fill_quad_gaps(rows, quad_at(rows, begin + i), band);
    }
    return;
  }
  BlockTargets upper;
  BlockTargets lower;
  if (rows.view.is_translation) {
    find_targets<true>(rows, begin, upper, lower);
  } else {
    find_targets<false>(rows, begin, upper, lower);
  }
  for (gaps &= ~find_complete(rows, upper, lower, begin); gaps != 0; gaps &= gaps - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(gaps));
    fill_quad_gaps(rows,
                   {.a = corner_at(upper, rows.upper, begin, i),
                    .b = corner_at(upper, rows.upper, begin, i + 1),
                    .c = corner_at(lower, rows.lower, begin, i),
                    .d = corner_at(lower, rows.lower, begin, i + 1)},
                   band);
  }
}

void splat_any(const SplatRows& given, const SplatBand& band) {
  const SplatRows rows = given;  // a copy: stores to the band cannot alias it
  for (int begin = 0; begin < rows.count; begin += kBlock) {
    splat_pixels(rows, band, begin);
    std::uint64_t gaps = find_gaps(rows, band, begin);
    if (!rows.view.is_translation) {
      std::uint64_t torn = find_torn(rows, begin);
      gaps &= ~torn;
      for (; torn != 0; torn &= torn - 1) {
        const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(torn));
        fill_torn_quad(rows, begin + i, band);
      }
    }
    if (gaps != 0) {
      fill_gaps(rows, band, begin, gaps);
    }
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(splat_any);

void splat_rows(const SplatRows& rows, const SplatBand& band) {
  HWY_DYNAMIC_DISPATCH(splat_any)(rows, band);
}

}  // namespace vantage::kernels
#endif
