#pragma once

#include <optional>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"

namespace vantage {

// Pixels that show no scene, Photograph::left_out: 255 where a mask, a rectification or the black
// border of a film says so. Thread rule: pure.

/// Marks pixels and gives them values that matching cannot take for texture, and that no filter can
/// spread: those of the nearest other pixel of their row, the left one of two; rows without such
/// pixels those of the nearest row that has some, the upper one of two. So maps do not depend on
/// what was there. Only marks them where no pixel is left. Pixels that are left out already stay
/// so. `left_out`: of the photograph's size, or empty; one without a marked pixel counts as empty.
void leave_out(Photograph& photograph, Mask left_out);

/// Leaves out pixels without data, for which a channel is NaN or all are `no_data`, beside those
/// that are left out already; its origin then has a remark. Throws Error where no pixel has data.
void leave_out_no_data(Photograph& photograph, std::optional<double> no_data = {});

/// 0 in all channels where a pixel is left out, which files have instead of a mask.
void blacken_left_out(Photograph& photograph);

/// The pixels of a picture of half the size, rounded up, of whose 2×2 pixels none shows the scene.
Mask half_of(const Mask& left_out);

/// Unknown, and unmatched, where `left_out` is set. An empty mask is none; images of the map that
/// have another size were not asked for.
void erase_left_out(const Mask& left_out, MatchedMap& map);
void erase_left_out(const Mask& left_out, Image<float>& values);

/// Also marks as unmatched what is left out, and what leads to a pixel of the other image that is.
/// Winners before refinement; unknown ones lead nowhere. columns_per_px: as of cross_check().
void mark_left_out(const Mask& own, const Mask& other, Side side, float columns_per_px,
                   Execution& execution, MatchedMap& map);

/// Share of set pixels, 0 to 1; 0 if empty.
double share_of(const Mask& mask);

}  // namespace vantage
