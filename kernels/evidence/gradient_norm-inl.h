// Vector form of gradient_norm.h. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_EVIDENCE_GRADIENT_NORM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_EVIDENCE_GRADIENT_NORM_INL_H_
#undef VANTAGE_KERNELS_EVIDENCE_GRADIENT_NORM_INL_H_
#else
#define VANTAGE_KERNELS_EVIDENCE_GRADIENT_NORM_INL_H_
#endif

#include "kernels/evidence/gradient_norm.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using NormTag = hn::ScalableTag<float>;
using NormVec = hn::VFromD<NormTag>;

struct NormL2 {
  HWY_INLINE NormVec operator()(NormVec x, NormVec y) const {
    return hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
  }
};

struct NormOctagon {
  HWY_INLINE NormVec operator()(NormVec x, NormVec y) const {
    const NormTag d;
    const NormVec across = hn::Abs(x);
    const NormVec down = hn::Abs(y);
    return hn::Add(hn::Mul(hn::Set(d, kOctagonSum), hn::Add(across, down)),
                   hn::Mul(hn::Set(d, kOctagonMax), hn::Max(across, down)));
  }
};

struct NormL1 {
  HWY_INLINE NormVec operator()(NormVec x, NormVec y) const {
    return hn::Add(hn::Abs(x), hn::Abs(y));
  }
};

struct NormMax {
  HWY_INLINE NormVec operator()(NormVec x, NormVec y) const {
    return hn::Max(hn::Abs(x), hn::Abs(y));
  }
};

struct NormAcross {
  HWY_INLINE NormVec operator()(NormVec x, NormVec /*y*/) const { return hn::Abs(x); }
};

/// visit(the norm).
template <typename Visit>
HWY_INLINE auto with_norm(EvidenceNorm norm, const Visit& visit) {
  switch (norm) {
    case EvidenceNorm::kOctagon:
      return visit(NormOctagon());
    case EvidenceNorm::kL1:
      return visit(NormL1());
    case EvidenceNorm::kMax:
      return visit(NormMax());
    case EvidenceNorm::kAcross:
      return visit(NormAcross());
    case EvidenceNorm::kL2:
      break;
  }
  return visit(NormL2());
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
