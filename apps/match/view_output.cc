#include "apps/match/view_output.h"

#include <fmt/format.h>

#include "apps/inputs/frame_rate_setting.h"
#include "apps/process/outputs.h"
#include "engine/error.h"
#include "engine/io/images/photograph_io.h"

namespace vantage::apps {
namespace {

bool is_video(const std::string& path) { return has_extension(path, {".mp4"}); }

}  // namespace

void add_view_file_settings(Settings& settings, ViewOutputOptions& options) {
  Setting& file =
      settings.path("output", options.output, "FILE",
                    "Path to the image; for several views a pattern (views/%03d.png) or an .mp4");
  file.short_name = 'o';
  file.required = true;
  settings.path("hole-mask", options.hole_mask, "MASK.png",
                "Write a mask of the pixels that no image shows; for several views a pattern");
  settings.path("source-mask", options.source_mask, "MASK.png",
                "Write a mask of the images that each pixel comes from: 0 none, 85 left (of three "
                "images the first two), 170 right (the last), 255 both");
}

void add_view_display_settings(Settings& settings, ViewOutputOptions& options,
                               const std::string& unit) {
  settings.choice<StereoDisplay>("stereo-packing", options.stereo_packing, stereo_display_names(),
                                 "Write two eyes per view in one image: side by side, above/below, "
                                 "interleaved or anaglyph, using ffmpeg's stereo3d names",
                                 "none");
  settings.number("eye-separation", options.eye_separation, "S",
                  fmt::format("Distance between the two eyes in {}, centred on the view", unit));
  add_frame_rate_setting(settings, "fps", options.frame_rate, "Frames per second of a video");
}

ViewOutput::ViewOutput(const std::string& path, int views) : path_(path), views_(views) {
  if (is_pattern(path)) {
    expand_pattern(path, 0);  // throws for a malformed one
    if (is_video(path)) {
      throw UsageError(fmt::format("'{}' is a pattern for videos, expected one video file", path));
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

ViewOutputs::ViewOutputs(const ViewOutputOptions& options, const Settings& settings, int views)
    : frame_rate_(options.frame_rate), pictures_(options.output, views) {
  constexpr double kLargestSeparation = 16;
  if (!(options.eye_separation > 0 && options.eye_separation <= kLargestSeparation)) {
    throw UsageError(fmt::format("--eye-separation is {}, expected more than 0, at most {}",
                                 options.eye_separation, kLargestSeparation));
  }
  if (!options.stereo_packing) {
    settings.refuse_idle({"eye-separation"}, "without --stereo-packing");
  }
  if (!is_video(options.output) && !is_video(options.hole_mask) && !is_video(options.source_mask)) {
    settings.refuse_idle({"fps"}, "without an output that ends in .mp4");
  }
  const auto add_mask = [&](const char* option, const std::string& path,
                            Mask SynthesizedView::*mask) {
    if (path.empty()) {
      return;
    }
    if (options.stereo_packing) {
      throw UsageError(
          fmt::format("{} is the mask of one view, expected no --stereo-packing", option));
    }
    masks_.push_back({option, mask, ViewOutput(path, views)});
  };
  add_mask("--hole-mask", options.hole_mask, &SynthesizedView::holes);
  add_mask("--source-mask", options.source_mask, &SynthesizedView::sources);
}

void ViewOutputs::check(FileChecks& checks) const {
  pictures_.check(checks, "--output");
  for (const MaskOutput& mask : masks_) {
    mask.output.check(checks, mask.option);
  }
}

void ViewOutputs::write_at_once(int index, const Photograph& picture, const SynthesizedView& view) {
  write(index, picture, view, /*in_order=*/false);
}

void ViewOutputs::write_in_order(int index, const Photograph& picture,
                                 const SynthesizedView& view) {
  write(index, picture, view, /*in_order=*/true);
}

void ViewOutputs::write(int index, const Photograph& picture, const SynthesizedView& view,
                        bool in_order) {
  if (pictures_.needs_order() == in_order) {
    pictures_.write(index, picture, frame_rate_);
  }
  for (MaskOutput& mask : masks_) {
    if (mask.output.needs_order() == in_order) {
      mask.output.write(index, {(view.*mask.mask).copy()}, frame_rate_);
    }
  }
}

void ViewOutputs::finish() {
  pictures_.finish();
  for (MaskOutput& mask : masks_) {
    mask.output.finish();
  }
}

}  // namespace vantage::apps
