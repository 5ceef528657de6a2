#include "engine/sequence/past/still_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <variant>

#include "engine/error.h"
#include "engine/image/intensity_rows.h"
#include "kernels/luma_intensity/luma_intensity.h"
#include "kernels/still_pixels/still_pixels.h"

namespace vantage {
namespace {

constexpr double kWhite = 255;
constexpr int kBoxPixels = 9;

void luma_rows(const Photograph& photograph, int first_row, int end_row, float* grey,
               Image<std::uint8_t>& intensities) {
  for (int y = first_row; y < end_row; ++y) {
    intensity_row(photograph, y, grey);
    std::transform(grey, grey + intensities.width(), intensities.row(y), [](float level) {
      return static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F) + 0.5F);
    });
  }
}

/// The changes of three rows around a row that advances downwards.
class ChangeRows {
 public:
  static std::size_t values(int width) {
    return 4 * static_cast<std::size_t>(kernels::still_row_values(width));
  }

  ChangeRows(const Image<std::uint8_t>& before, const Image<std::uint8_t>& now,
             std::int16_t* memory)
      : before_(before), now_(now), memory_(memory) {}

  void make(int y) {
    kernels::FrameRows rows;
    rows.width = now_.width();
    for (int k = 0; k < 3; ++k) {
      const int row = std::clamp(y + k - 1, 0, now_.height() - 1);
      rows.now[k] = now_.row(row);
      rows.before[k] = before_.row(row);
    }
    kernels::box_change_row(rows, place(3), place(y % 3));
  }
  [[nodiscard]] std::array<const std::int16_t*, 3> around(int y) const {
    const auto row = [&](int r) { return place(std::clamp(r, 0, now_.height() - 1) % 3); };
    return {row(y - 1), row(y), row(y + 1)};
  }

 private:
  [[nodiscard]] std::int16_t* place(int k) const {
    return memory_ + static_cast<std::ptrdiff_t>(k) * kernels::still_row_values(now_.width()) +
           kernels::kStillMargin;
  }

  const Image<std::uint8_t>& before_;
  const Image<std::uint8_t>& now_;
  std::int16_t* memory_;
};

}  // namespace

void luma_intensity(const Photograph& photograph, Execution& execution,
                    Image<std::uint8_t>& intensities) {
  const int width = photograph.width();
  intensities.resize(width, photograph.height());
  const auto* bytes = std::get_if<Image<std::uint8_t>>(&photograph.pixels);
  execution.for_each_band(photograph.height(), [&](int first_row, int end_row) {
    if (bytes == nullptr) {
      const auto grey = execution.scratch().lease(sizeof(float) * static_cast<std::size_t>(width));
      luma_rows(photograph, first_row, end_row, reinterpret_cast<float*>(grey.data()), intensities);
      return;
    }
    for (int y = first_row; y < end_row; ++y) {
      kernels::luma_intensity_row(bytes->row(y), width, bytes->channels(), intensities.row(y));
    }
  });
}

StillPixels::StillPixels(double threshold) : limit_(0) {
  if (!(threshold >= 0 && threshold <= kWhite)) {
    throw UsageError(fmt::format("temporal-threshold is {}, expected grey levels from 0 to {}",
                                 threshold, kWhite));
  }
  limit_ = static_cast<std::int16_t>(std::floor(threshold * kBoxPixels));
}

std::int64_t StillPixels::find(const Image<std::uint8_t>& before, const Image<std::uint8_t>& now,
                               Execution& execution, Mask& still) const {
  still.resize(now.width(), now.height());
  find_in_rows(before, now, {0, now.height()}, execution, still);
  std::atomic<std::int64_t> count = 0;
  execution.for_each_band(now.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      count += std::count(still.row(y), still.row(y) + now.width(), std::uint8_t{255});
    }
  });
  return count;
}

void StillPixels::find_in_rows(const Image<std::uint8_t>& before, const Image<std::uint8_t>& now,
                               scheduler::Range rows, Execution& execution, Mask& still) const {
  const int width = now.width();
  const int height = now.height();
  execution.for_each_band(rows.size(), [&](int first_of_rows, int end_of_rows) {
    const int first_row = rows.begin + first_of_rows;
    const int end_row = rows.begin + end_of_rows;
    const auto memory = execution.scratch().lease(sizeof(std::int16_t) * ChangeRows::values(width));
    ChangeRows changes(before, now, reinterpret_cast<std::int16_t*>(memory.data()));
    for (int y = std::max(0, first_row - 1); y <= first_row; ++y) {
      changes.make(y);
    }
    for (int y = first_row; y < end_row; ++y) {
      if (y + 1 < height) {
        changes.make(y + 1);
      }
      kernels::still_row(changes.around(y).data(), width, limit_, still.row(y));
    }
  });
}

}  // namespace vantage
