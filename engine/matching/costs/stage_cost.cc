#include "engine/matching/costs/stage_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "engine/column_work.h"
#include "engine/error.h"
#include "engine/matching/costs/combined_terms.h"
#include "engine/matching/costs/partner_rows.h"
#include "engine/matching/costs/ray_census_tables.h"
#include "kernels/census/census.h"
#include "kernels/combined_cost/combined_cost.h"
#include "kernels/evidence/evidence.h"
#include "kernels/pixel_cost/pixel_cost.h"
#include "kernels/ray_census/ray_census.h"

namespace vantage {
namespace {

using kernels::CandidateRange;
using scheduler::Extent;
using scheduler::Range;

class CostStage final : public scheduler::RowStage {
 public:
  CostStage(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
            std::vector<PartnerRows> partners, CellMeaning meaning, int height)
      : RowStage({geometry.width, height}),
        parameters_(parameters),
        measurement_(kernels::ContaminatedGaussian::of(parameters.sigma_measurement,
                                                       parameters.epsilon_measurement)),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        partners_(std::move(partners)),
        meaning_(meaning),
        combined_cells_(meaning == CellMeaning::kEnergy ? kernels::CombinedCells::kEnergy
                                                        : kernels::CombinedCells::kLikelihood),
        combined_of_luma_(combined_model(1)),
        combined_of_channels_(combined_model(3)),
        likelihood_by_distance_(ray_census_likelihoods(measurement_, parameters.census_thresholds)),
        without_partner_(value_without_partner()) {}

  [[nodiscard]] std::string_view name() const override { return "cost"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(float) * lanes(); }
  /// The cells of one block for the partners after the first, and what interpolation needs.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return in_one_go() ? 0 : sizeof(float) * (kBlockColumns * lanes() + most_work_floats());
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    kernels::KernelWork work;
    for (const PartnerRows& partner : partners_) {
      work = work + (meaning_ == CellMeaning::kEnergy ? energy_work(partner.channels())
                                                      : likelihood_work(partner.channels()));
      for (int c = 0; partner.is_interpolated() && c < partner.channels(); ++c) {
        work = work + kernels::kInterpolateCandidatesWork;
      }
      if (&partner != &partners_.front()) {
        work = work + kernels::kCombineCellsWork;
      }
    }
    return vantage::column_work(work, count_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* cells = reinterpret_cast<float*>(task.output);
    if (in_one_go()) {
      compare(partners_.front(), task.y, task.columns, nullptr, cells);
      return;
    }
    auto* of_partner = reinterpret_cast<float*>(task.state);
    float* work = of_partner + kBlockColumns * lanes();
    for (int x = task.columns.begin; x < task.columns.end; x += kBlockColumns) {
      const Range block = Range{x, x + kBlockColumns}.widened(0, task.columns);
      compare(partners_.front(), task.y, block, work, cells);
      for (std::size_t k = 1; k < partners_.size(); ++k) {
        compare(partners_[k], task.y, block, work, of_partner);
        if (meaning_ == CellMeaning::kEnergy) {
          kernels::add_cells(of_partner, block.size() * lanes_, cells);
        } else {
          kernels::multiply_cells(of_partner, block.size() * lanes_, cells);
        }
      }
      cells += static_cast<std::size_t>(block.size()) * lanes();
    }
  }

 private:
  static constexpr int kBlockColumns = 16;

  [[nodiscard]] std::size_t lanes() const { return static_cast<std::size_t>(lanes_); }
  [[nodiscard]] bool in_one_go() const {
    return partners_.size() == 1 && !partners_.front().is_interpolated();
  }
  [[nodiscard]] std::size_t most_work_floats() const {
    std::size_t floats = 0;
    for (const PartnerRows& partner : partners_) {
      floats = std::max(floats, partner.work_floats(kBlockColumns));
    }
    return floats;
  }

  /// Of cells whose partner is outside, unless they have the cost of the border.
  [[nodiscard]] std::optional<float> value_without_partner() const {
    if (parameters_.cost == MatchCost::kCombined) {
      const double energy = combined_energy_without_partner(parameters_);
      return static_cast<float>(meaning_ == CellMeaning::kEnergy ? energy : std::exp(-energy));
    }
    if (meaning_ == CellMeaning::kLikelihood) {
      return measurement_.likelihood_without_partner();
    }
    switch (parameters_.cost) {
      case MatchCost::kGradient:
        return 0.0F;
      case MatchCost::kContaminated:
        return measurement_.energy_without_partner();
      default:
        return std::nullopt;
    }
  }

  [[nodiscard]] kernels::CombinedModel combined_model(int channels) const {
    return kernels::combined_model(combined_sigmas(parameters_), parameters_.epsilon_measurement,
                                   channels, combined_cells_);
  }

  /// What energies() and likelihoods() do.
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const {
    switch (parameters_.cost) {
      case MatchCost::kSquared:
        return kernels::squared_work(channels);
      case MatchCost::kAbsolute:
      case MatchCost::kTruncated:
        return kernels::absolute_work(channels);
      case MatchCost::kContaminated:
        return kernels::contaminated_energy_work(channels);
      case MatchCost::kBirchfieldTomasi:
        return kernels::sampling_insensitive_work(channels);
      case MatchCost::kGradient:
        return kernels::negated_evidence_work(parameters_.norm == GradientNorm::kOctagon, channels);
      case MatchCost::kRayCensus:
        return kernels::ray_hamming_work(channels, parameters_.census_thresholds);
      case MatchCost::kCombined:
        return kernels::combined_work(channels, combined_of_luma_.has_census,
                                      combined_of_luma_.has_gradient);
      case MatchCost::kCensus:
        break;
    }
    return kernels::hamming_work(channels);
  }
  [[nodiscard]] kernels::KernelWork likelihood_work(int channels) const {
    switch (parameters_.cost) {
      case MatchCost::kSquared:
        return kernels::contaminated_likelihood_work(channels);
      case MatchCost::kContaminated:
        return channels == 1 ? kernels::contaminated_likelihood_work(channels)
                             : energy_work(channels) + kernels::kLikelihoodOfEnergiesWork;
      case MatchCost::kGradient:
        return energy_work(channels) + kernels::kLikelihoodOfEvidenceWork;
      case MatchCost::kCombined:
        return energy_work(channels);
      case MatchCost::kRayCensus:
        if (channels == 1) {
          return kernels::ray_census_likelihood_work(parameters_.census_thresholds);
        }
        [[fallthrough]];
      default:
        return energy_work(channels) + kernels::kLikelihoodOfCostsWork;
    }
  }

  /// The cells of one partner.
  void compare(const PartnerRows& partner, int y, Range columns, float* work, float* cells) const {
    if (without_partner_ && !partner.has_row(y)) {
      for (int j = 0; j < columns.size(); ++j, cells += lanes_) {
        std::fill(cells, cells + count_, *without_partner_);
        std::fill(cells + count_, cells + lanes_, 0.0F);
      }
      return;
    }
    if (meaning_ == CellMeaning::kEnergy) {
      energies(partner, y, columns, work, cells);
    } else {
      likelihoods(partner, y, columns, work, cells);
    }
    fill_without_partner(partner, columns, cells);
  }

  void energies(const PartnerRows& partner, int y, Range columns, float* work, float* cells) const {
    switch (parameters_.cost) {
      case MatchCost::kSquared:
        kernels::squared_row(partner.grey_levels(y, columns, work), cells);
        break;
      case MatchCost::kAbsolute:
        kernels::absolute_row(partner.grey_levels(y, columns, work),
                              std::numeric_limits<float>::infinity(), cells);
        break;
      case MatchCost::kTruncated:
        kernels::absolute_row(partner.grey_levels(y, columns, work),
                              static_cast<float>(parameters_.truncation), cells);
        break;
      case MatchCost::kContaminated:
        kernels::contaminated_energy_row(partner.grey_levels(y, columns, work), measurement_,
                                         cells);
        break;
      case MatchCost::kBirchfieldTomasi:
        kernels::sampling_insensitive_row(partner.features<3>(y, columns), cells);
        break;
      case MatchCost::kGradient:
        kernels::negated_evidence_row(partner.features<3>(y, columns),
                                      parameters_.norm == GradientNorm::kOctagon, cells);
        break;
      case MatchCost::kCensus:
        kernels::hamming_row(partner.codes(y, columns), cells);
        break;
      case MatchCost::kRayCensus:
        kernels::ray_hamming_row(partner.ray_codes(y, columns, parameters_.census_thresholds),
                                 cells);
        break;
      case MatchCost::kCombined:
        combine(partner, y, columns, cells);
        break;
    }
  }

  void likelihoods(const PartnerRows& partner, int y, Range columns, float* work,
                   float* cells) const {
    switch (parameters_.cost) {
      case MatchCost::kSquared:
        kernels::contaminated_likelihood_row(partner.grey_levels(y, columns, work), measurement_,
                                             cells);
        break;
      case MatchCost::kContaminated: {
        const kernels::GreyPairs levels = partner.grey_levels(y, columns, work);
        if (levels.channels == 1) {
          kernels::contaminated_likelihood_row(levels, measurement_, cells);
        } else {
          kernels::contaminated_energy_row(levels, measurement_, cells);
          kernels::likelihood_of_energies({columns.size(), lanes_, count_}, cells);
        }
        break;
      }
      case MatchCost::kGradient:
        energies(partner, y, columns, work, cells);
        kernels::likelihood_of_evidence({partner.geometry(), columns.begin, columns.size()},
                                        static_cast<float>(std::max(kernels::kLeastEvidenceSigma,
                                                                    parameters_.sigma_measurement)),
                                        measurement_.epsilon, cells);
        break;
      case MatchCost::kCombined:
        combine(partner, y, columns, cells);
        break;
      case MatchCost::kRayCensus:
        if (partner.channels() == 1) {
          kernels::ray_census_likelihood_row(
              partner.ray_codes(y, columns, parameters_.census_thresholds), likelihood_by_distance_,
              cells);
          break;
        }
        [[fallthrough]];
      default:
        energies(partner, y, columns, work, cells);
        kernels::likelihood_of_costs({columns.size(), lanes_, count_}, measurement_, cells);
        break;
    }
  }

  void combine(const PartnerRows& partner, int y, Range columns, float* cells) const {
    const kernels::CombinedModel& model =
        partner.channels() == 1 ? combined_of_luma_ : combined_of_channels_;
    kernels::CombinedRow row;
    row.levels = partner.fixed_levels(y, columns);
    if (model.has_census) {
      row.codes = partner.luma_codes(y, columns);
    }
    if (model.has_gradient) {
      row.gradients = partner.fixed_gradients(y, columns);
    }
    kernels::combined_row(row, model, combined_cells_, cells);
  }

  /// Only columns near the borders have such cells.
  void fill_without_partner(const PartnerRows& partner, Range columns, float* cells) const {
    if (!without_partner_) {
      return;
    }
    const auto fill = [&](int x) {
      const CandidateRange inside = partner.with_partner(x);
      float* column = cells + static_cast<std::size_t>(x - columns.begin) * lanes();
      std::fill(column, column + inside.begin, *without_partner_);
      std::fill(column + std::max(inside.begin, inside.end), column + count_, *without_partner_);
    };
    const CandidateRange inner = partner.columns_with_all_partners();
    int x = columns.begin;
    for (; x < std::min(columns.end, inner.begin); ++x) {
      fill(x);
    }
    for (x = std::max(x, inner.end); x < columns.end; ++x) {
      fill(x);
    }
  }

  MethodParameters parameters_;
  kernels::ContaminatedGaussian measurement_;
  int lanes_;
  int count_;
  std::vector<PartnerRows> partners_;
  CellMeaning meaning_;
  kernels::CombinedCells combined_cells_;
  kernels::CombinedModel combined_of_luma_;
  kernels::CombinedModel combined_of_channels_;
  kernels::LikelihoodByDistance likelihood_by_distance_;
  std::optional<float> without_partner_;
};

/// The name of a cost that looks at more than grey levels, which can be interpolated; else empty.
std::string_view cost_of_whole_pixels(MatchCost cost) {
  switch (cost) {
    case MatchCost::kBirchfieldTomasi:
      return "birchfield-tomasi";
    case MatchCost::kGradient:
      return "gradient";
    case MatchCost::kCensus:
      return "census";
    case MatchCost::kRayCensus:
      return "census-rays";
    case MatchCost::kCombined:
      return "combined";
    default:
      return {};
  }
}

}  // namespace

std::unique_ptr<scheduler::RowStage> make_cost_stage(const MethodParameters& parameters,
                                                     const kernels::CandidateGeometry& geometry,
                                                     const CostImage& reference,
                                                     std::span<const CostPartner> partners,
                                                     CellMeaning meaning, int height) {
  std::vector<PartnerRows> rows;
  for (const CostPartner& partner : partners) {
    rows.emplace_back(reference, partner, geometry);
    const std::string_view cost = cost_of_whole_pixels(parameters.cost);
    if (rows.back().is_interpolated() && !cost.empty()) {
      throw UsageError(fmt::format(
          "cost {} cannot be interpolated between pixels, as several baselines need, expected "
          "squared, absolute, truncated or contaminated",
          cost));
    }
  }
  return std::make_unique<CostStage>(parameters, geometry, std::move(rows), meaning, height);
}

}  // namespace vantage
