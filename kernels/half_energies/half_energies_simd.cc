#include "kernels/simd-inl.h"

#include <cstddef>
#include <cstdint>

#include "kernels/half_energies/half_energies.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;
using Vec = hn::VFromD<Tag>;
using IntTag = hn::RebindToSigned<Tag>;
using HalfTag = hn::Rebind<std::uint16_t, Tag>;

// Same steps as to_half().
HWY_INLINE void store_halves(Vec value, std::uint16_t* halves) {
  const Tag df;
  const IntTag d32;
  const Vec magnitude = hn::Min(hn::Abs(value), hn::Set(df, kLargestHalf));
  const auto small = hn::BitCast(d32, hn::Mul(magnitude, hn::Set(df, kFloatToHalf)));
  const auto odd = hn::And(hn::ShiftRight<kHalfShift>(small), hn::Set(d32, 1));
  const auto rounded =
      hn::ShiftRight<kHalfShift>(hn::Add(small, hn::Add(odd, hn::Set(d32, 0xFFF))));
  const auto sign = hn::And(hn::ShiftRight<16>(hn::BitCast(d32, value)), hn::Set(d32, 0x8000));
  hn::StoreU(hn::DemoteTo(HalfTag(), hn::Or(rounded, sign)), HalfTag(), halves);
}

// Same steps as of_half().
HWY_INLINE Vec load_halves(const std::uint16_t* halves) {
  const Tag df;
  const IntTag d32;
  const auto bits = hn::PromoteTo(d32, hn::LoadU(HalfTag(), halves));
  const auto magnitude = hn::ShiftLeft<kHalfShift>(hn::And(bits, hn::Set(d32, 0x7FFF)));
  const auto sign = hn::ShiftLeft<16>(hn::And(bits, hn::Set(d32, 0x8000)));
  const Vec value = hn::Mul(hn::BitCast(df, magnitude), hn::Set(df, kHalfToFloat));
  return hn::Or(value, hn::BitCast(df, sign));
}

HWY_INLINE int step() { return static_cast<int>(hn::Lanes(Tag())); }

void half_energies(const float* energies, int cells, float scale, std::uint16_t* halves) {
  const Vec factor = hn::Set(Tag(), scale);
  for (int k = 0; k < cells; k += step()) {
    store_halves(hn::Mul(hn::LoadU(Tag(), energies + k), factor), halves + k);
  }
}

void energies_of_half(const std::uint16_t* halves, int cells, float unit, float* energies) {
  const Vec factor = hn::Set(Tag(), unit);
  for (int k = 0; k < cells; k += step()) {
    hn::StoreU(hn::Mul(load_halves(halves + k), factor), Tag(), energies + k);
  }
}

template <typename Cell, class Load>
HWY_INLINE void reduce(const BlockRow<Cell>& row, float scale, Load load, std::uint16_t* halves) {
  const Vec quarter = hn::Set(Tag(), scale / 4);
  for (int b = 0; b < row.blocks(); ++b, halves += row.lanes) {
    const Cell* const left = row.upper + row.left(b);
    const Cell* const right = row.upper + row.right(b);
    const Cell* const lower_left = row.lower + row.left(b);
    const Cell* const lower_right = row.lower + row.right(b);
    for (int lane = 0; lane < row.lanes; lane += step()) {
      const Vec upper = hn::Add(load(left + lane), load(right + lane));
      const Vec lower = hn::Add(load(lower_left + lane), load(lower_right + lane));
      store_halves(hn::Mul(hn::Add(upper, lower), quarter), halves + lane);
    }
  }
}

void reduce_energies(const BlockRow<float>& row, float scale, std::uint16_t* halves) {
  reduce(
      row, scale, [](const float* cells) HWY_ATTR { return hn::LoadU(Tag(), cells); }, halves);
}

void reduce_half_energies(const BlockRow<std::uint16_t>& row, std::uint16_t* halves) {
  reduce(
      row, 1, [](const std::uint16_t* cells) HWY_ATTR { return load_halves(cells); }, halves);
}

// Calls cell(energies of the coarser level, index of the cell) for each vector of cells.
template <class Cells>
HWY_INLINE void each_over_coarser(const CoarserRow& row, Cells cells) {
  const Vec unit = hn::Set(Tag(), row.unit);
  for (int x = 0; x < row.columns; ++x) {
    const int block = (row.first_column + x) / 2 - row.first_column / 2;
    const std::uint16_t* const coarser =
        row.coarser + static_cast<std::ptrdiff_t>(block) * row.lanes;
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(x) * row.lanes;
    for (int lane = 0; lane < row.lanes; lane += step()) {
      cells(hn::Mul(load_halves(coarser + lane), unit), first + lane);
    }
  }
}

void energies_from_coarser(const CoarserRow& row, float* output) {
  each_over_coarser(row, [output](Vec coarser, std::ptrdiff_t k)
                             HWY_ATTR { hn::StoreU(coarser, Tag(), output + k); });
}

void energies_with_coarser(const CoarserRow& row, const float* own, float* output) {
  const Vec half = hn::Set(Tag(), 0.5F);
  each_over_coarser(row, [&](Vec coarser, std::ptrdiff_t k) HWY_ATTR {
    hn::StoreU(hn::Mul(half, hn::Add(hn::LoadU(Tag(), own + k), coarser)), Tag(), output + k);
  });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(half_energies);
HWY_EXPORT(energies_of_half);
HWY_EXPORT(reduce_energies);
HWY_EXPORT(reduce_half_energies);
HWY_EXPORT(energies_from_coarser);
HWY_EXPORT(energies_with_coarser);

void half_energies_row(const float* energies, int cells, float scale, std::uint16_t* halves) {
  HWY_DYNAMIC_DISPATCH(half_energies)(energies, cells, scale, halves);
}
void energies_of_half_row(const std::uint16_t* halves, int cells, float unit, float* energies) {
  HWY_DYNAMIC_DISPATCH(energies_of_half)(halves, cells, unit, energies);
}
void reduce_energies_row(const BlockRow<float>& row, float scale, std::uint16_t* halves) {
  HWY_DYNAMIC_DISPATCH(reduce_energies)(row, scale, halves);
}
void reduce_half_energies_row(const BlockRow<std::uint16_t>& row, std::uint16_t* halves) {
  HWY_DYNAMIC_DISPATCH(reduce_half_energies)(row, halves);
}
void energies_from_coarser_row(const CoarserRow& row, float* output) {
  HWY_DYNAMIC_DISPATCH(energies_from_coarser)(row, output);
}
void energies_with_coarser_row(const CoarserRow& row, const float* own, float* output) {
  HWY_DYNAMIC_DISPATCH(energies_with_coarser)(row, own, output);
}

}  // namespace vantage::kernels
#endif
