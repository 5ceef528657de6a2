#include "apps/view_output.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/io/photograph_io.h"

namespace vantage::apps {
namespace {

bool is_video(const std::string& path) { return has_extension(path, {".mp4"}); }

}  // namespace

void add_view_output_settings(Settings& settings, std::string& output, std::string& hole_mask) {
  Setting& file =
      settings.text("output", output, "FILE",
                    "Image to write; for several views a pattern (views/%03d.png) or an .mp4");
  file.short_name = 'o';
  file.required = true;
  settings.text("hole-mask", hole_mask, "MASK.png",
                "Write a mask of the pixels that no image shows; a pattern for several views");
}

ViewOutput::ViewOutput(const std::string& path, int views) : path_(path), views_(views) {
  if (is_pattern(path)) {
    expand_pattern(path, 0);  // throws for a malformed one
    if (is_video(path)) {
      throw UsageError(fmt::format("'{}' is a pattern for videos, expected one video name", path));
    }
  } else if (views > 1 && !is_video(path)) {
    throw UsageError(fmt::format(
        "'{}' names one file for {} views, expected a pattern such as views/%03d.png, or an .mp4",
        path, views));
  }
}

std::string ViewOutput::file(int index) const {
  return is_pattern(path_) ? expand_pattern(path_, index) : path_;
}

void ViewOutput::check(FileChecks& checks, const std::string& option) const {
  if (is_video(path_)) {
    checks.add_output(path_, option, OutputKind::kVideo);
    return;
  }
  for (int index = 0; index < views_; ++index) {
    checks.add_output(file(index), option, OutputKind::kPhotograph);
  }
}

bool ViewOutput::needs_order() const { return is_video(path_); }

void ViewOutput::write(int index, const Photograph& image, FrameRate rate) {
  if (!is_video(path_)) {
    write_photograph(file(index), image);
    return;
  }
  if (video_ == nullptr) {
    video_ = std::make_unique<VideoWriter>(path_, image.width(), image.height(),
                                           VideoEncoding{.rate = rate});
  }
  video_->write(image);
}

void ViewOutput::finish() {
  if (video_ != nullptr) {
    video_->finish();
  }
}

}  // namespace vantage::apps
