#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/combined_cost/combined_cost.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Steps of two vectors of residuals, in grouped order.
template <class D8>
HWY_INLINE VecOf<D8> residual_steps(D8 d, VecOf<Tag16<D8> > first, VecOf<Tag16<D8> > second,
                                    VecOf<Tag16<D8> > multiplier) {
  const hn::Half<D8> half;
  const Tag16<D8> d16;
  const hn::RebindToSigned<Tag16<D8> > signed16;
  const auto last = hn::Set(d16, kResidualSteps - 1);
  const auto bytes = [&](VecOf<Tag16<D8> > residual) HWY_ATTR {
    return hn::DemoteTo(half,
                        hn::BitCast(signed16, hn::Min(hn::MulHigh(residual, multiplier), last)));
  };
  return grouped(d, hn::Combine(d, bytes(second), bytes(first)));
}

// Sums of kBits / 8 neighbouring bytes, in lanes of 2 · kBits bits: those of a in the lower halves,
// those of b in the upper halves.
template <int kBits, class D8, class DWide>
HWY_INLINE VecOf<D8> pair_sums(D8 d, DWide wide, VecOf<D8> a, VecOf<D8> b) {
  using T = hn::TFromD<DWide>;
  const auto is_upper = hn::MaskFromVec(
      hn::BitCast(d, hn::Set(wide, static_cast<T>(static_cast<T>(~T{0}) << kBits))));
  const auto lower =
      hn::IfThenElse(is_upper, hn::BitCast(d, hn::ShiftLeft<kBits>(hn::BitCast(wide, b))), a);
  const auto upper =
      hn::IfThenElse(is_upper, b, hn::BitCast(d, hn::ShiftRight<kBits>(hn::BitCast(wide, a))));
  return hn::Add(lower, upper);
}

// Reference values of one column.
template <class D8>
struct ReferencePixel {
  VecOf<Tag16<D8> > level[3][3];
  VecOf<Tag16<D8> > gradient[2];
  VecOf<Tag32<D8> > code[2];
};

template <class D8>
HWY_INLINE VecOf<Tag16<D8> > outside(VecOf<Tag16<D8> > value, VecOf<Tag16<D8> > low,
                                     VecOf<Tag16<D8> > high) {
  return hn::Max(hn::SaturatedSub(value, high), hn::SaturatedSub(low, value));
}

template <class D8>
HWY_INLINE VecOf<Tag16<D8> > difference(VecOf<Tag16<D8> > a, VecOf<Tag16<D8> > b) {
  return hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
}

template <class D8>
HWY_INLINE VecOf<D8> grey_steps(D8 d, const FixedIntensityPairs& row,
                                const ReferencePixel<D8>& pixel, std::ptrdiff_t k,
                                VecOf<Tag16<D8> > multiplier) {
  const Tag16<D8> d16;
  const auto residual = [&](std::ptrdiff_t at) HWY_ATTR {
    auto sum = hn::Zero(d16);
    for (int c = 0; c < row.channels; ++c) {
      const auto& [level, min, max] = pixel.level[c];
      const auto& partner = row.channel[static_cast<std::size_t>(c)].partner;
      const auto other = hn::LoadU(d16, partner[0] + at);
      sum = hn::Add(sum, hn::Min(outside<D8>(level, hn::LoadU(d16, partner[1] + at),
                                             hn::LoadU(d16, partner[2] + at)),
                                 outside<D8>(other, min, max)));
    }
    return sum;
  };
  const auto next = static_cast<std::ptrdiff_t>(hn::Lanes(d16));
  return residual_steps(d, residual(k), residual(k + next), multiplier);
}

template <class D8>
HWY_INLINE VecOf<D8> gradient_steps(D8 d, const FixedGradientPairs& row,
                                    const ReferencePixel<D8>& pixel, std::ptrdiff_t k,
                                    VecOf<Tag16<D8> > multiplier) {
  const Tag16<D8> d16;
  const auto& partner = row.channel[0].partner;
  const auto residual = [&](std::ptrdiff_t at) HWY_ATTR {
    return hn::SaturatedAdd(difference<D8>(pixel.gradient[0], hn::LoadU(d16, partner[0] + at)),
                            difference<D8>(pixel.gradient[1], hn::LoadU(d16, partner[1] + at)));
  };
  const auto next = static_cast<std::ptrdiff_t>(hn::Lanes(d16));
  return residual_steps(d, residual(k), residual(k + next), multiplier);
}

template <class D8>
HWY_INLINE VecOf<D8> census_steps(D8 d, const CensusPairs& row, const ReferencePixel<D8>& pixel,
                                  std::ptrdiff_t k) {
  const Tag16<D8> d16;
  const Tag32<D8> d32;
  const auto& partner = row.channel[0].partner;
  const auto bits = [&](int vector) HWY_ATTR {
    const std::ptrdiff_t at = k + vector * static_cast<std::ptrdiff_t>(hn::Lanes(d32));
    const auto half = [&](int p) HWY_ATTR {
      const auto codes = hn::LoadU(d32, partner[static_cast<std::size_t>(p)] + at);
      return bits_of_bytes(d, hn::BitCast(d, hn::Xor(pixel.code[p], codes)));
    };
    return hn::Add(half(0), half(1));
  };
  // Adds the four bytes of each lane; byte v of lane i is then the count of lane i of vector v.
  const auto sums = pair_sums<16>(d, d32, pair_sums<8>(d, d16, bits(0), bits(1)),
                                  pair_sums<8>(d, d16, bits(2), bits(3)));
  alignas(16) static constexpr std::uint8_t kTransposed[16] = {0, 4, 8,  12, 1, 5, 9,  13,
                                                               2, 6, 10, 14, 3, 7, 11, 15};
  return hn::TableLookupBytes(sums, hn::LoadDup128(d, kTransposed));
}

// table[steps].
template <class D8>
HWY_INLINE VecOf<D8> looked_up(D8 d, const std::uint8_t* table, VecOf<D8> steps) {
  const auto within = hn::And(steps, hn::Set(d, 15));
  const auto quarter = [&](int q) HWY_ATTR {
    return hn::TableLookupBytes(hn::LoadDup128(d, table + 16 * q), within);
  };
  const auto odd = hn::TestBit(steps, hn::Set(d, 16));
  return hn::IfThenElse(hn::TestBit(steps, hn::Set(d, 32)),
                        hn::IfThenElse(odd, quarter(3), quarter(2)),
                        hn::IfThenElse(odd, quarter(1), quarter(0)));
}

// 16-bit values of a vector of cells.
template <class D8>
struct Values {
  VecOf<Tag16<D8> > lower;
  VecOf<Tag16<D8> > upper;
};

template <class D8>
HWY_INLINE Values<D8> values_at(D8 d, const TermTable& table, VecOf<D8> steps) {
  const Tag16<D8> d16;
  const auto low = looked_up(d, table.low.data(), steps);
  const auto high = looked_up(d, table.high.data(), steps);
  return {hn::BitCast(d16, hn::InterleaveLower(d, low, high)),
          hn::BitCast(d16, hn::InterleaveUpper(d, low, high))};
}

// Sum of the terms of a vector of cells.
template <class D8>
class EnergyCells {
 public:
  HWY_INLINE EnergyCells(D8 /*d*/, Values<D8> first) : sum_(first) {}
  HWY_INLINE void add(D8 /*d*/, Values<D8> term) {
    sum_.lower = hn::Add(sum_.lower, term.lower);
    sum_.upper = hn::Add(sum_.upper, term.upper);
  }
  HWY_INLINE void store(D8 /*d*/, float* cells) const {
    // The bits 0x4B00 above a 16-bit number make the float 2²³ + the number.
    const Tag16<D8> d16;
    const TagFloat<D8> df;
    const auto exponent = hn::Set(d16, 0x4B00);
    const auto offset = hn::Set(df, 8388608.0F);
    const auto unit = hn::Set(df, 1.0F / kEnergyUnitsPerNat);
    const std::size_t n = hn::Lanes(df);
    const auto store = [&](VecOf<Tag16<D8> > bits, float* at) HWY_ATTR {
      hn::StoreU(hn::Mul(hn::Sub(hn::BitCast(df, bits), offset), unit), df, at);
    };
    store(hn::InterleaveLower(d16, sum_.lower, exponent), cells);
    store(hn::InterleaveUpper(d16, sum_.lower, exponent), cells + n);
    store(hn::InterleaveLower(d16, sum_.upper, exponent), cells + 2 * n);
    store(hn::InterleaveUpper(d16, sum_.upper, exponent), cells + 3 * n);
  }

 private:
  Values<D8> sum_;
};

// Product of the terms of a vector of cells.
template <class D8>
class LikelihoodCells {
 public:
  HWY_INLINE LikelihoodCells(D8 /*d*/, Values<D8> first) { floats(first, product_); }
  HWY_INLINE void add(D8 /*d*/, Values<D8> term) {
    VecOf<TagFloat<D8> > factor[4];
    floats(term, factor);
#pragma GCC unroll 4
    for (int s = 0; s < 4; ++s) {
      product_[s] = hn::Mul(product_[s], factor[s]);
    }
  }
  HWY_INLINE void store(D8 /*d*/, float* cells) const {
    const TagFloat<D8> df;
#pragma GCC unroll 4
    for (int s = 0; s < 4; ++s) {
      hn::StoreU(product_[s], df, cells + static_cast<std::size_t>(s) * hn::Lanes(df));
    }
  }

 private:
  static HWY_INLINE void floats(Values<D8> values, VecOf<TagFloat<D8> > (&result)[4]) {
    const Tag16<D8> d16;
    const TagFloat<D8> df;
    const auto zero = hn::Zero(d16);
    result[0] = hn::BitCast(df, hn::InterleaveLower(d16, zero, values.lower));
    result[1] = hn::BitCast(df, hn::InterleaveUpper(d16, zero, values.lower));
    result[2] = hn::BitCast(df, hn::InterleaveLower(d16, zero, values.upper));
    result[3] = hn::BitCast(df, hn::InterleaveUpper(d16, zero, values.upper));
  }

  VecOf<TagFloat<D8> > product_[4];
};

// Processes the cells of one column in vectors of D8's size while whole vectors fit. Returns the
// first remaining lane.
template <template <class> class Cells, class D8>
HWY_INLINE int combine_lanes(D8 d, const CombinedRow& row, const CombinedModel& model, int column,
                             int lane, float* cells) {
  const int step = static_cast<int>(hn::Lanes(d));
  if (lane + step > row.levels.lanes) {
    return lane;
  }
  const Tag16<D8> d16;
  const Tag32<D8> d32;
  const auto grey_multiplier = hn::Set(d16, model.grey.multiplier);
  const auto gradient_multiplier = hn::Set(d16, model.gradient.multiplier);
  ReferencePixel<D8> pixel;
  for (int c = 0; c < row.levels.channels; ++c) {
    for (std::size_t p = 0; p < 3; ++p) {
      pixel.level[c][p] =
          hn::Set(d16, row.levels.channel[static_cast<std::size_t>(c)].reference[p][column]);
    }
  }
  for (std::size_t p = 0; p < 2; ++p) {
    if (model.has_census) {
      pixel.code[p] = hn::Set(d32, row.codes.channel[0].reference[p][column]);
    }
    if (model.has_gradient) {
      pixel.gradient[p] = hn::Set(d16, row.gradients.channel[0].reference[p][column]);
    }
  }
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(column) * row.levels.partner_step;
  for (; lane + step <= row.levels.lanes; lane += step) {
    const std::ptrdiff_t k = first + lane;
    Cells<D8> sum(
        d, values_at(d, model.grey.table, grey_steps(d, row.levels, pixel, k, grey_multiplier)));
    if (model.has_census) {
      sum.add(d, values_at(d, model.census.table, census_steps(d, row.codes, pixel, k)));
    }
    if (model.has_gradient) {
      sum.add(d, values_at(d, model.gradient.table,
                           gradient_steps(d, row.gradients, pixel, k, gradient_multiplier)));
    }
    sum.store(d, cells + lane);
  }
  return lane;
}

template <template <class> class Cells>
HWY_INLINE void combine_columns(const CombinedRow& row, const CombinedModel& model, float* cells) {
  for (int j = 0; j < row.levels.columns; ++j, cells += row.levels.lanes) {
    int lane = combine_lanes<Cells>(hn::ScalableTag<std::uint8_t>(), row, model, j, 0, cells);
    // Columns are multiples of 16 lanes.
    lane = combine_lanes<Cells>(hn::CappedTag<std::uint8_t, 32>(), row, model, j, lane, cells);
    combine_lanes<Cells>(hn::CappedTag<std::uint8_t, 16>(), row, model, j, lane, cells);
  }
}

void combined(const CombinedRow& row, const CombinedModel& model, CombinedCells meaning,
              float* cells) {
  if (meaning == CombinedCells::kEnergy) {
    combine_columns<EnergyCells>(row, model, cells);
    return;
  }
  combine_columns<LikelihoodCells>(row, model, cells);
  for (int j = 0; j < row.levels.columns; ++j, cells += row.levels.lanes) {
    std::fill(cells + row.levels.count, cells + row.levels.lanes, 0.0F);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(combined);

void combined_row(const CombinedRow& row, const CombinedModel& model, CombinedCells meaning,
                  float* cells) {
  HWY_DYNAMIC_DISPATCH(combined)(row, model, meaning, cells);
}

}  // namespace vantage::kernels
#endif
