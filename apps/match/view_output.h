#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/process/outputs.h"
#include "engine/image/photograph.h"
#include "engine/image/stereo_display.h"
#include "engine/io/video/video_io.h"
#include "engine/options/settings.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage::apps {

/// Output options of commands that render views.
struct ViewOutputOptions {
  std::string output;
  std::string hole_mask;  ///< empty: none, as below
  std::string source_mask;
  std::optional<StereoDisplay> stereo_packing;
  double eye_separation = 1;
  FrameRate frame_rate;
};

/// --output, --hole-mask and --source-mask, in the current group.
void add_view_file_settings(Settings& settings, ViewOutputOptions& options);
/// --stereo-packing, --eye-separation and --fps. `unit`: the unit of the separation, such as
/// "baselines".
void add_view_display_settings(Settings& settings, ViewOutputOptions& options,
                               const std::string& unit);

/// Destination of rendered images: one image file, numbered files (a printf pattern) or a video.
class ViewOutput {
 public:
  /// `views` is their number. Throws UsageError for several views and a single file.
  ViewOutput(const std::string& path, int views);

  /// Adds every file to be written to `checks`. `option` names the setting in messages.
  void check(FileChecks& checks, const std::string& option) const;

  /// Whether views must be written one at a time in order, as in a video; else write() may be
  /// called concurrently and in any order.
  [[nodiscard]] bool needs_order() const;
  /// Writes view `index`.
  void write(int index, const Photograph& image, FrameRate rate);
  /// Call it after the last view; otherwise no video is kept.
  void finish();

 private:
  [[nodiscard]] std::string file(int index) const;

  std::string path_;
  int views_;
  std::unique_ptr<VideoWriter> video_;
};

/// All outputs of a command that renders views: images and masks.
class ViewOutputs {
 public:
  /// Throws UsageError for invalid options and for options without effect.
  ViewOutputs(const ViewOutputOptions& options, const Settings& settings, int views);

  /// Adds every file to be written to `checks`.
  void check(FileChecks& checks) const;
  /// Writes the outputs of view `index` that need no order; may be called concurrently for
  /// different views.
  void write_at_once(int index, const Photograph& picture, const SynthesizedView& view);
  /// Writes the other outputs; call it in the order of the views.
  void write_in_order(int index, const Photograph& picture, const SynthesizedView& view);
  /// Call it after the last view; otherwise no video is kept.
  void finish();

 private:
  struct MaskOutput {
    const char* option;
    Mask SynthesizedView::*mask;
    ViewOutput output;
  };

  void write(int index, const Photograph& picture, const SynthesizedView& view, bool in_order);

  FrameRate frame_rate_;
  ViewOutput pictures_;
  std::vector<MaskOutput> masks_;
};

}  // namespace vantage::apps
