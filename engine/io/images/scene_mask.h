#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Which pixels of the photographs of a pair show no scene.
struct SceneMaskOptions {
  static constexpr std::string_view kAlpha = "alpha";
  static constexpr std::string_view kNone = "none";

  /// Masks of the left and the right image: files, of a sequence one or one for each pair. Of
  /// `left` also kAlpha: pixels of both images whose alpha is 0; kNone: no border is looked for.
  /// Both empty: black borders are found, see black_border().
  std::string left = {};
  std::string right = {};
  /// A grey level or a colour (R, G, B), as stored, of pixels without data. Empty: none.
  std::vector<double> no_data = {};

  /// Throws UsageError for a colour of other than one or three numbers.
  void validate() const;
  [[nodiscard]] bool finds_borders() const { return left.empty() && right.empty(); }
  /// The files of the masks of the left and the right image; empty: none.
  [[nodiscard]] std::array<std::string, 2> files() const;
};

/// The pixels of a mask's picture that are left out: black ones.
Mask black_pixels(const Photograph& picture);

/// Leaves out of a pair (image/left_out.h) `masks` (empty: nothing), transparent pixels and those
/// without data, in place of what was left out before. Throws Error when a mask has another size
/// than its photograph, or a photograph has no alpha.
void leave_out_of_pair(const SceneMaskOptions& options, std::array<Mask, 2> masks, Photograph& left,
                       Photograph& right);
/// The same with masks from files, or with the black borders of these photographs.
void leave_out_of_pair(const SceneMaskOptions& options, Photograph& left, Photograph& right);

}  // namespace vantage
