#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/surface_fit/surface_blocks_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "kernels/surface_fit/surface_blocks.h"
#include "kernels/surface_fit/surface_plane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Pixels of a vector of blocks.
constexpr int kBlockPixels = 2 * kSurfaceStep;

// Part of a pixel row below or above a vector of blocks.
struct PixelPart {
  float* px;
  const std::uint8_t* unmatched;
};

// Copies of parts that have fewer than kBlockPixels pixels: the rest is unmatched.
struct PaddedPart {
  HWY_ALIGN float px[kBlockPixels] = {};
  HWY_ALIGN std::uint8_t unmatched[kBlockPixels];

  PixelPart read(const PixelPart& part, int pixels) {
    std::fill_n(unmatched, kBlockPixels, std::uint8_t{255});
    if (part.px != nullptr) {
      std::copy_n(part.px, pixels, px);
      std::copy_n(part.unmatched, pixels, unmatched);
    }
    return {px, unmatched};
  }
  void write(const PixelPart& part, int pixels) const {
    if (part.px != nullptr) {
      std::copy_n(px, pixels, part.px);
    }
  }
};

// Calls body(x / 2, upper part, lower part) for vectors of blocks that cover the row.
template <bool kWrites, class Body>
HWY_INLINE void for_each_part(const SurfaceBlockRow& row, const Body& body) {
  int x = 0;
  if (row.lower_px != nullptr) {
    for (; x + kBlockPixels <= row.width; x += kBlockPixels) {
      body(x / 2, PixelPart{row.upper_px + x, row.upper_unmatched + x},
           PixelPart{row.lower_px + x, row.lower_unmatched + x});
    }
  }
  for (; x < row.width; x += kBlockPixels) {
    const int pixels = std::min(kBlockPixels, row.width - x);
    const PixelPart upper{row.upper_px + x, row.upper_unmatched + x};
    const PixelPart lower = row.lower_px == nullptr
                                ? PixelPart{nullptr, nullptr}
                                : PixelPart{row.lower_px + x, row.lower_unmatched + x};
    PaddedPart upper_copy;
    PaddedPart lower_copy;
    body(x / 2, upper_copy.read(upper, pixels), lower_copy.read(lower, pixels));
    if (kWrites) {
      upper_copy.write(upper, pixels);
      lower_copy.write(lower, pixels);
    }
  }
}

// Left and right pixels of blocks.
struct PixelPair {
  SurfaceVec left_px, right_px;
  decltype(hn::Eq(SurfaceVec(), SurfaceVec())) left_matched, right_matched;
};

HWY_INLINE PixelPair load_pixels(const PixelPart& part) {
  const SurfaceTag d;
  const hn::RebindToSigned<SurfaceTag> d_int;
  const hn::Rebind<std::uint8_t, SurfaceTag> d_byte;
  PixelPair pair;
  hn::LoadInterleaved2(d, part.px, pair.left_px, pair.right_px);
  hn::VFromD<decltype(d_byte)> left;
  hn::VFromD<decltype(d_byte)> right;
  hn::LoadInterleaved2(d_byte, part.unmatched, left, right);
  const auto is_matched = [&](auto bytes) HWY_ATTR {
    return hn::RebindMask(d, hn::Eq(hn::PromoteTo(d_int, bytes), hn::Zero(d_int)));
  };
  pair.left_matched = is_matched(left);
  pair.right_matched = is_matched(right);
  return pair;
}

void block_row(const SurfaceBlockRow& row, float* blocks_px) {
  const SurfaceTag d;
  const int blocks = surface_blocks(row.width);
  for_each_part<false>(row, [&](int x, const PixelPart& upper, const PixelPart& lower) HWY_ATTR {
    const SurfaceVec none = hn::Set(d, kNoSurfacePx);
    const SurfaceVec zero = hn::Zero(d);
    const auto one = hn::Set(d, 1.0F);
    const PixelPair up = load_pixels(upper);
    const PixelPair down = load_pixels(lower);
    const SurfaceVec up_left = hn::IfThenElse(up.left_matched, up.left_px, none);
    const SurfaceVec up_right = hn::IfThenElse(up.right_matched, up.right_px, none);
    const SurfaceVec down_left = hn::IfThenElse(down.left_matched, down.left_px, none);
    const SurfaceVec down_right = hn::IfThenElse(down.right_matched, down.right_px, none);
    const SurfaceVec lowest = hn::Min(hn::Min(up_left, up_right), hn::Min(down_left, down_right));
    SurfaceVec rise = zero;
    SurfaceVec count = zero;
    const auto add = [&](SurfaceVec px) HWY_ATTR {
      const SurfaceVec above = hn::Sub(px, lowest);
      const auto is_near = hn::Lt(above, hn::Set(d, kSurfaceReachPx));
      rise = hn::Add(rise, hn::IfThenElseZero(is_near, above));
      count = hn::Add(count, hn::IfThenElseZero(is_near, one));
    };
    add(up_left);
    add(up_right);
    add(down_left);
    add(down_right);
    const SurfaceVec mean = hn::Add(lowest, hn::Div(rise, count));
    if (x + kSurfaceStep <= blocks) {
      hn::StoreU(mean, d, blocks_px + x);
    } else {
      HWY_ALIGN float last[kSurfaceStep];
      hn::Store(mean, d, last);
      std::copy_n(last, blocks - x, blocks_px + x);
    }
  });
}

// Replaces pixels by their planes' values.
HWY_INLINE void take_planes(SurfaceVec left_px, SurfaceVec right_px, const SurfaceLimits& limits,
                            const PixelPart& part) {
  const SurfaceTag d;
  const SurfaceVec reach = hn::Set(d, kSurfaceReachPx);
  const PixelPair own = load_pixels(part);
  const auto taken = [&](SurfaceVec plane, SurfaceVec px, auto is_matched) HWY_ATTR {
    const auto is_near = hn::Lt(hn::Abs(hn::Sub(plane, px)), reach);
    return hn::IfThenElse(hn::And(is_near, is_matched), limits.clamp(plane), px);
  };
  hn::StoreInterleaved2(taken(left_px, own.left_px, own.left_matched),
                        taken(right_px, own.right_px, own.right_matched), d, part.px);
}

template <int kSteps>
HWY_INLINE void fit_block_row(const SurfaceRow& blocks, const SurfaceLattice& lattice,
                              const SurfaceBlockRow& row) {
  const SurfaceTag d;
  const SurfacePlaces<kSteps> places(lattice, blocks.pitch);
  const SurfaceLimits limits(blocks);
  const SurfaceQuarterBlock quarter = surface_quarter_block(lattice);
  for_each_part<true>(row, [&](int x, const PixelPart& upper, const PixelPart& lower) HWY_ATTR {
    const float* centres = blocks.disparity_px + x;
    const SurfacePlanes planes = fit_surface_planes(centres, places);
    const SurfaceVec along = hn::Set(d, quarter.along);
    const SurfaceVec across = hn::Set(d, quarter.across);
    const SurfaceVec per_column =
        hn::Sub(hn::Mul(planes.slope_u, along), hn::Mul(planes.slope_v, across));
    const SurfaceVec per_row =
        hn::Add(hn::Mul(planes.slope_u, across), hn::Mul(planes.slope_v, along));
    const SurfaceVec middle = hn::Add(hn::LoadU(d, centres), planes.height);
    const SurfaceVec up = hn::Sub(middle, per_row);
    const SurfaceVec down = hn::Add(middle, per_row);
    take_planes(hn::Sub(up, per_column), hn::Add(up, per_column), limits, upper);
    take_planes(hn::Sub(down, per_column), hn::Add(down, per_column), limits, lower);
  });
}

void fit_surface_blocks(const SurfaceRow& blocks, const SurfaceBlockRow& row) {
  const SurfaceLattice lattice = surface_block_lattice(blocks.radius_px);
  if (lattice.steps == kMaxSurfaceSteps) {
    fit_block_row<kMaxSurfaceSteps>(blocks, lattice, row);
  } else {
    fit_block_row<1>(blocks, lattice, row);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(block_row);
HWY_EXPORT(fit_surface_blocks);

void surface_block_row(const SurfaceBlockRow& row, float* blocks_px) {
  HWY_DYNAMIC_DISPATCH(block_row)(row, blocks_px);
}

void fit_surface_block_row(const SurfaceRow& blocks, const SurfaceBlockRow& row) {
  HWY_DYNAMIC_DISPATCH(fit_surface_blocks)(blocks, row);
}

}  // namespace vantage::kernels
#endif
