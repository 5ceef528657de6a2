#pragma once

#include <cstdint>

#include "engine/image/image.h"

namespace vantage {

struct Photograph;

/// How stored pixels become upright; the values are those of EXIF's and TIFF's tag Orientation.
/// Turns are clockwise.
enum class Orientation : std::uint8_t {
  kAsStored = 1,
  kMirror,  ///< left and right are exchanged
  kTurn180,
  kFlip,       ///< top and bottom are exchanged
  kTranspose,  ///< rows become columns
  kTurn90,
  kTransposeTurn180,  ///< rows become columns, then as kTurn180
  kTurn270
};

/// The tag's value; kAsStored for others than 1 to 8, which mean nothing.
Orientation orientation_of_tag(long long value);

/// The upright picture, of 1, 3 or 4 channels. T: uint8_t, uint16_t or float. Thread rule: pure.
template <typename T>
Image<T> turned(ImageView<const T> image, Orientation orientation);

/// Turns a photograph as the file or film says that it was read from: its pixels and what is left
/// out of them. Its origin then says so, with a remark. Thread rule: concurrently for different
/// ones.
void turn_upright(Photograph& photograph, Orientation orientation);

/// Throws Error unless both were turned in the same way when they were read: one of them is
/// probably turned already, and has a stale tag or has lost it.
void require_equal_turns(const Photograph& left, const Photograph& right);

}  // namespace vantage
