// The figures of profiles against the kernels' steps in numbers that count what is done to them.
#include "kernels/kernel_work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "kernels/cells/exp_log.h"

namespace vantage::kernels {
namespace kernel_work_test {

/// A number; everything that counts as an operation is counted.
class Counted {
 public:
  Counted(double value = 0) : value_(value) {}  // NOLINT(google-explicit-constructor): constants
  [[nodiscard]] double value() const { return value_; }
  /// How many operations `work` does.
  static double operations_of(const std::function<void()>& work) {
    operations_ = 0;
    work();
    return operations_;
  }

  friend Counted operator+(Counted a, Counted b) { return counted(a.value_ + b.value_); }
  friend Counted operator-(Counted a, Counted b) { return counted(a.value_ - b.value_); }
  friend Counted operator*(Counted a, Counted b) { return counted(a.value_ * b.value_); }
  friend Counted operator/(Counted a, Counted b) { return counted(a.value_ / b.value_); }
  friend bool operator==(Counted a, Counted b) { return counted(a.value_ - b.value_).value_ == 0; }
  friend bool operator>(Counted a, Counted b) { return counted(a.value_ - b.value_).value_ > 0; }
  friend Counted least(Counted a, Counted b) { return counted(std::min(a.value_, b.value_)); }
  friend Counted most(Counted a, Counted b) { return counted(std::max(a.value_, b.value_)); }
  friend Counted root(Counted a) { return counted(std::sqrt(a.value_)); }
  /// A sign is no operation.
  friend Counted magnitude(Counted a) { return std::abs(a.value_); }

 private:
  static Counted counted(double value) {
    ++operations_;
    return value;
  }
  double value_;
  static inline double operations_ = 0;
};

using Cells = std::vector<Counted>;

Counted square(Counted v) { return v * v; }

Counted line(const float* polynomial, int k, Counted f) {
  return Counted(polynomial[k]) + Counted(polynomial[k + 1]) * f;
}

Counted power_of_two(Counted exponent) {
  exponent = most(exponent, kLeastExponent);
  const Counted shifted = exponent + 0;  // the rounding constant: added and subtracted
  const Counted whole = std::round((shifted - 0).value());
  const Counted f = exponent - whole;
  const Counted f2 = f * f;
  const Counted sum = line(kExp2Polynomial, 0, f) + line(kExp2Polynomial, 2, f) * f2 +
                      Counted(kExp2Polynomial[4]) * (f2 * f2);
  const Counted power = sum * f + 1;
  return std::ldexp(power.value(), static_cast<int>((whole + 0).value()));  // added to the exponent
}

Counted logarithm(Counted x) {
  int exponent = 0;
  double significand = std::frexp((x - 0).value(), &exponent);  // √½ is subtracted from the bits
  if (significand < std::sqrt(0.5)) {
    significand *= 2;
    --exponent;
  }
  const Counted f = (Counted(significand) - 0) - 1;  // the exponent is subtracted from the bits
  const Counted f2 = f * f;
  const Counted low = line(kLogPolynomial, 0, f) + line(kLogPolynomial, 2, f) * f2;
  const Counted high = line(kLogPolynomial, 4, f) + Counted(kLogPolynomial[6]) * f2;
  const Counted tail = (low + high * (f2 * f2)) * f * f2 - Counted(0.5) * f2;
  return Counted(exponent) * kLn2 + (tail + f);
}

Counted fused_power_of_two(Counted exponent) {
  const Counted shifted = exponent + 0;
  const Counted f = exponent - (shifted - 0);
  const Counted low = Counted(0.69) + Counted(0.24) * f;
  const Counted high = Counted(0.056) + Counted(0.0096) * f;
  const Counted power = (low + high * (f * f)) * f + 1;
  return power + 0;  // to the exponent
}

Counted scaled_logarithm(Counted x) {
  const Counted exponent = x - 0;        // √½ is subtracted from the bits
  const Counted f = (x - exponent) - 1;  // and the exponent's
  const Counted f2 = f * f;
  const auto line = [&f](double a, double b) { return Counted(a) + Counted(b) * f; };
  const Counted low = line(0.48, -0.36) * f2 + line(1.44, -0.72);
  const Counted high = Counted(0.17) * f2 + line(0.3, -0.27);
  return (low + high * (f2 * f2)) * f + exponent * Counted(0.3);
}

using Lanes = std::array<Counted, kLaneMultiple>;

template <class Operation>
Counted joined_lanes(const Lanes& lanes, Operation operation) {
  Counted result = lanes.front();
  for (std::size_t lane = 1; lane < lanes.size(); ++lane) {
    result = operation(result, lanes[lane]);
  }
  return result;
}

/// As sixteen partial results, then a tree over them.
template <class Operation>
Counted joined(const Cells& cells, double neutral, Operation operation) {
  Lanes lanes;
  lanes.fill(neutral);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    lanes[i % kLaneMultiple] = operation(lanes[i % kLaneMultiple], cells[i]);
  }
  return joined_lanes(lanes, operation);
}
Counted least_of_two(Counted a, Counted b) { return least(a, b); }
Counted sum_of(const Cells& cells) { return joined(cells, 0, std::plus<>()); }
Counted least_of(const Cells& cells) { return joined(cells, 1e9, least_of_two); }

constexpr int kCount = 64;

Cells made_up_cells(int seed) {
  Cells cells;
  for (int i = 0; i < kCount; ++i) {
    cells.emplace_back(0.1 + (i * 37 + seed * 11) % 101 / 110.0);
  }
  return cells;
}

/// One column of a star.
struct Star {
  Cells centre = made_up_cells(1);
  Cells left = made_up_cells(2);
  Cells right = made_up_cells(3);
  Cells up = made_up_cells(4);
  Cells down = made_up_cells(5);
  Cells source = made_up_cells(6);
};

/// Of a column, to one in a hundred and a few: what is done once in a column need not be exact.
void expect_work(const KernelWork& expected, const std::function<void()>& column) {
  const double operations = expected.operations * kCount + expected.operations_per_column;
  EXPECT_NEAR(Counted::operations_of(column), operations, 0.01 * operations + 10);
}

/// The same of work on single cells, exactly.
void expect_cell_work(const KernelWork& expected, const std::function<void()>& cell) {
  EXPECT_EQ(Counted::operations_of(cell), expected.operations);
  EXPECT_EQ(expected.operations_per_column, 0);
}

TEST(KernelWork, OfExponentialsAndLogarithms) {
  EXPECT_EQ(Counted::operations_of(
                [] { EXPECT_NEAR(power_of_two(-3.7).value(), std::exp2(-3.7), 1e-6); }),
            kExp2Operations);
  EXPECT_EQ(
      Counted::operations_of([] { EXPECT_NEAR(logarithm(0.3).value(), std::log(0.3), 1e-6); }),
      kLogOperations);
}

TEST(KernelWork, OfCosts) {
  const Counted a = 17;
  const Counted b = 23.5;
  const auto distance = [](Counted value, Counted low, Counted high) {
    return most(most(value - high, low - value), 0);
  };
  const auto sampled = [&] { return least(distance(a, b, b), distance(b, a, a)); };
  const auto measured = [](Counted squared_residual) {
    return Counted(0.9) * power_of_two(Counted(-0.01) * squared_residual) + 0.1;
  };
  const Counted difference = a - b;
  expect_cell_work(squared_work(1), [&] { square(a - b); });
  expect_cell_work(squared_work(3),
                   [&] { (square(a - b) + square(a - b) + square(a - b)) * Counted(1. / 3); });
  expect_cell_work(absolute_work(1), [&] { least(magnitude(a - b), 20); });
  expect_cell_work(sampling_insensitive_work(1), [&] { sampled(); });
  expect_cell_work(sampling_insensitive_work(3),
                   [&] { (sampled() + sampled() + sampled()) * Counted(1. / 3); });
  expect_cell_work(contaminated_energy_work(1),
                   [&] { Counted(0) - logarithm(measured(square(a - b))); });
  expect_cell_work(contaminated_likelihood_work(1), [&] { measured(square(a - b)); });
  expect_cell_work(negated_evidence_work(false, 1),
                   [&] { root(square(a - b) + square(b - a)) - (a + b); });
  expect_cell_work(negated_evidence_work(true, 1), [&] {
    const Counted x = magnitude(a - b);
    const Counted y = magnitude(b - a);
    Counted(0.4) * (x + y) + Counted(0.56) * most(x, y) - (a + b);
  });
  const auto bounded = [&] { return least(most(a - b, b - a), most(b - a, a - b)); };
  const auto step = [](Counted residual) { return least(residual * 0.1, 63); };
  const auto to_float = [](Counted value) { (value - 0) * Counted(1. / 512); };
  expect_cell_work(combined_work(1, false, false), [&] { to_float(step(bounded())); });
  const auto gradient = [&] { return step(((a - b) + (b - a)) + ((a - b) + (b - a))); };
  expect_cell_work(combined_work(3, false, true),
                   [&] { to_float(step(bounded() + bounded() + bounded()) + gradient()); });
  const KernelWork hamming = hamming_work(1);
  EXPECT_EQ(combined_work(1, true, false).operations,
            combined_work(1, false, false).operations + hamming.operations + 1);
  expect_cell_work(kLikelihoodOfCostsWork, [&] { measured(difference * difference); });
  expect_cell_work(kLikelihoodOfEnergiesWork, [&] { power_of_two(a * Counted(-kLog2E)); });
}

TEST(KernelWork, OfLikelihoodsOfEvidence) {
  expect_work(kLikelihoodOfEvidenceWork, [] {
    Cells cells = made_up_cells(1);
    const Counted best = least_of(cells);
    for (Counted& cell : cells) {
      cell = Counted(0.9) * power_of_two((best - cell) * 0.3) + 0.1;
    }
  });
}

TEST(KernelWork, OfPriors) {
  const auto share = [](int lane) {
    const Counted k = ((Counted(lane) + 0) - 3.5) * 0.5;
    return least(k * k, 1);
  };
  expect_work(kEnergiesWithPriorWork, [&] {
    Cells cells = made_up_cells(1);
    const Counted scale = (sum_of(cells) / kCount - least_of(cells)) * 0.5;
    for (int i = 0; i < kCount; ++i) {
      Counted& cell = cells[static_cast<std::size_t>(i)];
      cell = cell + scale * share(i);
    }
  });
  expect_work(kLikelihoodsWithPriorWork, [&] {
    Cells cells = made_up_cells(1);
    for (int i = 0; i < kCount; ++i) {
      Counted& cell = cells[static_cast<std::size_t>(i)];
      cell = cell * power_of_two(Counted(-1.4) * share(i));
    }
  });
}

TEST(KernelWork, OfBoxSums) {
  const auto rounded_square = [](Counted a, Counted b) { return square(a - b) + 0; };
  const auto rounded_cost = [](Counted cost) { return (cost + 5) * 64 + 0; };
  const Counted sum = 1000;
  expect_cell_work(kColumnSsdFloatWork,
                   [&] { sum + (rounded_square(3, 1) - rounded_square(2, 9)); });
  expect_cell_work(kColumnSumWork, [&] { sum + (rounded_cost(3) - rounded_cost(2)); });
  // Of (entering, leaving): the squares are sums of products with (difference, −difference).
  expect_cell_work(kColumnSsdPairsWork, [&] {
    const Counted entering = Counted(3) - 1;
    const Counted leaving = Counted(2) - 9;
    sum + (entering * (entering * 1) + leaving * (leaving * -1));
  });
  expect_work(row_sum_work(true), [] {
    Cells sums = made_up_cells(1);
    const Cells entering = made_up_cells(2);
    const Cells leaving = made_up_cells(3);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] = sums[i] + entering[i] - leaving[i];
    }
    least_of(sums);
  });
}

Counted symmetric_sum_of_ones(int radius) {
  Counted sum = Counted(1) * 1;
  for (int k = 1; k <= radius; ++k) {
    sum = sum + Counted(1) * (Counted(1) + 1);
  }
  return sum;
}

TEST(KernelWork, OfConvolutions) {
  for (const int radius : {0, 1, 8}) {
    expect_cell_work(symmetric_sum_work(radius),
                     [&] { EXPECT_EQ(symmetric_sum_of_ones(radius).value(), 2 * radius + 1); });
  }
}

TEST(KernelWork, OfTheBoxCascade) {
  struct BoxOfThree {
    Counted before = 1;
    Counted two = 2;
    Counted add(Counted cell) {
      const Counted three = two + cell;
      two = before + cell;
      before = cell;
      return three;
    }
  };
  expect_cell_work(kBoxCascadeWork, [] {
    const Counted down = symmetric_sum_of_ones(BoxCascade::kRadius);
    const Counted third = BoxOfThree().add(BoxOfThree().add(BoxOfThree().add(down)));
    const Counted two = third + 1;
    const Counted five = two + 1;
    const Counted three_for_later = two + 1;
    EXPECT_GT((five * 0.1).value(), three_for_later.value() * 0.1 - 1);
  });
}

Counted diffused(const Star& star, std::size_t i) {
  const Counted neighbours = (star.left[i] + star.right[i]) + (star.up[i] + star.down[i]);
  return Counted(0.4) * star.centre[i] + Counted(0.15) * neighbours;
}

TEST(KernelWork, OfDiffusion) {
  const Star star;
  expect_cell_work(kDiffusionWork, [&] { diffused(star, 0); });
  expect_cell_work(kMembraneWork, [&] { diffused(star, 0) + Counted(0.05) * star.source[0]; });
}

/// The two least and the sum, lane by lane and then over the lanes.
Counted margin_of(const Cells& cells) {
  Lanes least_of_lane;
  Lanes second_of_lane;
  least_of_lane.fill(1e9);
  second_of_lane.fill(1e9);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Counted& first = least_of_lane[i % kLaneMultiple];
    Counted& second = second_of_lane[i % kLaneMultiple];
    second = least(second, most(first, cells[i]));
    first = least(first, cells[i]);
  }
  const Counted best = joined_lanes(least_of_lane, least_of_two);
  Lanes others;
  Lanes ties;
  for (std::size_t lane = 0; lane < kLaneMultiple; ++lane) {
    const bool is_best = least_of_lane[lane] == best;
    ties[lane] = is_best ? 1 : 0;
    others[lane] = least(is_best ? Counted(1e9) : least_of_lane[lane], second_of_lane[lane]);
  }
  const Counted next = joined_lanes(others, least_of_two);
  const Counted second = joined_lanes(ties, std::plus<>()) > 1.5 ? best : next;
  const Counted total = sum_of(cells);
  return total == 0 ? Counted(0) : (second - best) / total;
}

Counted entropy_of(const Cells& cells) {
  const Counted best = least_of(cells);
  Cells weights;
  Cells moments;
  for (const Counted& cell : cells) {
    const Counted exponent = least(Counted(3) * (cell - best), 125);
    weights.push_back(power_of_two(-exponent.value()));
    moments.push_back(weights.back() * exponent);
  }
  const Counted total = sum_of(weights);
  return sum_of(moments) / total * kLn2 + logarithm(total);
}

TEST(KernelWork, OfLocalStopping) {
  const Star star;
  const auto step = [&](bool is_first, Counted (*certainty)(const Cells&)) {
    Cells cells;
    for (std::size_t i = 0; i < kCount; ++i) {
      cells.push_back(diffused(star, i));
    }
    const Counted before = is_first ? certainty(star.centre) : Counted(0.1);
    return before > certainty(cells);
  };
  for (const bool is_first : {false, true}) {
    expect_work(local_stopping_work(CertaintyMeasure::kMargin, !is_first, true),
                [&] { step(is_first, margin_of); });
    expect_work(local_stopping_work(CertaintyMeasure::kEntropy, !is_first, true),
                [&] { step(is_first, entropy_of); });
  }
}

/// What becomes of unnormalised probabilities of a column.
Cells bayes_state_of(const Cells& p, BayesState state, int prior_radius) {
  const Counted factor = Counted(1) / sum_of(p);
  Cells result;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (state == BayesState::kProbability) {
      result.push_back(p[i] * factor);
      continue;
    }
    Counted smoothed = p[i] * 0.9;
    for (int k = 1; k <= prior_radius; ++k) {
      smoothed = smoothed + Counted(0.01) * (p[i] + p[(i + 1) % p.size()]);
    }
    smoothed = smoothed * factor + 0.01;
    result.push_back(state == BayesState::kSmoothed ? smoothed : scaled_logarithm(smoothed));
  }
  return result;
}

TEST(KernelWork, OfBayesianDiffusion) {
  const Star star;
  const auto half = [&] {
    Cells p;
    for (std::size_t i = 0; i < kCount; ++i) {
      const Counted product =
          (star.up[i] * star.down[i]) * (star.left[i] * star.right[i]) * star.centre[i];
      const Counted estimate = 1 / root(product).value();  // one instruction
      const Counted newton = product * estimate;
      p.push_back(star.source[i] * newton * (Counted(3) - newton * estimate));
      EXPECT_NEAR(p.back().value(), 2 * star.source[i].value() * std::sqrt(product.value()), 1e-9);
    }
    return p;
  };
  const auto general = [&](bool scaled, bool weighted) {
    const auto sum = [&](std::size_t i) {
      if (weighted) {
        const Counted weight = 0.5;
        return star.up[i] * weight + star.down[i] * weight +
               (star.left[i] * weight + star.right[i] * weight) + star.centre[i];
      }
      return star.up[i] + star.down[i] + (star.left[i] + star.right[i]) + star.centre[i];
    };
    Counted largest = -1e9;
    for (std::size_t i = 0; scaled && i < kCount; ++i) {
      largest = most(largest, sum(i));
    }
    Cells p;
    for (std::size_t i = 0; i < kCount; ++i) {
      p.push_back(star.source[i] *
                  fused_power_of_two(scaled ? most(sum(i) - largest, kLeastExponent) : sum(i)));
    }
    return p;
  };
  for (const BayesState state :
       {BayesState::kSmoothed, BayesState::kLogSmoothed, BayesState::kProbability}) {
    for (const int radius : {0, 1, 3}) {
      expect_work(bayes_start_work(state, radius),
                  [&] { bayes_state_of(star.source, state, radius); });
      expect_work(bayes_half_work(state, radius), [&] { bayes_state_of(half(), state, radius); });
      for (const bool scaled : {false, true}) {
        for (const bool weighted : {false, true}) {
          expect_work(bayes_general_work(state, radius, scaled, weighted),
                      [&] { bayes_state_of(general(scaled, weighted), state, radius); });
        }
      }
    }
  }
}

/// Of fixed-point numbers, with its rounding.
Counted rounded_product(Counted a, Counted b) { return a * b + 0; }

/// What becomes of energies of a column.
void energy_state_of(const Cells& energies, bool smooths, int prior_radius) {
  const Counted lowest = least_of(energies);
  for (const Counted& energy : energies) {
    Counted result = energy;
    for (int k = 1; smooths && k <= prior_radius; ++k) {
      result = least(result, least(energies.front(), energies.back()) + 10);
    }
    result = result - lowest;
    if (smooths) {
      least(result, 100);
    }
  }
}

TEST(KernelWork, OfMaxProductDiffusion) {
  const Star star;
  for (const int radius : {0, 1, 3}) {
    expect_work(max_product_start_work(radius),
                [&] { energy_state_of(star.source, true, radius); });
    for (const bool smooths : {false, true}) {
      for (const bool weighted : {false, true}) {
        // Without weights of their own all neighbours have μ.
        expect_work(max_product_work(radius, smooths, weighted), [&] {
          Cells energies;
          for (std::size_t i = 0; i < kCount; ++i) {
            const auto part = [i](const Cells& cells) { return rounded_product(cells[i], 0.5); };
            energies.push_back((part(star.up) + part(star.down)) +
                               (part(star.left) + part(star.right)) + part(star.centre) +
                               star.source[i]);
          }
          energy_state_of(energies, smooths, radius);
        });
      }
    }
    // One column is made for four.
    const KernelWork shared = max_product_start_from_coarser_work(radius);
    const KernelWork own{4 * shared.operations, 4 * shared.operations_per_column};
    expect_work(own, [&] {
      Cells energies;
      for (std::size_t i = 0; i < kCount; ++i) {
        energies.push_back(rounded_product(7, 0.5));
      }
      energy_state_of(energies, true, radius);
    });
  }
}

TEST(KernelWork, OfFixedEnergies) {
  expect_cell_work(kFixedEnergiesOfBytesWork, [] { rounded_product(7, 0.5); });
  expect_cell_work(kBytesOfFixedEnergiesWork, [] { rounded_product(7, 0.5); });
  expect_cell_work(kFixedEnergiesOfLikelihoodsWork,
                   [] { most(logarithm(most(Counted(0.2), 1e-14)) * Counted(-256), 0); });
}

TEST(KernelWork, OfLikelihoodsOfLevels) {
  const Star star;
  expect_work(kReduceLikelihoodsWork, [&] {
    Cells logs;
    for (std::size_t i = 0; i < kCount; ++i) {
      const Counted upper = most(star.up[i], 1e-9) * most(star.left[i], 1e-9);
      const Counted lower = most(star.down[i], 1e-9) * most(star.right[i], 1e-9);
      logs.push_back(logarithm(upper * lower));
    }
    const Counted top = joined(logs, -1e9, [](Counted a, Counted b) { return most(a, b); });
    for (const Counted& log : logs) {
      least((top - log) * 8, 255);
    }
  });
  expect_cell_work(kExpandCompactWork, [] { power_of_two(Counted(7) * -0.125); });
  expect_cell_work(kCompactProbabilitiesWork, [] {
    least(most(logarithm(most(Counted(0.2), 1e-9)) * Counted(-11.5), 0), 255);
  });
  // One column is made for four.
  for (const BayesState state : {BayesState::kSmoothed, BayesState::kProbability}) {
    const KernelWork shared = bayes_start_from_coarser_work(state, 1);
    const KernelWork own{4 * shared.operations, 4 * shared.operations_per_column};
    expect_work(own, [&] {
      Cells p;
      for (std::size_t i = 0; i < kCount; ++i) {
        p.push_back(power_of_two(Counted(-7) * 0.125));
      }
      bayes_state_of(p, state, 1);
    });
  }
}

TEST(KernelWork, OfEnergiesOfLevels) {
  const auto to_half = [](Counted energy) {
    return least(magnitude(energy), 65504) * Counted(0x1p-112) + 1 + 4095;
  };
  const auto of_half = [](Counted half) { return half * Counted(0x1p112); };
  const Counted a = 3;
  expect_cell_work(kReduceEnergiesWork, [&] { to_half(((a + a) + (a + a)) * 0.25); });
  expect_cell_work(kHalfEnergiesWork, [&] { to_half(a * 0.5); });
  expect_cell_work(kExpandHalfWork, [&] { of_half(a) * Counted(2); });
  expect_cell_work(kCoarserSupportWork, [&] { Counted(0.5) * (a + of_half(a) * Counted(2)); });
}

TEST(KernelWork, OfSelections) {
  const Cells cells = made_up_cells(1);
  const auto place = [&](Counted best) {
    Lanes places;
    places.fill(1e9);
    for (std::size_t i = cells.size(); i-- > 0;) {
      places[i % kLaneMultiple] =
          cells[i] == best ? Counted(static_cast<double>(i)) : places[i % kLaneMultiple];
    }
    return joined_lanes(places, least_of_two);
  };
  expect_work(cell_winner_work(false, false), [&] { least_of(cells); });
  expect_work(cell_winner_work(true, false), [&] { place(least_of(cells)); });
  expect_work(energy_winner_work(), [&] {
    const Counted best = least_of(cells);
    Lanes places;
    places.fill(1e9);
    Counted number = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      Counted& first = places[i % kLaneMultiple];
      first = least(first, cells[i] == best ? number : Counted(1e9));
      number = number + 1;
    }
    joined_lanes(places, least_of_two);
  });
  expect_work(kEnergyProbabilityWork, [&] {
    const auto likelihood = [](Counted energy) { return power_of_two(energy * Counted(-0.01)); };
    Cells likelihoods;
    for (const Counted& energy : cells) {
      likelihoods.push_back(likelihood(energy));
    }
    likelihood(3) / sum_of(likelihoods);
  });
  // The entropy is told the least cell.
  expect_work(cell_winner_work(false, false) + kCellEntropyWork, [&] { entropy_of(cells); });
}

}  // namespace kernel_work_test
}  // namespace vantage::kernels
