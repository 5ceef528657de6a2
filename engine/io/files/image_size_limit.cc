#include "engine/io/files/image_size_limit.h"

#include <fmt/format.h>

#include <atomic>

#include "engine/error.h"

namespace vantage {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<long long> accepted_pixels = kMaxImagePixels;

}  // namespace

long long max_image_pixels() { return accepted_pixels; }

void set_max_image_pixels(long long pixels) {
  if (pixels < 1 || pixels > kMaxImagePixels) {
    throw UsageError(fmt::format("max-pixels is {}, expected 1 to {}", pixels, kMaxImagePixels));
  }
  accepted_pixels = pixels;
}

}  // namespace vantage
