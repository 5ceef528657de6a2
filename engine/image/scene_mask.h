#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Which pixels of photographs show no scene.
struct SceneMaskOptions {
  static constexpr std::string_view kAlpha = "alpha";
  static constexpr std::string_view kNone = "none";

  /// Masks of the left and the right image: files, of a sequence one or one per pair. Of `left`
  /// also kAlpha: pixels of both images whose alpha is 0; kNone: no border is looked for. Both
  /// empty: black borders are found, see black_borders().
  std::string left = {};
  std::string right = {};
  /// A grey level or a colour (R, G, B), as stored, of pixels without data. Empty: none.
  std::vector<double> no_data = {};

  /// Throws UsageError for a colour of other than one or three numbers.
  void validate() const;
  [[nodiscard]] bool finds_borders() const { return left.empty() && right.empty(); }
  [[nodiscard]] bool uses_alpha() const { return left == kAlpha; }
  /// The file of the left (0) or the right (1) image's mask; empty: none.
  [[nodiscard]] const std::string& file(std::size_t image) const;
  /// Whether it may leave out anything.
  [[nodiscard]] bool is_active() const {
    return left != kNone || !right.empty() || !no_data.empty();
  }

  friend bool operator==(const SceneMaskOptions&, const SceneMaskOptions&) = default;
};

/// The black pixels of a picture of a mask: those that are left out.
Mask black_pixels(const Photograph& picture);

/// Leaves out of a pair (image/left_out.h) what the options say, in place of what was left out
/// before. `files`: pictures of masks, null: none. `borders`: null: of these photographs, where
/// options.finds_borders(); a mask of another size is none. Throws Error when a mask has another
/// size than its photograph, or a photograph has no alpha.
void leave_out_of_pair(const SceneMaskOptions& options,
                       const std::array<const Photograph*, 2>& files,
                       const std::array<Mask, 2>* borders, Photograph& left, Photograph& right);

}  // namespace vantage
