#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// Energy of a pair of pixels in steps, as one image's cells say: 0..kNeverMatched − 1.
using StepEnergy = std::uint16_t;
/// Energy of pairs that may not be matched.
inline constexpr StepEnergy kNeverMatched = 65535;

/// A row of both images and the pairs of their pixels (EQUATIONS §3.17). Candidate i of left column
/// x and of right column x − d stands for the pair of the two, d = disparity_min + i.
struct SymmetricRow {
  const StepEnergy* left = nullptr;   ///< `lanes` per column of the left image
  const StepEnergy* right = nullptr;  ///< `lanes` per column of the right image
  int width = 0;
  int lanes = 0;
  int disparity_min = 0;
  int count = 0;
  /// A matched pair costs left + right + match_offset, a pixel without a match `unmatched` > 0.
  /// Those of a whole row must stay within ±2³⁰: width · |match_offset|, 2 · width · unmatched.
  std::int32_t match_offset = 0;
  std::int32_t unmatched = 1;

  /// What a pair costs; kNever where it may not be matched. The columns must be inside.
  [[nodiscard]] std::int32_t cost(int left_column, int candidate) const {
    const int right_column = left_column - disparity_min - candidate;
    const StepEnergy of_left = left[static_cast<std::ptrdiff_t>(left_column) * lanes + candidate];
    const StepEnergy of_right =
        right[static_cast<std::ptrdiff_t>(right_column) * lanes + candidate];
    return of_left == kNeverMatched || of_right == kNeverMatched
               ? kNever
               : of_left + of_right + match_offset;
  }
  static constexpr std::int32_t kNever = 1 << 30;
};

/// Number of sums that symmetric_matches_row() stores.
std::size_t symmetric_path_sums(const SymmetricRow& row);

/// The matches of one row that minimise the sum of the costs of matched pairs and of unmatched
/// pixels of both images, where each pixel has at most one match and matches keep their order.
/// left_matches[x], right_matches[x]: the candidate of the pair that the pixel belongs to,
/// kNoWinner where it is unmatched. Dynamic programming in cyclopean coordinates t = x_left +
/// x_right and d = x_left − x_right. Of equally good solutions that with the smallest d everywhere.
/// Exchanging the images, each mirrored, exchanges and mirrors the results exactly. `sums`: working
/// memory.
void symmetric_matches_row(const SymmetricRow& row, std::int32_t* sums, std::int32_t* left_matches,
                           std::int32_t* right_matches);

}  // namespace vantage::kernels
