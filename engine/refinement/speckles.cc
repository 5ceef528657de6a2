#include "engine/refinement/speckles.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>

#include "kernels/row_bits/row_bits.h"

namespace vantage {
namespace {

constexpr float kSpeckleSurfaceStepPx = 1.0F;

using Run = SpeckleWork::Run;
using RowBits = SpeckleWork::RowBits;

/// Finds the regions of one map: runs of connected pixels in each row, joined with those of the row
/// above.
class Regions {
 public:
  Regions(ImageView<const float> map_px, ImageView<const float> map_y_px, SpeckleWork& work)
      : map_px_(map_px),
        map_y_px_(map_y_px),
        width_(map_px.width()),
        words_(static_cast<std::size_t>(kernels::row_words(width_))),
        work_(work) {
    for (RowBits& row : work_.rows) {
      row.matched.resize(words_);
      row.joins_right.resize(words_);
      row.joins_left.resize(words_);
    }
    work_.near.resize(words_);
    work_.near_y.resize(words_);
    work_.runs.clear();
    work_.row_begin.assign(1, 0);
  }

  void find(const Mask& unmatched) {
    for (int y = 0; y < map_px_.height(); ++y) {
      RowBits& row = work_.rows[static_cast<std::size_t>(y % 2)];
      kernels::zero_bits_row(unmatched.row(y), width_, row.matched.data());
      find_runs(y, row);
      if (y > 0) {
        join_above(y, row, work_.rows[static_cast<std::size_t>((y + 1) % 2)]);
      }
      work_.row_begin.push_back(static_cast<std::int32_t>(work_.runs.size()));
    }
    // `joined` leads to earlier runs only, so these already know the first run of their region.
    for (Run& run : work_.runs) {
      run.joined = run_at(run.joined).joined;
      run_at(run.joined).pixels += run.end - run.begin;
    }
  }

 private:
  Run& run_at(std::int32_t index) { return work_.runs[static_cast<std::size_t>(index)]; }

  /// Sets work_.near where pixel x of row y and pixel x + columns of row y + rows are near.
  void compare(int y, int columns, int rows) {
    const int count = width_ - columns;
    const auto compare_map = [&](ImageView<const float> map, std::uint64_t* bits) {
      kernels::near_bits_row(map.row(y), map.row(y + rows) + columns, kSpeckleSurfaceStepPx, count,
                             bits);
    };
    compare_map(map_px_, work_.near.data());
    if (!map_y_px_.empty()) {
      compare_map(map_y_px_, work_.near_y.data());
      for (std::size_t i = 0; i < words_; ++i) {
        work_.near[i] &= work_.near_y[i];
      }
    }
  }

  void find_runs(int y, RowBits& row) {
    compare(y, 1, 0);
    const auto first = static_cast<std::int32_t>(work_.runs.size());
    std::uint64_t left_of_word = 0;
    std::int32_t ended = first;
    for (std::size_t i = 0; i < words_; ++i) {
      const std::uint64_t matched = row.matched[i];
      const std::uint64_t right_of_word = i + 1 < words_ ? row.matched[i + 1] << 63 : 0;
      row.joins_right[i] = work_.near[i] & matched & (matched >> 1 | right_of_word);
      row.joins_left[i] = row.joins_right[i] << 1 | left_of_word;
      left_of_word = row.joins_right[i] >> 63;
      const auto column = static_cast<std::int32_t>(64 * i);
      for (std::uint64_t rest = matched & ~row.joins_left[i]; rest != 0; rest &= rest - 1) {
        work_.runs.push_back({.begin = column + std::countr_zero(rest),
                              .joined = static_cast<std::int32_t>(work_.runs.size())});
      }
      for (std::uint64_t rest = matched & ~row.joins_right[i]; rest != 0; rest &= rest - 1) {
        run_at(ended++).end = column + std::countr_zero(rest) + 1;
      }
    }
  }

  void join_above(int y, const RowBits& row, const RowBits& above) {
    compare(y, 0, -1);
    std::int32_t above_run = work_.row_begin[static_cast<std::size_t>(y - 1)];
    std::int32_t run = work_.row_begin[static_cast<std::size_t>(y)];
    std::uint64_t left_of_word = 0;
    for (std::size_t i = 0; i < words_; ++i) {
      const std::uint64_t joins_above = work_.near[i] & row.matched[i] & above.matched[i];
      // Runs that the pixels to the left have joined need not be joined again.
      const std::uint64_t joined_left =
          (joins_above << 1 | left_of_word) & row.joins_left[i] & above.joins_left[i];
      left_of_word = joins_above >> 63;
      for (std::uint64_t rest = joins_above & ~joined_left; rest != 0; rest &= rest - 1) {
        const auto column = static_cast<std::int32_t>(64 * i) + std::countr_zero(rest);
        while (run_at(above_run).end <= column) {
          ++above_run;
        }
        while (run_at(run).end <= column) {
          ++run;
        }
        join(above_run, run);
      }
    }
  }

  /// The first known run of a run's region; compresses the path to it.
  std::int32_t first_of(std::int32_t index) {
    while (run_at(index).joined != index) {
      run_at(index).joined = run_at(run_at(index).joined).joined;
      index = run_at(index).joined;
    }
    return index;
  }

  void join(std::int32_t a, std::int32_t b) {
    const auto [first, later] = std::minmax({first_of(a), first_of(b)});
    run_at(later).joined = first;
  }

  ImageView<const float> map_px_;
  ImageView<const float> map_y_px_;
  int width_;
  std::size_t words_;
  SpeckleWork& work_;
};

}  // namespace

void mark_speckles(ImageView<const float> map_px, ImageView<const float> map_y_px, int min_pixels,
                   SpeckleWork& work, Mask& unmatched) {
  if (map_px.empty()) {
    return;
  }
  Regions(map_px, map_y_px, work).find(unmatched);
  for (int y = 0; y < map_px.height(); ++y) {
    const auto row = static_cast<std::size_t>(y);
    for (std::int32_t i = work.row_begin[row]; i < work.row_begin[row + 1]; ++i) {
      const Run& run = work.runs[static_cast<std::size_t>(i)];
      if (work.runs[static_cast<std::size_t>(run.joined)].pixels < min_pixels) {
        std::fill(unmatched.row(y) + run.begin, unmatched.row(y) + run.end, std::uint8_t{255});
      }
    }
  }
}

}  // namespace vantage
