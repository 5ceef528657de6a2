#pragma once

#include "engine/matching/costs/stage_cost.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_costs.h"

namespace vantage {
inline namespace test {

/// A photograph the reference is compared with, and where its camera stands.
struct PlainPartner {
  const Photograph* photograph = nullptr;
  double ratio = 1;
  int disparity_y_px = 0;
};

/// What stage_cost.h says a cell holds, in double, cell by cell, for any number of partners
/// anywhere.
class PlainCostCells {
 public:
  PlainCostCells(const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
                 const Photograph& reference, const std::vector<PlainPartner>& partners,
                 CellMeaning meaning)
      : parameters_(parameters),
        geometry_(geometry),
        meaning_(meaning),
        reference_(channels_of(reference, parameters.colour)),
        partners_(partners) {
    for (const PlainPartner& partner : partners) {
      Samples samples;
      samples.count = samples_per_px(partner.ratio);
      for (int k = 0; k < samples.count; ++k) {
        const double fraction = static_cast<double>(k) / samples.count;
        samples.channels.push_back(channels_of(*partner.photograph, parameters.colour, fraction));
      }
      samples_.push_back(samples);
    }
  }

  /// The smallest number at which all candidates are samples of the partner; 16 if it is larger.
  [[nodiscard]] int samples_per_px(double ratio) const {
    int samples = 1;
    const auto is_whole = [](double value) { return std::abs(value - std::round(value)) < 1e-9; };
    while (samples < 16 && !is_whole(ratio * samples / geometry_.steps_per_px)) {
      ++samples;
    }
    return samples;
  }

  /// Candidates of one column: of several partners the better half of those that see the candidate
  /// (all, if none does), as means of energies times the root of the number of partners.
  [[nodiscard]] std::vector<double> column(int x, int y) const {
    const bool is_energy = meaning_ == CellMeaning::kEnergy;
    std::vector<std::vector<double>> of_partners;
    for (std::size_t p = 0; p < partners_.size(); ++p) {
      of_partners.push_back(column(p, x, y));
    }
    if (partners_.size() == 1) {
      return of_partners.front();
    }
    std::vector<double> cells;
    for (int i = 0; i < geometry_.count; ++i) {
      std::vector<double> all;
      std::vector<double> seen;
      for (std::size_t p = 0; p < partners_.size(); ++p) {
        const double cell = of_partners[p][static_cast<std::size_t>(i)];
        all.push_back(is_energy ? cell : -std::log(cell));
        if (sees(p, x, y, i)) {
          seen.push_back(all.back());
        }
      }
      std::sort(seen.begin(), seen.end());
      seen.resize(std::min(seen.size(), (all.size() + 1) / 2));
      const std::vector<double>& used = seen.empty() ? all : seen;
      double sum = 0;
      for (const double energy : used) {
        sum += energy;
      }
      const double energy =
          sum / static_cast<double>(used.size()) * std::sqrt(static_cast<double>(partners_.size()));
      cells.push_back(is_energy ? energy : std::exp(-energy));
    }
    return cells;
  }

 private:
  struct Channel {
    Plane level;
    Gradient gradient;
  };

  /// A partner, resampled at every fraction of a pixel.
  struct Samples {
    int count = 1;
    std::vector<std::vector<Channel>> channels;
  };

  [[nodiscard]] std::vector<Channel> channels_of(const Photograph& photograph, ColourUse colour,
                                                 double fraction = 0) const {
    std::vector<Channel> channels;
    for (const Plane& whole : planes_of(photograph, colour)) {
      const Plane plane = resampled(whole, fraction);
      channels.push_back({plane, {}});
      if (parameters_.cost == MatchCost::kGradient) {
        channels.back().gradient = gradient_of(plane, parameters_.gradient, parameters_.prefilter);
      }
    }
    return channels;
  }

  /// Sample of candidate i in partner p.
  [[nodiscard]] int sample(std::size_t p, int x, int i) const {
    const double ratio = partners_[p].ratio;
    const double shift = (geometry_.disparity_min + i) * std::abs(ratio) * samples_[p].count /
                         geometry_.steps_per_px;
    const int sign = geometry_.direction * (ratio < 0 ? -1 : 1);
    return samples_[p].count * x + sign * static_cast<int>(std::floor(shift + 0.5));
  }
  [[nodiscard]] int last_sample(std::size_t p) const {
    return samples_[p].count * (geometry_.width - 1);
  }
  [[nodiscard]] bool sees(std::size_t p, int x, int y, int i) const {
    const int row = y + geometry_.direction * partners_[p].disparity_y_px;
    return sample(p, x, i) >= 0 && sample(p, x, i) <= last_sample(p) && row >= 0 &&
           row < reference_.front().level.height;
  }

  [[nodiscard]] std::vector<double> column(std::size_t p, int x, int y) const {
    const PlainPartner& partner = partners_[p];
    const bool is_energy = meaning_ == CellMeaning::kEnergy;
    const double epsilon = parameters_.epsilon_measurement;
    const int partner_y = y + geometry_.direction * partner.disparity_y_px;
    const int height = reference_.front().level.height;
    std::vector<double> energies;
    std::vector<bool> is_inside;
    double max_evidence = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < geometry_.count; ++i) {
      is_inside.push_back(sees(p, x, y, i));
      energies.push_back(mean_cost(p, x, y, std::clamp(sample(p, x, i), 0, last_sample(p)),
                                   std::clamp(partner_y, 0, height - 1)));
      if (is_inside.back()) {
        max_evidence = std::max(max_evidence, -energies.back());
      }
    }
    for (std::size_t i = 0; i < energies.size(); ++i) {
      double& cell = energies[i];
      if (!is_inside[i]) {
        cell = !is_energy                                     ? epsilon
               : parameters_.cost == MatchCost::kGradient     ? 0
               : parameters_.cost == MatchCost::kContaminated ? -std::log(epsilon)
                                                              : cell;
      } else if (!is_energy) {
        switch (parameters_.cost) {
          case MatchCost::kSquared:
            cell = measurement(cell);
            break;
          case MatchCost::kContaminated:
            cell = std::exp(-cell);
            break;
          case MatchCost::kGradient:
            cell =
                (1 - epsilon) * std::exp((-cell - max_evidence) / parameters_.sigma_measurement) +
                epsilon;
            break;
          default:
            cell = measurement(cell * cell);
        }
      }
    }
    return energies;
  }

  /// Of the channels; of likelihoods of grey levels the mean of the squares. `at`: a sample.
  [[nodiscard]] double mean_cost(std::size_t p, int x, int y, int at, int partner_y) const {
    const int whole = at / samples_[p].count;
    const auto phase = static_cast<std::size_t>(at % samples_[p].count);
    const std::vector<Channel>& partner = samples_[p].channels[phase];
    const std::size_t channels = std::max(reference_.size(), partner.size());
    double sum = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      sum += cost(reference_[std::min(c, reference_.size() - 1)], x, y,
                  partner[std::min(c, partner.size() - 1)], whole, partner_y);
    }
    return sum / static_cast<double>(channels);
  }

  /// Of windows of 9×7.
  [[nodiscard]] static double hamming(const Plane& a, int x, int y, const Plane& b, int partner,
                                      int partner_y) {
    int different = 0;
    for (int v = -3; v <= 3; ++v) {
      for (int u = -4; u <= 4; ++u) {
        different += (a.at(x + u, y + v) < a.at(x, y)) !=
                             (b.at(partner + u, partner_y + v) < b.at(partner, partner_y))
                         ? 1
                         : 0;
      }
    }
    return different;
  }

  /// Of neighbours on eight rays, the mean of the thresholds.
  [[nodiscard]] double ray_hamming(const Plane& a, int x, int y, const Plane& b, int partner,
                                   int partner_y) const {
    const double margins[] = {0, -1.2505, 1.2505};
    int different = 0;
    for (int t = 0; t < parameters_.census_thresholds; ++t) {
      const auto is_less = [&](const Plane& plane, int column, int row, int u, int v) {
        return plane.at(column + u, row + v) < plane.at(column, row) + margins[t];
      };
      const auto compare = [&](int u, int v) {
        different += is_less(a, x, y, u, v) != is_less(b, partner, partner_y, u, v) ? 1 : 0;
      };
      for (int k = 1; k <= 4; ++k) {
        compare(k, 0);
        compare(-k, 0);
        compare(0, k);
        compare(0, -k);
      }
      for (const int k : {-2, -1, 1, 2}) {
        compare(k, k);
        compare(k, -k);
      }
    }
    return static_cast<double>(different) / parameters_.census_thresholds;
  }

  [[nodiscard]] double cost(const Channel& a, int x, int y, const Channel& b, int whole,
                            int partner_y) const {
    const double level = b.level.at(whole, partner_y);
    const double difference = a.level.at(x, y) - level;
    switch (parameters_.cost) {
      case MatchCost::kSquared:
        return difference * difference;
      case MatchCost::kAbsolute:
        return std::abs(difference);
      case MatchCost::kTruncated:
        return std::min(std::abs(difference), parameters_.truncation);
      case MatchCost::kContaminated:
        return -std::log(measurement(difference * difference));
      case MatchCost::kBirchfieldTomasi:
        return std::min(distance(a.level.at(x, y), b.level, whole, partner_y),
                        distance(level, a.level, x, y));
      case MatchCost::kGradient: {
        const auto length = [&](double u, double v) { return length_of(u, v, parameters_); };
        const double ax = a.gradient.x.at(x, y);
        const double ay = a.gradient.y.at(x, y);
        const double bx = b.gradient.x.at(whole, partner_y);
        const double by = b.gradient.y.at(whole, partner_y);
        return parameters_.alpha * length(ax - bx, ay - by) - (length(ax, ay) + length(bx, by)) / 2;
      }
      case MatchCost::kCensus:
        return hamming(a.level, x, y, b.level, whole, partner_y);
      case MatchCost::kRayCensus:
        return ray_hamming(a.level, x, y, b.level, whole, partner_y);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// How far `value` is from what `plane` takes within half a pixel of (x, y).
  [[nodiscard]] static double distance(double value, const Plane& plane, int x, int y) {
    double min = std::numeric_limits<double>::infinity();
    double max = -min;
    for (const double u : {-.5, 0., .5}) {
      const int neighbour = u < 0 ? x - 1 : u > 0 ? x + 1 : x;
      const double at = (plane.at(x, y) + plane.at(neighbour, y)) / 2;
      min = std::min(min, at);
      max = std::max(max, at);
    }
    return std::max({0.0, value - max, min - value});
  }

  [[nodiscard]] double measurement(double squared_residual) const {
    const double sigma = parameters_.sigma_measurement;
    const double epsilon = parameters_.epsilon_measurement;
    return (1 - epsilon) * std::exp(-squared_residual / (2 * sigma * sigma)) + epsilon;
  }

  MethodParameters parameters_;
  kernels::CandidateGeometry geometry_;
  CellMeaning meaning_;
  std::vector<Channel> reference_;
  std::vector<PlainPartner> partners_;
  std::vector<Samples> samples_;
};

}  // namespace test
}  // namespace vantage
