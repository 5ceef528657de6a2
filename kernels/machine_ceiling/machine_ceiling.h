#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

// What the instruction set in use can do at best, for rooflines: nothing here makes a picture.
// Thread rule: any thread; memory that is written belongs to the caller.

/// Multiplies and adds floats in registers, as many independent chains as hide the latency.
/// Returns the floating-point operations done, in proportion to `rounds` (≥ 1); `sink` gets a
/// number that depends on all of them. Uses fused operations where the processor has them.
double multiply_and_add(std::int64_t rounds, float& sink);

/// The triad of the STREAM benchmark, a = b + s c, for `count` floats: 12 bytes each, 16 where a
/// store loads its line first.
void triad(float* a, const float* b, const float* c, float s, std::size_t count);

/// The sum of `count` floats in an unspecified order: 4 bytes each, loaded only.
float load_all(const float* values, std::size_t count);

}  // namespace vantage::kernels
