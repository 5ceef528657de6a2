#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>

#include "engine/execution.h"

namespace vantage {

/// Three steps over the rows of an image of which the second needs the first of rows up to
/// kBandRows away, and the third the second: rows are made, then filled, then finished, in bands.
/// Each band goes on as soon as it can, on the thread that made it possible, so only the memory of
/// a few bands is held at a time.
///
/// Thread rule: row() and complete() may be called concurrently for different rows, once each.
class RowBands {
 public:
  static constexpr int kBandRows = 16;

  /// `execution` must outlive the bands.
  RowBands(int rows, std::size_t row_bytes, Execution& execution)
      : rows_(rows),
        row_bytes_(row_bytes),
        execution_(execution),
        memory_(execution.scratch().lease(sizeof(Band) * static_cast<std::size_t>(count()))),
        bands_(reinterpret_cast<Band*>(memory_.data()), static_cast<std::size_t>(count())) {
    for (int band = 0; band < count(); ++band) {
      std::construct_at(&bands_[static_cast<std::size_t>(band)]);
      const int before = std::max(band - 1, 0);
      const int after = std::min(band + 1, count() - 1);
      at(band).rows_to_make = end_row(after) - before * kBandRows;
      at(band).bands_to_fill = after - before + 1;
    }
  }
  RowBands(const RowBands&) = delete;
  RowBands& operator=(const RowBands&) = delete;
  ~RowBands() { std::destroy(bands_.begin(), bands_.end()); }

  /// Memory of a row, until its band is finished.
  [[nodiscard]] std::byte* row(int y) {
    Band& band = at(y / kBandRows);
    const std::lock_guard lock(band.mutex);
    if (band.rows.data() == nullptr) {
      band.rows = execution_.scratch().lease(row_bytes_ * kBandRows);
    }
    return band.rows.data() + row_bytes_ * static_cast<std::size_t>(y % kBandRows);
  }

  /// Row y is made. Calls fill(first, end) of all bands that can be filled now, and finish(first,
  /// end) of those that can be finished.
  template <typename Fill, typename Finish>
  void complete(int y, const Fill& fill, const Finish& finish) {
    for_each_beside(y / kBandRows, [&](int band) {
      if (at(band).rows_to_make.fetch_sub(1) != 1) {
        return;
      }
      fill(band * kBandRows, end_row(band));
      for_each_beside(band, [&](int filled) {
        if (at(filled).bands_to_fill.fetch_sub(1) == 1) {
          finish(filled * kBandRows, end_row(filled));
          at(filled).rows = {};
        }
      });
    });
  }

 private:
  struct Band {
    std::mutex mutex;
    scheduler::ScratchPool::Lease rows;
    std::atomic<int> rows_to_make;   // of it and both neighbours
    std::atomic<int> bands_to_fill;  // likewise
  };

  [[nodiscard]] int count() const { return (rows_ + kBandRows - 1) / kBandRows; }
  [[nodiscard]] int end_row(int band) const { return std::min((band + 1) * kBandRows, rows_); }
  [[nodiscard]] Band& at(int band) const { return bands_[static_cast<std::size_t>(band)]; }

  template <typename Body>
  void for_each_beside(int band, const Body& body) const {
    for (int k = std::max(band - 1, 0); k <= std::min(band + 1, count() - 1); ++k) {
      body(k);
    }
  }

  int rows_;
  std::size_t row_bytes_;
  Execution& execution_;
  scheduler::ScratchPool::Lease memory_;
  std::span<Band> bands_;
};

}  // namespace vantage
