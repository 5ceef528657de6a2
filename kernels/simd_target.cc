// The dispatch tables of this file show which targets are built and which one is chosen.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/simd_target.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include "kernels/simd_target.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
long long this_target() { return HWY_TARGET; }
}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(this_target);

long long built_targets() { return HWY_TARGETS; }

long long target_in_use() { return HWY_DYNAMIC_DISPATCH(this_target)(); }

#if HWY_ARCH_ARM_A64 || HWY_ARCH_WASM  // one target; on ARM Highway would ask for AES, too
long long available_targets() { return HWY_TARGETS; }

void force_target(long long /*target*/) {}
#else
long long available_targets() {
  // Highway reports all targets only after its choice is reset.
  const long long in_use = target_in_use();
  hwy::SetSupportedTargetsForTest(0);
  const long long available = hwy::SupportedTargets() & HWY_TARGETS;
  force_target(in_use);
  return available;
}

void force_target(long long target) {
  // Highway provides this call for tests; the alternative, DisableTargets(), cannot be undone.
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}
#endif

std::string_view target_name(long long target) { return hwy::TargetName(target); }

}  // namespace vantage::kernels
#endif
