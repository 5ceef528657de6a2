#pragma once

#include "kernels/evidence/gradient_norm.h"

namespace vantage::kernels {

inline constexpr EvidenceNorm kAllEvidenceNorms[] = {EvidenceNorm::kL2, EvidenceNorm::kOctagon,
                                                     EvidenceNorm::kL1, EvidenceNorm::kMax,
                                                     EvidenceNorm::kAcross};

}  // namespace vantage::kernels
