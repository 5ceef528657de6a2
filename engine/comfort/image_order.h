#pragma once

#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Places that tell whether left and right are as they should be.
struct OrderVotes {
  int right = 0;
  int wrong = 0;
};

/// Pixels that only this image shows lie between a nearer and a farther surface, and belong to the
/// farther one: they are hidden from the other eye. Where their colour continues on that side, the
/// order is right; where it continues on the nearer side, the images are exchanged, because then
/// near and far are. `map`: of `image`, which is that of `side`. Places without a clear difference
/// do not count. Thread rule: pure.
OrderVotes order_of_images(const Photograph& image, const MatchedMap& map, Side side);

}  // namespace vantage
