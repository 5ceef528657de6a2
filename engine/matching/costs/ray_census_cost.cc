#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/ray_census_planes.h"
#include "engine/matching/costs/ray_census_tables.h"
#include "engine/matching/costs/stage_ray_census_energy.h"

namespace vantage {
namespace {

class RayCensusModel final : public CostModel {
 public:
  explicit RayCensusModel(const MethodParameters& parameters)
      : CostModel(parameters),
        thresholds_(parameters.census_thresholds),
        likelihoods_(ray_census_likelihoods(measurement(), thresholds_)) {}

  void energies(const CostRow& row, float* cells) const override {
    kernels::ray_hamming_row(codes(row), cells);
  }
  void likelihoods(const CostRow& row, float* cells) const override {
    if (row.partner.channels() == 1) {
      kernels::ray_census_likelihood_row(codes(row), likelihoods_, cells);
    } else {
      CostModel::likelihoods(row, cells);
    }
  }
  [[nodiscard]] CostBounds energy_bounds() const override {
    return {0, static_cast<float>(kernels::kRayCensusNeighbours)};
  }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::ray_hamming_work(channels, thresholds_);
  }
  [[nodiscard]] kernels::KernelWork likelihood_work(int channels) const override {
    return channels == 1 ? kernels::ray_census_likelihood_work(thresholds_)
                         : CostModel::likelihood_work(channels);
  }

 private:
  [[nodiscard]] kernels::RayCensusPairs codes(const CostRow& row) const {
    return ray_codes(row.partner, row.y, row.columns, row.memory, thresholds_);
  }

  int thresholds_;
  kernels::LikelihoodByDistance likelihoods_;
};

}  // namespace

void RayCensusPlanes::prepare(const PlaneSource& source, const MethodParameters& parameters) {
  const int thresholds = parameters.census_thresholds;
  source.for_each_channel([&](std::size_t c) {
    for (int k = 0; k < kernels::ray_census_bytes(thresholds); ++k) {
      codes[c][static_cast<std::size_t>(k)].resize(source);
    }
  });
  const auto* const image = std::get_if<Image<std::uint8_t>>(&source.photograph.pixels);
  if (image != nullptr && image->channels() == 1 && source.channels == 1 && thresholds == 1 &&
      source.phase.is_whole()) {
    prepare_byte_codes(source, *image);
  } else {
    prepare_codes(source, thresholds);
  }
}

void RayCensusPlanes::prepare_codes(const PlaneSource& source, int thresholds) {
  const auto bytes = static_cast<std::size_t>(kernels::ray_census_bytes(thresholds));
  prepare_filter_intensities(source, intensities_);
  source.for_each_channel_row([&](std::size_t c, int y) {
    kernels::RayCensusRows rows{};
    for (int v = -kernels::kRayCensusRadius; v <= kernels::kRayCensusRadius; ++v) {
      rows[static_cast<std::size_t>(v + kernels::kRayCensusRadius)] =
          intensities_[c].row(std::clamp(y + v, 0, source.height() - 1));
    }
    kernels::RayCensusCodes code_rows{};
    for (std::size_t k = 0; k < bytes; ++k) {
      code_rows[k] = codes[c][k].plain.row(y);
    }
    kernels::ray_census_code_row(rows, source.width(), thresholds, code_rows);
    for (std::size_t k = 0; k < bytes; ++k) {
      codes[c][k].finish_row(source, y);
    }
  });
}

/// Codes equal those that prepare_codes() makes from floats.
void RayCensusPlanes::prepare_byte_codes(const PlaneSource& source,
                                         const Image<std::uint8_t>& image) {
  bytes_.resize(source.width(), source.height(), kFilterMarginBefore, kFilterMarginAfter);
  source.for_each_row([&](int y) {
    std::copy_n(image.row(y), source.width(), bytes_.row(y));
    bytes_.fill_margins(y);
  });
  source.for_each_row([&](int y) {
    kernels::ByteRayCensusRows rows{};
    for (int v = -kernels::kRayCensusRadius; v <= kernels::kRayCensusRadius; ++v) {
      rows[static_cast<std::size_t>(v + kernels::kRayCensusRadius)] =
          bytes_.row(std::clamp(y + v, 0, source.height() - 1));
    }
    kernels::RayCensusCodes code_rows{};
    for (std::size_t k = 0; k < kernels::kRayCensusBytes; ++k) {
      code_rows[k] = codes[0][k].plain.row(y);
    }
    kernels::byte_ray_census_code_row(rows, source.width(), code_rows);
    for (std::size_t k = 0; k < kernels::kRayCensusBytes; ++k) {
      codes[0][k].finish_row(source, y);
    }
  });
}

MatchingCost ray_census_cost() {
  return {
      .key = MatchCost::kRayCensus,
      .name = "census-rays",
      .description = "census codes of 24 pixels in eight directions",
      .options = {"census-thresholds"},
      .jump_limit = 8,
      .occlusion_penalty = 6,
      .make_planes = make_planes_as<RayCensusPlanes>,
      .make_model = make_model_as<RayCensusModel>,
      .byte_energies = ByteEnergies{.nats_per_step =
                                        [](const MethodParameters& parameters) {
                                          return ray_census_energies(parameters).step;
                                        },
                                    .make_stage = make_ray_census_energy_stage,
                                    .without_partner =
                                        [](const MethodParameters& parameters) {
                                          return ray_census_energies(parameters).without_partner;
                                        }},
      .work_class = [](const MethodParameters& parameters) {
        return parameters.census_thresholds > 1
                   ? fmt::format(", {} thresholds", parameters.census_thresholds)
                   : std::string();
      }};
}

}  // namespace vantage
