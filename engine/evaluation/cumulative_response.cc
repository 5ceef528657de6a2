#include "engine/evaluation/cumulative_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "engine/error.h"

namespace vantage {
namespace {

// Displacements per task.
constexpr int kTaskDisplacements = 32;

void require_range(const char* field, DisparityRange range) {
  constexpr int kFarthest = 65536;
  if (range.min > range.max) {
    throw UsageError(
        fmt::format("{} is {}:{}, expected MIN not above MAX", field, range.min, range.max));
  }
  if (range.min < -kFarthest || range.max > kFarthest) {
    throw UsageError(fmt::format("{} is {}:{}, expected numbers within ±{}", field, range.min,
                                 range.max, kFarthest));
  }
}

// Tile that a task sums while it is in the cache, for all its displacements.
constexpr int kTileColumns = 256;
constexpr int kTileRows = 16;

PixelBlock block_of(ImagePart part, int width, int height) {
  const int x = width / 2;
  const int y = height / 2;
  switch (part) {
    case ImagePart::kTopLeft:
      return {0, x, 0, y};
    case ImagePart::kTopRight:
      return {x, width, 0, y};
    case ImagePart::kBottomLeft:
      return {0, x, y, height};
    case ImagePart::kBottomRight:
      return {x, width, y, height};
    case ImagePart::kWhole:
      break;
  }
  return {0, width, 0, height};
}

double area(const PixelBlock& block) {
  return static_cast<double>(std::max(0, block.x_end - block.x_begin)) *
         std::max(0, block.y_end - block.y_begin);
}

/// The pixels of a block of the left image that have a partner.
PixelBlock with_partner(const PixelBlock& block, Displacement displacement, int width, int height) {
  return {std::max(block.x_begin, displacement.x_px),
          std::min(block.x_end, width + displacement.x_px),
          std::max(block.y_begin, displacement.y_px),
          std::min(block.y_end, height + displacement.y_px)};
}

/// Adds the evidence of a block for neighbouring displacements to `sums`, in the same order for
/// each of them.
void add_evidence(const EvidencePair& pair, const PixelBlock& block,
                  std::span<const Displacement> displacements, double* sums) {
  for (int y = block.y_begin; y < block.y_end; y += kTileRows) {
    for (int x = block.x_begin; x < block.x_end; x += kTileColumns) {
      const PixelBlock tile{x, std::min(x + kTileColumns, block.x_end), y,
                            std::min(y + kTileRows, block.y_end)};
      for (std::size_t i = 0; i < displacements.size(); ++i) {
        sums[i] += pair.evidence(Side::kLeft, tile, displacements[i]);
      }
    }
  }
}

}  // namespace

void CumulativeResponseOptions::validate() const {
  require_range("displacements-x", displacements_x);
  require_range("displacements-y", displacements_y);
  const auto count = static_cast<long long>(displacements_x.count()) * displacements_y.count();
  if (count > kMaxDisplacements) {
    throw UsageError(fmt::format(
        "displacements-x is {}:{} and displacements-y {}:{} ({} displacements), expected at most "
        "{}",
        displacements_x.min, displacements_x.max, displacements_y.min, displacements_y.max, count,
        kMaxDisplacements));
  }
  vantage::validate(parameters);
}

double CumulativeResponse::at(ImagePart part, Displacement displacement) const {
  const int row = displacement.y_px - displacements_y.min;
  const int column = displacement.x_px - displacements_x.min;
  return surfaces[static_cast<std::size_t>(part)]
                 [static_cast<std::size_t>(row * displacements_x.count() + column)];
}

double CumulativeResponse::pixels(ImagePart part) const {
  return area(block_of(part, width_px, height_px));
}

std::optional<Displacement> CumulativeResponse::dominant(ImagePart part) const {
  const PixelBlock block = block_of(part, width_px, height_px);
  std::optional<Displacement> best;
  double largest = 0;
  double min = 0;
  for (int dy = displacements_y.min; dy <= displacements_y.max; ++dy) {
    for (int dx = displacements_x.min; dx <= displacements_x.max; ++dx) {
      const Displacement displacement{dx, dy};
      if (2 * area(with_partner(block, displacement, width_px, height_px)) < area(block)) {
        continue;
      }
      const double sum = at(part, displacement);
      min = best ? std::min(min, sum) : sum;
      if (!best || sum > largest) {
        best = displacement;
        largest = sum;
      }
    }
  }
  const bool is_only = displacements_x.count() == 1 && displacements_y.count() == 1;
  return largest > min || (is_only && largest > 0) ? best : std::nullopt;
}

CumulativeResponse cumulative_response(const Photograph& left, const Photograph& right,
                                       const CumulativeResponseOptions& options,
                                       Execution& execution) {
  options.validate();
  const EvidencePair pair(left, right, options.parameters, execution);
  const int columns = options.displacements_x.count();
  const int count = columns * options.displacements_y.count();
  CumulativeResponse response{.displacements_x = options.displacements_x,
                              .displacements_y = options.displacements_y,
                              .width_px = pair.width(),
                              .height_px = pair.height(),
                              .surfaces = {}};
  for (std::vector<double>& surface : response.surfaces) {
    surface.resize(static_cast<std::size_t>(count));
  }
  const int tasks = (count + kTaskDisplacements - 1) / kTaskDisplacements;
  execution.executor().parallel_for(tasks, [&](int task) {
    const int begin = task * kTaskDisplacements;
    std::vector<Displacement> displacements;
    for (int index = begin; index < std::min(begin + kTaskDisplacements, count); ++index) {
      displacements.push_back({options.displacements_x.min + index % columns,
                               options.displacements_y.min + index / columns});
    }
    auto& [whole, top_left, top_right, bottom_left, bottom_right] = response.surfaces;
    for (const ImagePart part : {ImagePart::kTopLeft, ImagePart::kTopRight, ImagePart::kBottomLeft,
                                 ImagePart::kBottomRight}) {
      add_evidence(pair, block_of(part, pair.width(), pair.height()), displacements,
                   response.surfaces[static_cast<std::size_t>(part)].data() + begin);
    }
    for (std::size_t i = static_cast<std::size_t>(begin);
         i < static_cast<std::size_t>(begin) + displacements.size(); ++i) {
      whole[i] = top_left[i] + top_right[i] + bottom_left[i] + bottom_right[i];
    }
  });
  return response;
}

}  // namespace vantage
