// Highway, for files with SIMD (*_simd.cc) and what they include. A file with SIMD includes it
// before all else: everything after it is compiled once per instruction set.
//
// No include guard: each instruction set needs its own `hn`.

#include <hwy/foreach_target.h>  // includes the file again; CMake names it (HWY_TARGET_INCLUDE)
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
}  // namespace vantage::kernels::HWY_NAMESPACE
