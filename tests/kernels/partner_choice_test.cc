#include "kernels/partner_choice/partner_choice.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::partner_choice_test {

TEST(PartnerChoice, IsTheMeanOfTheBetterHalfThatSeesTheCandidate) {
  std::mt19937 random(9);
  for (const int partners : {1, 2, 3, 4, 7, 64}) {
    for (const int count : {1, 15, 16, 33}) {
      for (const bool likelihoods : {false, true}) {
        const int columns = 3;
        const int lanes = (count + 15) / 16 * 16;
        const auto stride = static_cast<std::size_t>(columns * lanes + 16);
        std::vector<float> cells(stride * static_cast<std::size_t>(partners));
        for (float& cell : cells) {
          const auto share = static_cast<float>(1 + random() % 1000U) / 1000;
          cell = likelihoods ? share : 100 * share - 30;
        }
        std::vector<CandidateRange> seen(partners * columns);
        for (CandidateRange& range : seen) {
          range = {random_int(random, 0, count), random_int(random, 0, count)};
        }
        const PartnerCells row{cells.data(), static_cast<std::ptrdiff_t>(stride),
                               seen.data(),  partners,
                               columns,      lanes,
                               count};
        const auto actual = row_on_every_target<float>(
            static_cast<std::size_t>(columns * lanes),
            likelihoods ? choose_likelihoods_row : choose_energies_row, row);
        for (int j = 0; j < columns; ++j) {
          for (int i = 0; i < lanes; ++i) {
            const float cell = actual[j * lanes + i];
            if (i >= count) {
              ASSERT_TRUE(likelihoods ? cell == 0 : std::isfinite(cell));
              continue;
            }
            std::vector<double> of_seen;
            std::vector<double> of_all;
            for (int p = 0; p < partners; ++p) {
              const double value = cells[static_cast<std::size_t>(p) * stride +
                                         static_cast<std::size_t>(j * lanes + i)];
              of_all.push_back(likelihoods ? -std::log(value) : value);
              const auto [begin, end] = seen[p * columns + j];
              if (i >= begin && i < end) {
                of_seen.push_back(of_all.back());
              }
            }
            std::sort(of_seen.begin(), of_seen.end());
            of_seen.resize(std::min(of_seen.size(), static_cast<std::size_t>((partners + 1) / 2)));
            const std::vector<double>& used = of_seen.empty() ? of_all : of_seen;
            double sum = 0;
            for (const double energy : used) {
              sum += energy;
            }
            const double energy = sum / static_cast<double>(used.size()) * std::sqrt(partners);
            const double expected = likelihoods ? std::exp(-energy) : energy;
            ASSERT_NEAR(cell, expected, likelihoods ? 1e-5 : 1e-4 * (1 + std::abs(expected)))
                << partners << " partners, candidate " << i;
          }
        }
      }
    }
  }
}

}  // namespace vantage::kernels::partner_choice_test
