#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/io/images/preview.h"
#include "engine/io/video/frame_rate.h"
#include "engine/options/setting_value.h"
#include "engine/synthesis/pair_with_maps.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage::apps {

/// Image format of the photographs in a page.
enum class PageImages {
  kPng,  ///< lossless, 8 bits per channel
  kJpeg  ///< a fraction of the size
};

/// Range of a coordinate of the view, in baselines.
struct ViewRange {
  double first = 0;
  double last = 0;
};

struct ViewPageOptions {
  ViewRange range_x{-0.5, 1.5};      ///< XS: 0 = left camera, 1 = right camera
  ViewRange range_y{-0.2, 0.2};      ///< YS: below the baseline where positive
  std::optional<PageImages> images;  ///< empty: PNG of a pair, JPEG of a film
  /// Only holes, gamma, disparity_gradient_limit_px and match_intensities are used.
  SynthesisOptions synthesis;

  /// Throws UsageError naming the option, its value and its limit.
  void validate() const;
};

/// Makes text of a picture, 8-bit grey or RGB: base64 of a file of the type that its name tells.
/// Called by several threads at once.
using PictureEncoder =
    std::function<std::string(const std::string& file_name, Image<std::uint8_t> pixels)>;

/// An HTML page that renders views of a pair, or of the frames of a film, by itself. Photographs
/// become 8-bit and lose an alpha channel. Intensities are regressed once for each pair, half-way
/// between the cameras, so that brightness does not change on the way. In JPEG, disparities are
/// rounded to 1/32 pixel. Thread rule: one thread at a time.
class ViewPage {
 public:
  /// `folder`: name of the folder beside the page that holds the script of each frame; empty: the
  /// page shows one pair, which is in it. Throws UsageError for invalid options.
  ViewPage(ViewPageOptions options, std::string folder, PictureEncoder encode);

  /// Adds a frame; numbers increase. Returns its script, the file script_name(number) of the
  /// folder. Throws Error when shapes differ, also from the first frame's, a side has more than
  /// 16384 pixels, or disparities cannot be stored.
  std::string add_frame(int number, const PairWithMaps& pair, Execution& execution);
  /// Adds a frame that cannot be shown.
  void add_missing(int number, const std::string& problem);
  static std::string script_name(int number);

  /// The page of the frames added, of which there is one at least. `names`: what it says it shows.
  /// `script`: of the pair, where there is no folder.
  [[nodiscard]] std::string html(const std::string& names, FrameRate rate,
                                 const std::string& script) const;

 private:
  ViewPageOptions options_;
  bool is_lossless_;
  std::string folder_;
  PictureEncoder encode_;
  SettingValue scene_;  ///< null before the first frame
  SettingValue frames_ = SettingValue::array();
  PreviewRange colours_;  ///< of the maps of all frames
};

}  // namespace vantage::apps
