#include "engine/refinement/kept_refinement.h"

#include <algorithm>
#include <cstring>

namespace vantage {
namespace {

using scheduler::Range;
using scheduler::Region;

bool differ(const Mask& mask, const Mask& before, const Region& pixels) {
  for (int y = pixels.rows.begin; y < pixels.rows.end; ++y) {
    if (std::memcmp(mask.row(y) + pixels.columns.begin, before.row(y) + pixels.columns.begin,
                    static_cast<std::size_t>(pixels.columns.size())) != 0) {
      return true;
    }
  }
  return false;
}

/// Whether a run of set pixels continues over the left side of column x.
bool continues(const Mask& mask, int x, const Region& pixels) {
  for (int y = pixels.rows.begin; y < pixels.rows.end; ++y) {
    if (mask.at(x - 1, y) != 0 && mask.at(x, y) != 0) {
      return true;
    }
  }
  return false;
}

template <typename T>
void copy_tiles(const TileMask& tiles, bool value, const Image<T>& source, Image<T>& target) {
  for (int row = 0; row < tiles.rows(); ++row) {
    const Range rows = tiles.row_pixels(row);
    tiles.for_each_run(row, value, [&](Range columns) {
      for (int y = rows.begin; y < rows.end; ++y) {
        std::copy_n(source.row(y) + columns.begin, columns.size(), target.row(y) + columns.begin);
      }
    });
  }
}

}  // namespace

void KeptRefinement::find_changed(const Mask& unmatched) {
  if (unmatched_.empty()) {
    return;
  }
  for (int row = 0; row < changed_.rows(); ++row) {
    for (int column = 0; column < changed_.columns(); ++column) {
      if (!changed_.at(column, row) &&
          differ(unmatched, unmatched_, changed_.pixels(column, row))) {
        changed_.set(column, row);
      }
    }
    const auto spread = [&](int column, int beside) {
      if (changed_.at(beside, row) && !changed_.at(column, row) &&
          continues(unmatched, changed_.pixels(std::max(column, beside), row).columns.begin,
                    changed_.pixels(column, row))) {
        changed_.set(column, row);
      }
    };
    for (int column = 1; column < changed_.columns(); ++column) {
      spread(column, column - 1);
    }
    for (int column = changed_.columns() - 2; column >= 0; --column) {
      spread(column, column + 1);
    }
  }
}

void KeptRefinement::restore(DisparityMap& map_px) const {
  if (!unmatched_.empty()) {
    copy_tiles(changed_, false, refined_px_, map_px);
  }
}

void KeptRefinement::remember(const MatchedMap& map) {
  const bool is_first = unmatched_.empty();
  unmatched_.resize(map.unmatched.width(), map.unmatched.height());
  refined_px_.resize(map.disparity_px.width(), map.disparity_px.height());
  if (is_first) {
    changed_.assign(map.disparity_px.width(), map.disparity_px.height(), true);
  }
  copy_tiles(changed_, true, map.unmatched, unmatched_);
  copy_tiles(changed_, true, map.disparity_px, refined_px_);
}

}  // namespace vantage
