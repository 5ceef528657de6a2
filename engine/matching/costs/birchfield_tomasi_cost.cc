#include "engine/matching/costs/cost_table.h"

namespace vantage {
namespace {

/// Intensities, and their minimum and maximum within half a pixel.
class SamplingPlanes final : public CostPlanes {
 public:
  ChannelPlanes<float, 3> intensities;

  void prepare(const PlaneSource& source, const MethodParameters& /*parameters*/) override {
    source.for_each_channel([&](std::size_t c) {
      for (FeaturePlane<float>& plane : intensities[c]) {
        plane.resize(source);
      }
    });
    source.for_each_channel_row([&](std::size_t c, int y) {
      auto& [grey, min, max] = intensities[c];
      source.channel_row(c, y, grey.plain.row(y));
      grey.finish_row(source, y);
      kernels::sampling_bounds_row(grey.plain.row(y), source.width(), min.plain.row(y),
                                   max.plain.row(y));
      min.finish_row(source, y);
      max.finish_row(source, y);
    });
  }
  [[nodiscard]] std::size_t held_bytes() const override { return held_bytes_of(intensities); }
};

class BirchfieldTomasiModel final : public CostModel {
 public:
  using CostModel::CostModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::sampling_insensitive_row(row.pairs(&SamplingPlanes::intensities), cells);
  }
  [[nodiscard]] CostBounds energy_bounds() const override { return {0, kWhite}; }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::sampling_insensitive_work(channels);
  }
};

}  // namespace

MatchingCost birchfield_tomasi_cost() {
  return {.key = MatchCost::kBirchfieldTomasi,
          .name = "birchfield-tomasi",
          .description = "smallest absolute difference within half a pixel",
          .options = {},
          .jump_limit = 10,
          .occlusion_penalty = 5,
          .make_planes = make_planes_as<SamplingPlanes>,
          .make_model = make_model_as<BirchfieldTomasiModel>};
}

}  // namespace vantage
