#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/photograph_position/photograph_position.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void convert_positions(const PhotographTable& given_table, const SourcePositions& given_positions,
                       int count) {
  // Local copies: stores cannot alias them.
  const PhotographTable table = given_table;
  const SourcePositions at = given_positions;
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  // Gathers use 32-bit indices.
  constexpr std::ptrdiff_t kMaxValues = std::numeric_limits<std::int32_t>::max();
  if (table.stride * table.height > kMaxValues) {
    photograph_positions_row_ref(table, at, count);
    return;
  }
  const auto first = hn::Zero(di);
  const auto last_column = hn::Set(di, std::max(table.width - 2, 0));
  const auto last_line = hn::Set(di, std::max(table.height - 2, 0));
  const auto stride = hn::Set(di, static_cast<std::int32_t>(table.stride));
  const std::ptrdiff_t right = table.width > 1 ? 1 : 0;
  const std::ptrdiff_t down = table.height > 1 ? table.stride : 0;
  const auto min = hn::Set(d, -0.5F);
  const auto max_x = hn::Set(d, static_cast<float>(table.photograph_width) - 0.5F);
  const auto max_y = hn::Set(d, static_cast<float>(table.photograph_height) - 0.5F);
  const auto unknown = hn::Set(d, std::numeric_limits<float>::quiet_NaN());

  const int step = static_cast<int>(hn::Lanes(d));
  int n = 0;
  for (; n + step <= count; n += step) {
    const auto column = hn::LoadU(di, at.column + n);
    const auto line = hn::LoadU(di, at.line + n);
    const auto cell_column = hn::Min(hn::Max(column, first), last_column);
    const auto cell_line = hn::Min(hn::Max(line, first), last_line);
    const auto fraction_x =
        hn::Add(hn::LoadU(d, at.fraction_x + n), hn::ConvertTo(d, hn::Sub(column, cell_column)));
    const auto fraction_y =
        hn::Add(hn::LoadU(d, at.fraction_y + n), hn::ConvertTo(d, hn::Sub(line, cell_line)));
    const auto index = hn::Add(hn::Mul(cell_line, stride), cell_column);
    // Mul, Add and Sub, never fused: results must not depend on the instruction set.
    const auto between = [&](const float* values) HWY_ATTR {
      const auto corner = hn::GatherIndex(d, values, index);
      const auto below = hn::GatherIndex(d, values + down, index);
      const auto along = hn::Sub(hn::GatherIndex(d, values + right, index), corner);
      const auto along_below = hn::Sub(hn::GatherIndex(d, values + down + right, index), below);
      const auto across =
          hn::Add(hn::Sub(below, corner), hn::Mul(fraction_x, hn::Sub(along_below, along)));
      return hn::Add(corner, hn::Add(hn::Mul(fraction_x, along), hn::Mul(fraction_y, across)));
    };
    const auto disparity = hn::LoadU(d, at.disparity_px + n);
    auto x = between(table.x_px);
    auto y = between(table.y_px);
    const auto in_columns = hn::And(hn::Ge(x, min), hn::Le(x, max_x));
    const auto in_lines = hn::And(hn::Ge(y, min), hn::Le(y, max_y));
    const auto is_known = hn::Eq(disparity, disparity);
    const auto is_seen = hn::And(hn::And(in_columns, in_lines), is_known);
    x = hn::IfThenElseZero(is_seen, x);
    y = hn::IfThenElseZero(is_seen, y);
    const auto whole_x = hn::Floor(x);
    const auto whole_y = hn::Floor(y);
    hn::StoreU(hn::ConvertTo(di, whole_x), di, at.column + n);
    hn::StoreU(hn::ConvertTo(di, whole_y), di, at.line + n);
    hn::StoreU(hn::Sub(x, whole_x), d, at.fraction_x + n);
    hn::StoreU(hn::Sub(y, whole_y), d, at.fraction_y + n);
    hn::StoreU(hn::IfThenElse(is_seen, disparity, unknown), d, at.disparity_px + n);
  }
  photograph_positions_row_ref(table,
                               {.column = at.column + n,
                                .line = at.line + n,
                                .fraction_x = at.fraction_x + n,
                                .fraction_y = at.fraction_y + n,
                                .disparity_px = at.disparity_px + n},
                               count - n);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(convert_positions);

void photograph_positions_row(const PhotographTable& table, const SourcePositions& positions,
                              int count) {
  HWY_DYNAMIC_DISPATCH(convert_positions)(table, positions, count);
}

// Scalar reference.

void photograph_positions_row_ref(const PhotographTable& table, const SourcePositions& positions,
                                  int count) {
  for (int n = 0; n < count; ++n) {
    if (std::isnan(positions.disparity_px[n])) {
      continue;
    }
    const int column = std::clamp(positions.column[n], 0, std::max(table.width - 2, 0));
    const int line = std::clamp(positions.line[n], 0, std::max(table.height - 2, 0));
    const float fraction_x =
        positions.fraction_x[n] + static_cast<float>(positions.column[n] - column);
    const float fraction_y = positions.fraction_y[n] + static_cast<float>(positions.line[n] - line);
    const std::ptrdiff_t at = line * table.stride + column;
    const std::ptrdiff_t right = table.width > 1 ? 1 : 0;
    const std::ptrdiff_t down = table.height > 1 ? table.stride : 0;
    // Interpolates small differences: only the last addition rounds to the precision of positions.
    const auto between = [&](const float* values) {
      const float along = values[at + right] - values[at];
      const float along_below = values[at + down + right] - values[at + down];
      return values[at] + (fraction_x * along + fraction_y * ((values[at + down] - values[at]) +
                                                              fraction_x * (along_below - along)));
    };
    float x = between(table.x_px);
    float y = between(table.y_px);
    const bool is_seen = x >= -0.5F && x <= static_cast<float>(table.photograph_width) - 0.5F &&
                         y >= -0.5F && y <= static_cast<float>(table.photograph_height) - 0.5F;
    if (!is_seen) {
      x = y = 0;
      positions.disparity_px[n] = std::numeric_limits<float>::quiet_NaN();
    }
    positions.column[n] = static_cast<std::int32_t>(std::floor(x));
    positions.line[n] = static_cast<std::int32_t>(std::floor(y));
    positions.fraction_x[n] = x - std::floor(x);
    positions.fraction_y[n] = y - std::floor(y);
  }
}

}  // namespace vantage::kernels
#endif
