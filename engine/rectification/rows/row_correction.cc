#include "engine/rectification/rows/row_correction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "engine/image/remapped_row.h"

namespace vantage {
namespace {

// Fields are smooth: so many columns whose first and last come from one row all come from it.
constexpr int kColumnsOfARow = 16;

/// `image` with pixel (x, y) from row row_of(x, y).
template <typename T, typename RowOf>
Image<T> with_moved_rows(const Image<T>& image, const RowOf& row_of, Execution& execution) {
  Image<T> moved(image.width(), image.height());
  if (image.empty()) {
    return moved;
  }
  execution.for_each_row(image.height(), [&](int y) {
    const auto source = [&](int x) {
      const auto row = static_cast<int>(std::lround(row_of(x, y)));
      return image.row(std::clamp(row, 0, image.height() - 1));
    };
    for (int begin = 0; begin < image.width(); begin += kColumnsOfARow) {
      const int end = std::min(begin + kColumnsOfARow, image.width());
      const T* const first = source(begin);
      if (first == source(end - 1)) {
        std::copy(first + begin, first + end, moved.row(y) + begin);
        continue;
      }
      for (int x = begin; x < end; ++x) {
        moved.at(x, y) = source(x)[x];
      }
    }
  });
  return moved;
}

template <typename RowOf>
void move_rows(MatchedMap& map, const RowOf& row_of, Execution& execution) {
  map.disparity_px = with_moved_rows(map.disparity_px, row_of, execution);
  map.confidence = with_moved_rows(map.confidence, row_of, execution);
  map.unmatched = with_moved_rows(map.unmatched, row_of, execution);
}

}  // namespace

void correct_rows(const Photograph& right, const RowField& field, Photograph& result,
                  Execution& execution) {
  std::visit(
      [&]<typename T>(const Image<T>& from) {
        const int width = from.width();
        Image<T>& to = pixels_of<T>(result);
        to.resize(width, from.height(), from.channels());
        execution.for_each_band(from.height(), [&](int first_row, int end_row) {
          std::vector<float> x_px(static_cast<std::size_t>(width));
          std::vector<float> y_px(static_cast<std::size_t>(width));
          for (int y = first_row; y < end_row; ++y) {
            const RowField::Row row = field.along_row(y);
            for (int x = 0; x < width; ++x) {
              const auto i = static_cast<std::size_t>(x);
              x_px[i] = static_cast<float>(x);
              y_px[i] = static_cast<float>(std::clamp(y + row.at(x), 0.0, from.height() - 1.0));
            }
            remap_row(from, x_px.data(), y_px.data(), y, to);
          }
        });
      },
      right.pixels);
  result.origin = right.origin;
  result.left_out = with_moved_rows(
      right.left_out, [&](int x, int y) { return y + field.at(x, y); }, execution);
}

void correct_photograph(const Photograph& right, const RowField& field, const Rectifier& rectifier,
                        Photograph& result, Execution& execution) {
  std::visit(
      [&]<typename T>(const Image<T>& from) {
        const int width = from.width();
        Image<T>& to = pixels_of<T>(result);
        to.resize(width, from.height(), from.channels());
        execution.for_each_band(from.height(), [&](int first_row, int end_row) {
          RectifiedPositions positions(rectifier, Side::kRight);
          std::vector<float> x_px(static_cast<std::size_t>(width));
          std::vector<float> y_px(static_cast<std::size_t>(width));
          for (int y = first_row; y < end_row; ++y) {
            for (int x = 0; x < width; ++x) {
              const Eigen::Vector2d at = positions.position(x, y);
              const auto source = rectifier.source_position(
                  Side::kRight, {at.x(), at.y() + field.at(at.x(), at.y())});
              constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
              const auto i = static_cast<std::size_t>(x);
              x_px[i] = source ? static_cast<float>(source->x()) : kNowhere;
              y_px[i] = source ? static_cast<float>(source->y()) : kNowhere;
            }
            remap_row(from, x_px.data(), y_px.data(), y, to);
          }
        });
      },
      right.pixels);
  result.origin = right.origin;
}

void bring_to_given_rows(const RowField& field, MatchedMap& map, Execution& execution) {
  move_rows(
      map, [&](int x, int y) { return field.row_of_left(x, y); }, execution);
}

void bring_to_corrected_rows(const RowField& field, MatchedMap& map, Execution& execution) {
  move_rows(
      map, [&](int x, int y) { return y + field.at(x, y); }, execution);
}

}  // namespace vantage
