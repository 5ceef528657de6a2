#pragma once

#include <cstddef>

#include "kernels/candidates.h"

namespace vantage::kernels {

/// Maximum number of images that one is compared with.
inline constexpr int kMaxPartners = 64;

/// Cells of several partners for the same columns and candidates.
struct PartnerCells {
  const float* cells = nullptr;          ///< of the first partner, `lanes` per column
  std::ptrdiff_t partner_stride = 0;     ///< floats from partner to partner
  const CandidateRange* seen = nullptr;  ///< [partner · columns + column]: those inside its image
  int partners = 0;                      ///< 1..kMaxPartners
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates: lanes [0, count)
};

/// Energies of several partners as one (6.6): √partners times the mean of the better half, the
/// ⌈partners/2⌉ smallest, among the partners that see the candidate. If fewer see it, the mean of
/// those; if none does, of all. Surfaces that some cameras do not see are thus judged by the
/// others. Writes columns × lanes floats. Identical on every instruction set.
void choose_energies_row(const PartnerCells& row, float* cells);

/// The same for likelihoods in (0, 1], by way of −log. Lanes ≥ row.count become 0.
void choose_likelihoods_row(const PartnerCells& row, float* cells);

}  // namespace vantage::kernels
