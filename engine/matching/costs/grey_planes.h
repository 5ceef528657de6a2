#pragma once

#include <cstddef>

#include "engine/matching/costs/cost_planes.h"

namespace vantage {

/// Intensities of each channel, for costs that compare only intensities.
class GreyPlanes final : public CostPlanes {
 public:
  ChannelPlanes<float, 1> grey;

  void prepare(const PlaneSource& source, const MethodParameters& /*parameters*/) override {
    source.for_each_channel([&](std::size_t c) { grey[c][0].resize(source); });
    source.for_each_channel_row([&](std::size_t c, int y) {
      source.channel_row(c, y, grey[c][0].plain.row(y));
      grey[c][0].finish_row(source, y);
    });
  }
  [[nodiscard]] std::size_t held_bytes() const override { return held_bytes_of(grey); }
};

}  // namespace vantage
