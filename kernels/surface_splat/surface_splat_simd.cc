#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/surface_splat/surface_splat_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "kernels/surface_splat/quad_gaps.h"
#include "kernels/surface_splat/surface_splat.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Columns that are looked at together; a multiple of every vector's length.
constexpr int kBlock = 64;
static_assert(kBlock <= kSplatPadding);

// Bits as many as vectors have lanes here at most.
using Tag = hn::CappedTag<float, 16>;
using TagInt = hn::RebindToSigned<Tag>;
using Vec = hn::VFromD<Tag>;
using VecInt = hn::VFromD<TagInt>;

// The upper row's pixels from column `begin`: where each lies in the band. Those outside, and those
// behind the end, become −inf at the first place, which changes nothing there.
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

// What is looked at of the four corners of a quad per lane.
struct Corners {
  VecInt a, b, c, d;
};

HWY_INLINE Corners load_corners(const std::int32_t* upper, const std::int32_t* lower) {
  const TagInt di;
  return {hn::LoadU(di, upper), hn::LoadU(di, upper + 1), hn::LoadU(di, lower),
          hn::LoadU(di, lower + 1)};
}

HWY_INLINE VecInt extent(const Corners& at) {
  return hn::Sub(hn::Max(hn::Max(at.a, at.b), hn::Max(at.c, at.d)),
                 hn::Min(hn::Min(at.a, at.b), hn::Min(at.c, at.d)));
}

// Bit i: something may lie between the pixels of the quad of upper columns begin + i and
// begin + i + 1, because two corners of an edge or triangle on one surface land more than one
// column or line apart.
HWY_INLINE std::uint64_t find_gaps(const SplatRows& rows, int begin) {
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
    hn::StoreMaskBits(d, hn::Or(edges, diagonals), bits);
    gaps |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << i;
  }
  const int count = rows.count - begin;
  return count < kBlock ? gaps & ((std::uint64_t{1} << count) - 1) : gaps;
}

void splat_any(const SplatRows& given, const SplatBand& band) {
  const SplatRows rows = given;  // which stores to the band cannot change
  for (int begin = 0; begin < rows.count; begin += kBlock) {
    splat_pixels(rows, band, begin);
    for (std::uint64_t gaps = find_gaps(rows, begin); gaps != 0; gaps &= gaps - 1) {
      fill_quad_gaps(rows, begin + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(gaps)),
                     band);
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
