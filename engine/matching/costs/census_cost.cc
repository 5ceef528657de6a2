#include <array>

#include "engine/matching/costs/census_codes.h"
#include "engine/matching/costs/cost_table.h"

namespace vantage {
namespace {

class CensusPlanes final : public CostPlanes {
 public:
  ChannelPlanes<std::uint32_t, 2> codes;

  void prepare(const PlaneSource& source, const MethodParameters& /*parameters*/) override {
    prepare_filter_intensities(source, intensities_);
    source.for_each_channel([&](std::size_t c) { resize_codes(source, codes[c]); });
    source.for_each_channel_row(
        [&](std::size_t c, int y) { census_code_row(source, intensities_[c], y, codes[c]); });
  }
  [[nodiscard]] std::size_t held_bytes() const override {
    return held_bytes_of(codes) + held_bytes_of(intensities_);
  }

 private:
  FilterIntensities intensities_;
};

class CensusModel final : public CostModel {
 public:
  using CostModel::CostModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::hamming_row(row.pairs(&CensusPlanes::codes), cells);
  }
  [[nodiscard]] CostBounds energy_bounds() const override {
    return {0, static_cast<float>(kernels::kCensusBits)};
  }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::hamming_work(channels);
  }
};

}  // namespace

MatchingCost census_cost() {
  return {.key = MatchCost::kCensus,
          .name = "census",
          .description = "differing bits of census codes of 9x7 pixels",
          .options = {},
          .jump_limit = 10,
          .occlusion_penalty = 15,
          .make_planes = make_planes_as<CensusPlanes>,
          .make_model = make_model_as<CensusModel>};
}

}  // namespace vantage
