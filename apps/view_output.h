#pragma once

#include <memory>
#include <string>

#include "apps/outputs.h"
#include "apps/settings.h"
#include "engine/image/photograph.h"
#include "engine/io/video_io.h"

namespace vantage::apps {

/// --output and --hole-mask of a command that renders views, in the group that has begun.
void add_view_output_settings(Settings& settings, std::string& output, std::string& hole_mask);

/// Where rendered views go: one image file, numbered image files (a printf pattern) or a video.
class ViewOutput {
 public:
  /// `views` is how many there will be. Throws UsageError when several should go to a plain name.
  ViewOutput(const std::string& path, int views);

  /// Adds every file to be written to `checks`. `option` names the setting in messages.
  void check(FileChecks& checks, const std::string& option) const;

  /// Whether views must be written one by one in their order, as into a video; else write() may be
  /// called concurrently and in any order.
  [[nodiscard]] bool needs_order() const;
  /// View `index`.
  void write(int index, const Photograph& image, FrameRate rate);
  /// Call it after the last view; without it no video is left.
  void finish();

 private:
  [[nodiscard]] std::string file(int index) const;

  std::string path_;
  int views_;
  std::unique_ptr<VideoWriter> video_;
};

}  // namespace vantage::apps
