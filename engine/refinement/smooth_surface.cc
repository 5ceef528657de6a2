#include "engine/refinement/smooth_surface.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace vantage {
namespace {

constexpr std::size_t kDirectUnknowns = 4096;
constexpr float kTension = 1e-3F;

/// Squared linear combination of up to four cells.
struct Term {
  std::array<std::int32_t, 4> unknown{};  ///< numbers of unknown cells; first `count`
  std::array<float, 4> coefficients{};
  int count = 0;
  float constant = 0;  ///< contribution of the known cells
  float weight = 1;
};

/// The sum of squared terms ½ Σ w (c·x + constant)², as a linear system.
class Energy {
 public:
  Energy(SurfaceEnergy kind, const RegionGrid& grid, float cell_px) : grid_(grid) {
    number_unknown();
    if (kind == SurfaceEnergy::kMembrane) {
      add_differences(1);
    } else {
      add_differences(kTension * cell_px * cell_px);
      add_second_differences();
    }
  }

  [[nodiscard]] std::size_t unknowns() const { return cells_.size(); }

  [[nodiscard]] Eigen::VectorXd estimate() const {
    Eigen::VectorXd x(static_cast<Eigen::Index>(cells_.size()));
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      x[static_cast<Eigen::Index>(i)] = static_cast<double>(grid_.values[cells_[i]]);
    }
    return x;
  }

  void store(const Eigen::VectorXd& x, RegionGrid& grid) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      grid.values[cells_[i]] = static_cast<float>(x[static_cast<Eigen::Index>(i)]);
    }
  }

  /// Matrix times x.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& product) const {
    accumulate(x, 0, product);
  }
  /// Gradient of the energy at x.
  void gradient(const Eigen::VectorXd& x, Eigen::VectorXd& result) const {
    accumulate(x, 1, result);
  }

  [[nodiscard]] Eigen::VectorXd diagonal() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells_.size()));
    for (const Term& term : terms_) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(term.count); ++k) {
        result[term.unknown[k]] +=
            static_cast<double>(term.weight * term.coefficients[k] * term.coefficients[k]);
      }
    }
    return result;
  }

  [[nodiscard]] Eigen::SparseMatrix<double> matrix() const {
    std::vector<Eigen::Triplet<double, int>> entries;
    for (const Term& term : terms_) {
      for (std::size_t a = 0; a < static_cast<std::size_t>(term.count); ++a) {
        for (std::size_t b = 0; b < static_cast<std::size_t>(term.count); ++b) {
          entries.emplace_back(
              term.unknown[a], term.unknown[b],
              static_cast<double>(term.weight * term.coefficients[a] * term.coefficients[b]));
        }
      }
    }
    const auto size = static_cast<Eigen::Index>(cells_.size());
    Eigen::SparseMatrix<double> result(size, size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

 private:
  void number_unknown() {
    numbers_.assign(grid_.size(), -1);
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      if (grid_.states[i] == RegionGrid::kUnknown) {
        numbers_[i] = static_cast<std::int32_t>(cells_.size());
        cells_.push_back(i);
      }
    }
  }

  /// Adds a term if none of its cells is absent and one is unknown.
  template <std::size_t N>
  void add(float weight, const std::array<std::size_t, N>& cells,
           const std::array<float, N>& coefficients) {
    Term term;
    term.weight = weight;
    for (std::size_t k = 0; k < N; ++k) {
      const std::size_t i = cells[k];
      if (grid_.states[i] == RegionGrid::kAbsent) {
        return;
      }
      if (grid_.states[i] == RegionGrid::kKnown) {
        term.constant += coefficients[k] * grid_.values[i];
        continue;
      }
      const auto next = static_cast<std::size_t>(term.count++);
      term.unknown[next] = numbers_[i];
      term.coefficients[next] = coefficients[k];
    }
    if (term.count > 0) {
      terms_.push_back(term);
    }
  }

  void add_differences(float weight) {
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) {
        const std::size_t i = grid_.index(x, y);
        if (x + 1 < grid_.width) {
          add<2>(weight, {i, grid_.index(x + 1, y)}, {1, -1});
        }
        if (y + 1 < grid_.height) {
          add<2>(weight, {i, grid_.index(x, y + 1)}, {1, -1});
        }
      }
    }
  }

  void add_second_differences() {
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) {
        const std::size_t i = grid_.index(x, y);
        if (x + 2 < grid_.width) {
          add<3>(1, {i, grid_.index(x + 1, y), grid_.index(x + 2, y)}, {1, -2, 1});
        }
        if (y + 2 < grid_.height) {
          add<3>(1, {i, grid_.index(x, y + 1), grid_.index(x, y + 2)}, {1, -2, 1});
        }
        if (x + 1 < grid_.width && y + 1 < grid_.height) {
          add<4>(2, {i, grid_.index(x + 1, y), grid_.index(x, y + 1), grid_.index(x + 1, y + 1)},
                 {1, -1, -1, 1});
        }
      }
    }
  }

  void accumulate(const Eigen::VectorXd& x, double of_constants, Eigen::VectorXd& result) const {
    result.setZero(x.size());
    for (const Term& term : terms_) {
      double value = of_constants * static_cast<double>(term.constant);
      for (std::size_t k = 0; k < static_cast<std::size_t>(term.count); ++k) {
        value += static_cast<double>(term.coefficients[k]) * x[term.unknown[k]];
      }
      value *= static_cast<double>(term.weight);
      for (std::size_t k = 0; k < static_cast<std::size_t>(term.count); ++k) {
        result[term.unknown[k]] += static_cast<double>(term.coefficients[k]) * value;
      }
    }
  }

  const RegionGrid& grid_;
  std::vector<std::int32_t> numbers_;
  std::vector<std::size_t> cells_;
  std::vector<Term> terms_;
};

void solve_directly(const Energy& energy, Eigen::VectorXd& x) {
  Eigen::VectorXd gradient;
  energy.gradient(Eigen::VectorXd::Zero(x.size()), gradient);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(energy.matrix());
  x = solver.solve(-gradient);
}

/// Conjugate gradients from x, preconditioned by the diagonal.
void improve(const Energy& energy, int iterations, Eigen::VectorXd& x) {
  const Eigen::VectorXd inverse = energy.diagonal().cwiseInverse();
  Eigen::VectorXd residual;
  energy.gradient(x, residual);
  residual = -residual;
  Eigen::VectorXd scaled = residual.cwiseProduct(inverse);
  Eigen::VectorXd direction = scaled;
  Eigen::VectorXd product;
  double rho = residual.dot(scaled);
  const double negligible = 1e-12 * static_cast<double>(x.size());
  for (int k = 0; k < iterations && rho > negligible; ++k) {
    energy.multiply(direction, product);
    const double step = rho / direction.dot(product);
    x += step * direction;
    residual -= step * product;
    scaled = residual.cwiseProduct(inverse);
    const double next = residual.dot(scaled);
    direction = scaled + next / rho * direction;
    rho = next;
  }
}

void solve_at(SurfaceEnergy kind, float cell_px, RegionGrid& grid) {
  const auto unknown = static_cast<std::size_t>(
      std::count(grid.states.begin(), grid.states.end(), RegionGrid::kUnknown));
  if (unknown == 0) {
    return;
  }
  const bool is_direct = unknown <= kDirectUnknowns;
  if (!is_direct) {
    RegionGrid coarse = halved(grid);
    solve_at(kind, 2 * cell_px, coarse);
    interpolate_unknown(coarse, grid);
  }
  const Energy energy(kind, grid, cell_px);
  Eigen::VectorXd x = energy.estimate();
  if (is_direct) {
    solve_directly(energy, x);
  } else {
    const int iterations = kind == SurfaceEnergy::kMembrane ? 16 : 48;
    improve(energy, iterations * static_cast<int>(cell_px), x);  // more where they cost less
  }
  energy.store(x, grid);
}

}  // namespace

void solve_surface(SurfaceEnergy energy, RegionGrid& grid) { solve_at(energy, 1, grid); }

}  // namespace vantage
