#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// One picture of a sheet.
struct SheetPicture {
  std::string title;
  Image<std::uint8_t> pixels;  ///< 1 or 3 channels, at least 1×1
};

/// Pictures in a grid of `columns` ≥ 1, each `width` drawing units wide, with their titles above
/// them (broken into lines). Thread rule: pure.
Drawing draw_picture_sheet(const std::string& title, const std::vector<SheetPicture>& pictures,
                           int columns, double width);

/// Values as grey levels, black at `min` and below, white at `max` and above; unknown (NaN, ±inf)
/// in `unknown`. 8-bit RGB. min < max.
Image<std::uint8_t> grey_picture(ImageView<const float> values, float min, float max,
                                 Colour unknown = {255, 255, 255});

}  // namespace vantage
