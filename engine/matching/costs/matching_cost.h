#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/costs/partner_rows.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/kernel_work.h"
#include "kernels/pixel_cost/pixel_cost.h"
#include "scheduler/range.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Bounds of energies.
struct CostBounds {
  float min = 0;
  float max = 0;
};

/// Columns of one row to compare with a partner.
struct CostRow {
  const PartnerRows& partner;
  int y = 0;
  scheduler::Range columns;
  GatherMemory* memory = nullptr;  ///< of partner.gather_bytes(); null if nothing is gathered

  /// `planes`: a member of the cost's own type of planes.
  template <typename Planes>
  [[nodiscard]] auto pairs(Planes planes) const {
    return partner.pairs(y, columns, memory, planes);
  }
};

/// A cost with its parameters. The cost stage calls it once per row or block of columns. Energies
/// are small for similar pixels, in the cost's own unit, averaged over colour channels. Likelihoods
/// are p0 up to a factor per column, in (0, 1] (6.25). Thread rule: immutable.
class CostModel {
 public:
  explicit CostModel(const MethodParameters& parameters);
  CostModel(const CostModel&) = delete;
  CostModel& operator=(const CostModel&) = delete;
  virtual ~CostModel() = default;

  /// Writes lanes of floats for each column. Lanes beyond the candidates are finite.
  virtual void energies(const CostRow& row, float* cells) const = 0;
  /// Lanes beyond the candidates are 0. Unless overridden: the measurement model (6.26 ff.) with
  /// the energy as residual.
  virtual void likelihoods(const CostRow& row, float* cells) const;

  /// Energy of cells whose partner is outside; empty: the cost of the border.
  [[nodiscard]] virtual std::optional<float> energy_without_partner() const { return {}; }
  [[nodiscard]] virtual float likelihood_without_partner() const;

  /// For intensities of 0..255 and one partner.
  [[nodiscard]] virtual CostBounds energy_bounds() const = 0;

  /// Work of energies() and likelihoods() per column.
  [[nodiscard]] virtual kernels::KernelWork energy_work(int channels) const = 0;
  [[nodiscard]] virtual kernels::KernelWork likelihood_work(int channels) const;

 protected:
  static constexpr double kWhite = 255;  ///< maximum intensity

  [[nodiscard]] const MethodParameters& parameters() const { return parameters_; }
  [[nodiscard]] const kernels::ContaminatedGaussian& measurement() const { return measurement_; }

 private:
  MethodParameters parameters_;
  kernels::ContaminatedGaussian measurement_;
};

/// Energies −ln p0 in bytes, for costs with few values: luma, one partner, the map's own baseline.
struct ByteEnergies {
  float (*nats_per_step)(const MethodParameters& parameters) = nullptr;
  std::unique_ptr<scheduler::RowStage> (*make_stage)(const MethodParameters& parameters,
                                                     const kernels::CandidateGeometry& geometry,
                                                     const CostImage& reference,
                                                     const CostPartner& partner,
                                                     int height) = nullptr;
  /// Energy of candidates without a partner, in steps.
  std::uint8_t (*without_partner)(const MethodParameters& parameters) = nullptr;
};

/// A matching cost: everything known about it outside its own file.
struct MatchingCost {
  MatchCost key = MatchCost::kSquared;
  std::string_view name;         ///< in options, messages and tuning keys
  std::string_view description;  ///< one line of help
  /// Options that affect its energies.
  std::vector<std::string_view> options;

  /// Energies are −evidence: of either sign, compared with 0, without a scale of their own;
  /// likelihoods compare each candidate with the best one.
  bool is_evidence = false;
  /// Box sums of luma have their own stage (stage_column_ssd).
  bool has_column_sums = false;
  /// Maximum contrast of a column of energies that a disparity prior uses as scale.
  float max_contrast = std::numeric_limits<float>::infinity();
  /// Default of jump-limit for aggregated energies, in the cost's unit.
  double jump_limit = 0;
  /// Default of occlusion-penalty, likewise.
  double occlusion_penalty = 0;

  std::unique_ptr<CostPlanes> (*make_planes)() = nullptr;
  std::unique_ptr<CostModel> (*make_model)(const MethodParameters& parameters) = nullptr;
  std::optional<ByteEnergies> byte_energies = {};
  /// For tuning keys: what changes its amount of work, as ", 3 thresholds"; null: nothing.
  std::string (*work_class)(const MethodParameters& parameters) = nullptr;

  [[nodiscard]] bool reads(std::string_view option) const {
    return std::find(options.begin(), options.end(), option) != options.end();
  }
};

/// For MatchingCost::make_planes.
template <typename Planes>
std::unique_ptr<CostPlanes> make_planes_as() {
  return std::make_unique<Planes>();
}
/// For MatchingCost::make_model.
template <typename Model>
std::unique_ptr<CostModel> make_model_as(const MethodParameters& parameters) {
  return std::make_unique<Model>(parameters);
}

}  // namespace vantage
