#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstdint>

#include "kernels/surface_fit/surface_blocks.h"
#include "kernels/surface_fit/surface_plane-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Pixels of half a vector of blocks, which are a vector of floats, and of a whole one.
constexpr int kHalfPixels = kSurfaceStep;
constexpr int kBlockPixels = 2 * kSurfaceStep;

// Part of a pixel row below or above blocks.
struct PixelPart {
  float* px;
  const std::uint8_t* unmatched;
  [[nodiscard]] PixelPart from(int pixel) const { return {px + pixel, unmatched + pixel}; }
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
  SurfaceVecF left_px, right_px;
  decltype(hn::Eq(SurfaceVecF(), SurfaceVecF())) left_matched, right_matched;
};

HWY_INLINE PixelPair load_pixels(const PixelPart& part) {
  const SurfaceTagF d;
  const hn::RebindToSigned<SurfaceTagF> d_int;
  const hn::Rebind<std::uint8_t, SurfaceTagF> d_byte;
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

void block_row(const SurfaceBlockRow& row, const SurfaceFormat& format, std::int16_t* blocks) {
  const SurfaceTagF d;
  const SurfaceTag d_sample;
  const SurfaceStorage storage(format);
  const int count_of_row = surface_blocks(row.width);
  // Means and smallest disparities of half a vector of blocks.
  const auto means = [&](const PixelPart& upper, const PixelPart& lower,
                         SurfaceVecF& lowest) HWY_ATTR {
    const SurfaceVecF none = hn::Set(d, kNoBlockPx);
    const SurfaceVecF zero = hn::Zero(d);
    const SurfaceVecF one = hn::Set(d, 1.0F);
    const PixelPair up = load_pixels(upper);
    const PixelPair down = load_pixels(lower);
    const SurfaceVecF up_left = hn::IfThenElse(up.left_matched, up.left_px, none);
    const SurfaceVecF up_right = hn::IfThenElse(up.right_matched, up.right_px, none);
    const SurfaceVecF down_left = hn::IfThenElse(down.left_matched, down.left_px, none);
    const SurfaceVecF down_right = hn::IfThenElse(down.right_matched, down.right_px, none);
    lowest = hn::Min(hn::Min(up_left, up_right), hn::Min(down_left, down_right));
    SurfaceVecF rise = zero;
    SurfaceVecF count = zero;
    const auto add = [&](SurfaceVecF px) HWY_ATTR {
      const SurfaceVecF above = hn::Sub(px, lowest);
      const auto is_near = hn::Lt(above, hn::Set(d, kSurfaceBlockRangePx));
      rise = hn::Add(rise, hn::IfThenElseZero(is_near, above));
      count = hn::Add(count, hn::IfThenElseZero(is_near, one));
    };
    add(up_left);
    add(up_right);
    add(down_left);
    add(down_right);
    return hn::Add(lowest, hn::Div(rise, count));
  };
  for_each_part<false>(row, [&](int x, const PixelPart& upper, const PixelPart& lower) HWY_ATTR {
    SurfaceVecF lowest;
    SurfaceVecF lowest_after;
    const SurfaceVecF mean = means(upper, lower, lowest);
    const SurfaceVecF mean_after =
        means(upper.from(kHalfPixels), lower.from(kHalfPixels), lowest_after);
    const auto is_none = [&](SurfaceVecF px) HWY_ATTR {
      return hn::BitCast(d_sample, hn::VecFromMask(d, hn::Eq(px, hn::Set(d, kNoBlockPx))));
    };
    const SurfaceVec none = hn::ConcatEven(d_sample, is_none(lowest_after), is_none(lowest));
    const SurfaceVec stored =
        hn::IfVecThenElse(none, hn::Set(d_sample, kNoSurface), storage.stored(mean, mean_after));
    if (x + kSurfaceStep <= count_of_row) {
      hn::StoreU(stored, d_sample, blocks + x);
    } else {
      HWY_ALIGN std::int16_t last[kSurfaceStep];
      hn::Store(stored, d_sample, last);
      std::copy_n(last, count_of_row - x, blocks + x);
    }
  });
}

// Replaces pixels by their planes' values.
HWY_INLINE void take_planes(SurfaceVecF left, SurfaceVecF right,
                            const SurfaceDisparities& disparities, const PixelPart& part) {
  const SurfaceTagF d;
  const SurfaceVecF max_move = hn::Set(d, kMaxSurfaceMovePx);
  const PixelPair own = load_pixels(part);
  const auto taken = [&](SurfaceVecF plane, SurfaceVecF px, auto is_matched) HWY_ATTR {
    const SurfaceVecF plane_px = disparities.px(plane);
    const auto is_near = hn::Lt(hn::Abs(hn::Sub(plane_px, px)), max_move);
    return hn::IfThenElse(hn::And(is_near, is_matched), disparities.clamp(plane_px), px);
  };
  hn::StoreInterleaved2(taken(left, own.left_px, own.left_matched),
                        taken(right, own.right_px, own.right_matched), d, part.px);
}

template <int kSteps>
HWY_INLINE void fit_block_row(const SurfaceRow& blocks, const SurfaceLattice& lattice,
                              const SurfaceBlockRow& row) {
  const SurfaceTagF d;
  const SurfaceDisparities disparities(blocks);
  const SurfaceQuarterBlock quarter = surface_quarter_block(lattice);
  const auto take_half = [&](SurfaceVecF centres, const SurfacePlanes& planes,
                             const PixelPart& upper, const PixelPart& lower) HWY_ATTR {
    const SurfaceVecF along = hn::Set(d, quarter.along);
    const SurfaceVecF across = hn::Set(d, quarter.across);
    const SurfaceVecF per_column =
        hn::Sub(hn::Mul(planes.slope_u, along), hn::Mul(planes.slope_v, across));
    const SurfaceVecF per_row =
        hn::Add(hn::Mul(planes.slope_u, across), hn::Mul(planes.slope_v, along));
    const SurfaceVecF middle = hn::Add(centres, planes.height);
    const SurfaceVecF up = hn::Sub(middle, per_row);
    const SurfaceVecF down = hn::Add(middle, per_row);
    take_planes(hn::Sub(up, per_column), hn::Add(up, per_column), disparities, upper);
    take_planes(hn::Sub(down, per_column), hn::Add(down, per_column), disparities, lower);
  };
  SurfaceRowFit<kSteps> fit(lattice, blocks);
  for (int part = 0; 2 * part < row.width; part += fit.kSize) {
    const SurfaceBlockRow part_row = row.from_block(part, fit.kSize);
    const std::int16_t* samples = blocks.samples + part;
    fit.fit(samples, surface_blocks(part_row.width));
    for_each_part<true>(part_row,
                        [&](int x, const PixelPart& upper, const PixelPart& lower) HWY_ATTR {
                          take_half(load_as_float(samples + x), fit.planes(x), upper, lower);
                          x += kSurfaceStepF;
                          take_half(load_as_float(samples + x), fit.planes(x),
                                    upper.from(kHalfPixels), lower.from(kHalfPixels));
                        });
  }
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

void surface_block_row(const SurfaceBlockRow& row, const SurfaceFormat& format,
                       std::int16_t* blocks) {
  HWY_DYNAMIC_DISPATCH(block_row)(row, format, blocks);
}

void fit_surface_block_row(const SurfaceRow& blocks, const SurfaceBlockRow& row) {
  HWY_DYNAMIC_DISPATCH(fit_surface_blocks)(blocks, row);
}

}  // namespace vantage::kernels
#endif
