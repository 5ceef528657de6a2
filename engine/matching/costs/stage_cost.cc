#include "engine/matching/costs/stage_cost.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/column_work.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/matching_cost.h"
#include "engine/matching/costs/partner_rows.h"
#include "kernels/partner_choice/partner_choice.h"

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
        model_(cost_of(parameters).make_model(parameters)),
        lanes_(geometry.lanes()),
        count_(geometry.count),
        partners_(std::move(partners)),
        meaning_(meaning),
        without_partner_(value_without_partner()) {}

  [[nodiscard]] std::string_view name() const override { return "cost"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return sizeof(float) * lanes(); }
  /// Of one block: cells of each partner, the candidates it sees, and what is gathered.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return in_one_go() ? 0
                       : partners_.size() * kBlockColumns *
                                 (sizeof(float) * lanes() + sizeof(CandidateRange)) +
                             max_gather_bytes();
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    kernels::KernelWork work;
    for (const PartnerRows& partner : partners_) {
      work =
          work + (meaning_ == CellMeaning::kEnergy ? model_->energy_work(partner.channels())
                                                   : model_->likelihood_work(partner.channels()));
      if (partner.is_gathered()) {
        work = work + kernels::kGatherCandidatesWork;
      }
    }
    if (partners_.size() > 1) {
      work = work + kernels::choose_partners_work(static_cast<int>(partners_.size()),
                                                  meaning_ == CellMeaning::kLikelihood);
    }
    return vantage::column_work(work, count_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* cells = reinterpret_cast<float*>(task.output);
    if (in_one_go()) {
      compare(partners_.front(), task.y, task.columns, nullptr, cells);
      return;
    }
    const std::size_t stride = kBlockColumns * lanes();
    auto* const of_partners = reinterpret_cast<float*>(task.state);
    auto* const seen = reinterpret_cast<CandidateRange*>(of_partners + partners_.size() * stride);
    auto* const memory = reinterpret_cast<std::byte*>(seen + partners_.size() * kBlockColumns);
    for (int x = task.columns.begin; x < task.columns.end; x += kBlockColumns) {
      const Range block = Range{x, x + kBlockColumns}.widened(0, task.columns);
      if (partners_.size() == 1) {
        compare(partners_.front(), task.y, block, memory, cells);
      } else {
        CandidateRange* next = seen;
        for (std::size_t k = 0; k < partners_.size(); ++k) {
          compare(partners_[k], task.y, block, memory, of_partners + k * stride);
          for (int column = block.begin; column < block.end; ++column) {
            *next++ = partners_[k].has_row(task.y) ? partners_[k].with_partner(column, task.y)
                                                   : CandidateRange{};
          }
        }
        choose({.cells = of_partners,
                .partner_stride = static_cast<std::ptrdiff_t>(stride),
                .seen = seen,
                .partners = static_cast<int>(partners_.size()),
                .columns = block.size(),
                .lanes = lanes_,
                .count = count_},
               cells);
      }
      cells += static_cast<std::size_t>(block.size()) * lanes();
    }
  }

 private:
  static constexpr int kBlockColumns = 16;

  [[nodiscard]] std::size_t lanes() const { return static_cast<std::size_t>(lanes_); }
  [[nodiscard]] bool in_one_go() const {
    return partners_.size() == 1 && !partners_.front().is_gathered();
  }
  [[nodiscard]] std::size_t max_gather_bytes() const {
    std::size_t bytes = 0;
    for (const PartnerRows& partner : partners_) {
      bytes = std::max(bytes, partner.gather_bytes(kBlockColumns));
    }
    return bytes;
  }

  [[nodiscard]] std::optional<float> value_without_partner() const {
    return meaning_ == CellMeaning::kEnergy ? model_->energy_without_partner()
                                            : model_->likelihood_without_partner();
  }

  void choose(const kernels::PartnerCells& of_partners, float* cells) const {
    if (meaning_ == CellMeaning::kEnergy) {
      kernels::choose_energies_row(of_partners, cells);
    } else {
      kernels::choose_likelihoods_row(of_partners, cells);
    }
  }

  /// Writes the cells of one partner.
  void compare(const PartnerRows& partner, int y, Range columns, std::byte* memory,
               float* cells) const {
    if (without_partner_ && !partner.has_row(y)) {
      for (int j = 0; j < columns.size(); ++j, cells += lanes_) {
        std::fill(cells, cells + count_, *without_partner_);
        std::fill(cells + count_, cells + lanes_, 0.0F);
      }
      return;
    }
    GatherMemory gather(memory, partner.gather_bytes(kBlockColumns));
    const CostRow row{partner, y, columns, &gather};
    if (meaning_ == CellMeaning::kEnergy) {
      model_->energies(row, cells);
    } else {
      model_->likelihoods(row, cells);
    }
    fill_without_partner(partner, y, columns, cells);
  }

  /// Only columns near the borders have such cells.
  void fill_without_partner(const PartnerRows& partner, int y, Range columns, float* cells) const {
    if (!without_partner_) {
      return;
    }
    const auto fill = [&](int x) {
      const CandidateRange inside = partner.with_partner(x, y);
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

  std::unique_ptr<CostModel> model_;
  int lanes_;
  int count_;
  std::vector<PartnerRows> partners_;
  CellMeaning meaning_;
  /// Value of cells whose partner is outside; empty: the cost of the border.
  std::optional<float> without_partner_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_cost_stage(const MethodParameters& parameters,
                                                     const kernels::CandidateGeometry& geometry,
                                                     const CostImage& reference,
                                                     std::span<const CostPartner> partners,
                                                     CellMeaning meaning, int height) {
  std::vector<PartnerRows> rows;
  for (const CostPartner& partner : partners) {
    rows.emplace_back(reference, partner, geometry);
  }
  return std::make_unique<CostStage>(parameters, geometry, std::move(rows), meaning, height);
}

}  // namespace vantage
