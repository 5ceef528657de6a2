#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

// Peak performance of the instruction set in use, for rooflines; not part of any image processing.
// Thread rule: any thread; written memory belongs to the caller.

/// Multiplies and adds floats in registers, in enough independent chains to hide the latency.
/// Returns the number of floating-point operations, proportional to `rounds` (≥ 1); `sink` receives
/// a number that depends on all of them. Uses fused operations where the processor has them.
double multiply_and_add(std::int64_t rounds, float& sink);

/// The triad of the STREAM benchmark, a = b + s c, on `count` floats. Traffic: 12 bytes each, 16 if
/// a store loads its line first.
void triad(float* a, const float* b, const float* c, float s, std::size_t count);

/// Sum of `count` floats in an unspecified order. Traffic: 4 bytes each, loads only.
float load_all(const float* values, std::size_t count);

}  // namespace vantage::kernels
