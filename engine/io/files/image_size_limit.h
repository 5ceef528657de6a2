#pragma once

namespace vantage {

/// Maximum width or height, and maximum number of pixels of one image: beyond them a header counts
/// as damaged before any memory is allocated.
inline constexpr int kMaxImageSide = 65500;
inline constexpr long long kMaxImagePixels = 1LL << 28;

/// Maximum number of pixels of images and videos in this process: kMaxImagePixels unless set to a
/// value from 1 to that. Throws UsageError beyond. Thread rule: may be called concurrently; images
/// read at the same time have the old limit or the new one.
long long max_image_pixels();
void set_max_image_pixels(long long pixels);

}  // namespace vantage
