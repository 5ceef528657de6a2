#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "engine/matching/costs/census_codes.h"
#include "engine/matching/costs/cost_table.h"
#include "kernels/combined_cost/combined_cost.h"
#include "kernels/combined_cost/fixed_planes.h"

namespace vantage {
namespace {

bool has_census(const MethodParameters& parameters) { return parameters.sigma_census > 0; }
bool has_gradient(const MethodParameters& parameters) { return parameters.sigma_gradient > 0; }

/// Intensities of the channels; codes and gradients of luma.
class CombinedPlanes final : public CostPlanes {
 public:
  ChannelPlanes<std::uint16_t, 3> intensities;  ///< and their bounds within half a pixel
  CensusCodes codes;
  PlaneSet<std::uint16_t, 2> gradients;

  void prepare(const PlaneSource& source, const MethodParameters& parameters) override {
    prepare_filter_intensities(source, filter_intensities_);
    prepare_levels(source);
    if (source.channels > 1 && (has_census(parameters) || has_gradient(parameters))) {
      luma_.resize(source.width(), source.height(), kFilterMarginBefore, kFilterMarginAfter);
      source.for_each_row([&](int y) {
        source.luma_row(y, luma_.row(y));
        luma_.fill_margins(y);
      });
    }
    const IntensityPlane<float>& luma = source.channels > 1 ? luma_ : filter_intensities_[0];
    if (has_census(parameters)) {
      resize_codes(source, codes);
      source.for_each_row([&](int y) { census_code_row(source, luma, y, codes); });
    }
    if (has_gradient(parameters)) {
      for (FeaturePlane<std::uint16_t>& plane : gradients) {
        plane.resize(source);
      }
      source.for_each_row([&](int y) { make_gradient_row(source, luma, y); });
    }
  }
  [[nodiscard]] std::size_t held_bytes() const override {
    return held_bytes_of(intensities) + held_bytes_of(codes) + held_bytes_of(gradients) +
           held_bytes_of(filter_intensities_) + held_bytes_of(luma_);
  }

 private:
  void prepare_levels(const PlaneSource& source) {
    source.for_each_channel([&](std::size_t c) {
      for (FeaturePlane<std::uint16_t>& plane : intensities[c]) {
        plane.resize(source);
      }
    });
    source.for_each_channel_row([&](std::size_t c, int y) {
      auto& [level, min, max] = intensities[c];
      kernels::fixed_intensities_row(filter_intensities_[c].row(y), source.width(),
                                     {level.plain.row(y), min.plain.row(y), max.plain.row(y)});
      for (FeaturePlane<std::uint16_t>& plane : intensities[c]) {
        plane.finish_row(source, y);
      }
    });
  }

  void make_gradient_row(const PlaneSource& source, const IntensityPlane<float>& luma, int y) {
    auto& [gx, gy] = gradients;
    kernels::fixed_gradient_row(luma.row(std::max(0, y - 1)), luma.row(y),
                                luma.row(std::min(source.height() - 1, y + 1)), source.width(),
                                gx.plain.row(y), gy.plain.row(y));
    gx.finish_row(source, y);
    gy.finish_row(source, y);
  }

  FilterIntensities filter_intensities_;
  IntensityPlane<float> luma_;  ///< used with colour channels
};

class CombinedModel final : public CostModel {
 public:
  explicit CombinedModel(const MethodParameters& parameters)
      : CostModel(parameters),
        energies_(models_of(kernels::CombinedCells::kEnergy)),
        likelihoods_(models_of(kernels::CombinedCells::kLikelihood)) {}

  void energies(const CostRow& row, float* cells) const override {
    combine(row, energies_, kernels::CombinedCells::kEnergy, cells);
  }
  void likelihoods(const CostRow& row, float* cells) const override {
    combine(row, likelihoods_, kernels::CombinedCells::kLikelihood, cells);
  }
  /// Half of the maximum. With the maximum itself, the image border, where every true partner is
  /// outside, would be pulled to whatever else is near.
  [[nodiscard]] std::optional<float> energy_without_partner() const override {
    return static_cast<float>(largest_energy() / 2);
  }
  [[nodiscard]] float likelihood_without_partner() const override {
    return static_cast<float>(std::exp(-largest_energy() / 2));
  }
  [[nodiscard]] CostBounds energy_bounds() const override {
    // Each of the three terms is rounded to whole units.
    return {0, static_cast<float>(largest_energy() + 3.0 / kernels::kEnergyUnitsPerNat)};
  }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::combined_work(channels, has_census(parameters()), has_gradient(parameters()));
  }
  [[nodiscard]] kernels::KernelWork likelihood_work(int channels) const override {
    return energy_work(channels);
  }

 private:
  struct Models {
    kernels::CombinedModel of_luma;
    kernels::CombinedModel of_channels;
  };

  [[nodiscard]] Models models_of(kernels::CombinedCells meaning) const {
    const kernels::CombinedSigmas sigmas = {.grey_levels = parameters().sigma_measurement,
                                            .census_share = parameters().sigma_census,
                                            .gradient_levels_px = parameters().sigma_gradient};
    const double epsilon = parameters().epsilon_measurement;
    return {kernels::combined_model(sigmas, epsilon, 1, meaning),
            kernels::combined_model(sigmas, epsilon, 3, meaning)};
  }

  /// Sum of −log ε over the terms.
  [[nodiscard]] double largest_energy() const {
    const int terms = 1 + (has_census(parameters()) ? 1 : 0) + (has_gradient(parameters()) ? 1 : 0);
    return -terms *
           std::log(std::max(kernels::kMinCombinedEpsilon, parameters().epsilon_measurement));
  }

  void combine(const CostRow& row, const Models& models, kernels::CombinedCells meaning,
               float* cells) const {
    const kernels::CombinedModel& model =
        row.partner.channels() == 1 ? models.of_luma : models.of_channels;
    kernels::CombinedRow pairs;
    pairs.levels = row.pairs(&CombinedPlanes::intensities);
    if (model.has_census) {
      pairs.codes = row.pairs(&CombinedPlanes::codes);
    }
    if (model.has_gradient) {
      pairs.gradients = row.pairs(&CombinedPlanes::gradients);
    }
    kernels::combined_row(pairs, model, meaning, cells);
  }

  Models energies_;
  Models likelihoods_;
};

}  // namespace

MatchingCost combined_cost() {
  return {.key = MatchCost::kCombined,
          .name = "combined",
          .description = "sum for grey levels, census codes and gradients",
          .options = {"match-exposure", "sigma-measurement", "epsilon-measurement", "sigma-census",
                      "sigma-gradient"},
          // This cost is meant for photographs, whose noise differs from pair to pair.
          .estimates_sigma = true,
          .jump_limit = 2,
          .occlusion_penalty = 1.5,
          .make_planes = make_planes_as<CombinedPlanes>,
          .make_model = make_model_as<CombinedModel>};
}

}  // namespace vantage
