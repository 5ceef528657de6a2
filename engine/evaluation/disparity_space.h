#pragma once

#include <vector>

#include "engine/execution.h"
#include "engine/generation/book_pairs.h"
#include "engine/image/volume_sink.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/volume/volume_request.h"

namespace vantage {

/// A volume in memory: (x, y, d), NaN where a candidate has no partner.
class DisparitySpace {
 public:
  /// All NaN.
  explicit DisparitySpace(const VolumeShape& shape);

  [[nodiscard]] const VolumeShape& shape() const { return shape_; }
  /// d within shape().disparities; candidates of a pixel are contiguous.
  [[nodiscard]] float& at(int x, int y, int d) { return values_[index(x, y, d)]; }
  [[nodiscard]] float at(int x, int y, int d) const { return values_[index(x, y, d)]; }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int d) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(shape_.width_px) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(shape_.disparities.count()) +
           static_cast<std::size_t>(d - shape_.disparities.min);
  }

  VolumeShape shape_;
  std::vector<float> values_;
};

/// Costs or aggregated values of the pair's reference image, which is the left
/// one, with its search range. Throws UsageError for invalid options.
DisparitySpace disparity_space(const BookPair& pair, MatchOptions options, VolumeKind kind,
                               Execution& execution);

/// The values between the steps of one iteration of Bayesian diffusion in one
/// column (Fig. 6.12).
struct BayesSteps {
  std::vector<double> smoothed;         ///< pS (6.33)
  std::vector<double> smoothed_energy;  ///< ES (6.34)
  std::vector<double> energy;           ///< E (6.37)
  std::vector<double> probability;      ///< p (6.36)
};

/// One iteration at (x, y), which is not at the border and has a partner for
/// every candidate, from the probabilities before it and the costs −ln p0.
BayesSteps bayes_steps(const DisparitySpace& costs, const DisparitySpace& probabilities,
                       const MethodParameters& parameters, int x, int y);

}  // namespace vantage
