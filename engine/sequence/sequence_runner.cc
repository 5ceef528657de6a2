#include "engine/sequence/sequence_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <variant>

#include "engine/error.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/sequence/busy_clock.h"
#include "engine/sequence/pending_files.h"
#include "engine/sequence/preview_range.h"
#include "engine/synthesis/view_synthesizer.h"
#include "scheduler/frame_pipeline.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What one frame under way needs; reused by the frame `in_flight` later.
struct FrameSlot {
  int index = 0;
  Photograph left;
  Photograph right;
  DisparityMaps maps;
  MatchReport match;
  std::vector<SynthesizedView> views;
  Photograph preview;
  PendingFiles files;
  double read_seconds = 0;
  double views_seconds = 0;
  double preview_seconds = 0;
  double write_seconds = 0;
};

/// A frame whose work failed. Its files are named once nothing runs any more: sources are not for
/// several threads.
class FrameError : public Error {
 public:
  FrameError(int frame, const std::string& message) : Error(message), frame_(frame) {}
  [[nodiscard]] int frame() const { return frame_; }

 private:
  int frame_;
};

/// Extension, without the dot, of a picture file that holds the depth losslessly.
const char* lossless_extension(const Photograph& photograph) {
  return std::holds_alternative<Image<float>>(photograph.pixels) ? "tiff" : "png";
}

void make_folders(const SequenceLayout& layout) {
  for (const std::filesystem::path& folder : layout.folders()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
      throw Error(fmt::format("{}: cannot be made a folder: {}", folder.string(), error.message()));
    }
  }
}

/// One run: the three steps of a frame, and what they add up to.
class Run {
 public:
  Run(const SequenceOptions& options, Execution& execution, int in_flight, FrameSource& left,
      FrameSource& right, const std::filesystem::path& folder,
      const std::function<void(const SequenceProgress&)>& on_frame)
      : options_(options),
        matcher_(options.match, execution),
        synthesizer_(options.synthesis, execution),
        left_(left),
        right_(right),
        layout_(folder, options),
        on_frame_(on_frame),
        slots_(static_cast<std::size_t>(in_flight)) {
    report_.in_flight = in_flight;
    if (left.frame_count() && right.frame_count()) {
      frames_total_ = std::min(*left.frame_count(), *right.frame_count());
    }
    for (FrameSlot& slot : slots_) {
      slot.views.resize(options.views_x.size());
    }
    make_folders(layout_);
  }

  [[nodiscard]] scheduler::FrameSteps steps() {
    return {[this](int slot) { return read(slots_[static_cast<std::size_t>(slot)]); },
            [this](int slot) { compute(slots_[static_cast<std::size_t>(slot)]); },
            [this](int slot) { write(slots_[static_cast<std::size_t>(slot)]); }};
  }

  [[nodiscard]] SequenceReport finish(bool interrupted) {
    if (report_.frames == 0 && !interrupted) {
      throw Error("the sequences have no frames");
    }
    report_.interrupted = interrupted;
    report_.compute_seconds = compute_clock_.seconds();
    return std::move(report_);
  }

 private:
  bool read(FrameSlot& slot) {
    const Clock::time_point start = Clock::now();
    slot.index = frames_read_;
    bool has_left = false;
    bool has_right = false;
    try {
      has_left = left_.next(slot.left);
      has_right = right_.next(slot.right);
    } catch (const Error& error) {
      throw Error(fmt::format("frame {}: {}", slot.index, error.what()));
    }
    if (has_left != has_right) {
      throw unequal_lengths(has_left);
    }
    slot.read_seconds = seconds_since(start);
    ++frames_read_;
    return has_left;
  }

  [[nodiscard]] Error unequal_lengths(bool left_is_longer) const {
    const std::optional<int> longer = (left_is_longer ? left_ : right_).frame_count();
    const std::string length = longer && *longer > frames_read_
                                   ? fmt::format("{}", *longer)
                                   : fmt::format("at least {}", frames_read_ + 1);
    return Error(
        fmt::format("frame {}: the {} sequence has ended after {} frames but the {} one "
                    "has {}, expected equal lengths",
                    frames_read_, left_is_longer ? "right" : "left", frames_read_,
                    left_is_longer ? "left" : "right", length));
  }

  void compute(FrameSlot& slot) {
    try {
      {
        const BusyClock::Activity activity(compute_clock_);
        match(slot);
        synthesize(slot);
        paint_preview(slot);
      }
      write_pending(slot);
    } catch (const Error& error) {
      throw FrameError(slot.index, error.what());
    }
  }

  void match(FrameSlot& slot) {
    const bool right_is_primary = options_.match.reference == Reference::kRight;
    const bool needs_views = !options_.views_x.empty();
    const MatchRequest request{
        .left = !right_is_primary || needs_views,
        .right = right_is_primary || needs_views || options_.saves(SequenceOutput::kRightDisparity),
        .confidence = options_.saves(SequenceOutput::kConfidence)};
    matcher_.match(slot.left, slot.right, request, slot.maps, &slot.match);
  }

  void synthesize(FrameSlot& slot) {
    const Clock::time_point start = Clock::now();
    for (std::size_t view = 0; view < slot.views.size(); ++view) {
      synthesizer_.synthesize(slot.left, slot.right, slot.maps.left.view(), slot.maps.right.view(),
                              options_.views_x[view], slot.views[view]);
    }
    slot.views_seconds = seconds_since(start);
  }

  void paint_preview(FrameSlot& slot) {
    const Clock::time_point start = Clock::now();
    if (options_.saves(SequenceOutput::kPreview)) {
      const PreviewRange range = preview_range_of(options_.match.disparities);
      slot.preview.pixels = colour_preview(primary_map(slot).view(), range.min_px, range.max_px);
    }
    slot.preview_seconds = seconds_since(start);
  }

  [[nodiscard]] const DisparityMap& primary_map(const FrameSlot& slot) const {
    return options_.match.reference == Reference::kLeft ? slot.maps.left : slot.maps.right;
  }
  [[nodiscard]] const Image<float>& primary_confidence(const FrameSlot& slot) const {
    return options_.match.reference == Reference::kLeft ? slot.maps.left_confidence
                                                        : slot.maps.right_confidence;
  }
  [[nodiscard]] const Mask& primary_unmatched(const FrameSlot& slot) const {
    return options_.match.reference == Reference::kLeft ? slot.maps.left_unmatched
                                                        : slot.maps.right_unmatched;
  }

  /// Encodes here, in parallel with other frames: compressing takes as long as matching.
  void write_pending(FrameSlot& slot) const {
    const Clock::time_point start = Clock::now();
    slot.files.discard();  // left by a frame that came after one that failed
    for (const SequenceOutput output : options_.save) {
      const std::string& map_extension = options_.disparity_format;
      switch (output) {
        case SequenceOutput::kDisparity:
          add_file(slot, output, map_extension,
                   [&](const auto& path) { write_disparity(path, primary_map(slot).view()); });
          break;
        case SequenceOutput::kRightDisparity:
          add_file(slot, output, map_extension,
                   [&](const auto& path) { write_disparity(path, slot.maps.right.view()); });
          break;
        case SequenceOutput::kConfidence:
          add_file(slot, output, map_extension, [&](const auto& path) {
            write_disparity(path, primary_confidence(slot).view());
          });
          break;
        case SequenceOutput::kUnmatched:
          add_file(slot, output, "png",
                   [&](const auto& path) { write_mask(path, primary_unmatched(slot).view()); });
          break;
        case SequenceOutput::kPreview:
          add_file(slot, output, "png",
                   [&](const auto& path) { write_photograph(path, slot.preview); });
          break;
        case SequenceOutput::kViews:
          for (std::size_t view = 0; view < slot.views.size(); ++view) {
            const Photograph& image = slot.views[view].image;
            add_file(
                slot, output, lossless_extension(image),
                [&](const auto& path) { write_photograph(path, image); }, static_cast<int>(view));
          }
          break;
      }
    }
    slot.write_seconds = seconds_since(start);
  }

  void add_file(FrameSlot& slot, SequenceOutput output, const std::string& extension,
                const std::function<void(const std::filesystem::path&)>& write,
                int view = 0) const {
    slot.files.add(layout_.file(output, slot.index, extension, view), write);
  }

  void write(FrameSlot& slot) {
    const Clock::time_point start = Clock::now();
    try {
      slot.files.commit();
    } catch (const Error& error) {
      throw Error(fmt::format("frame {}: {}", slot.index, error.what()));
    }
    slot.write_seconds += seconds_since(start);
    add_to_report(slot);
    if (on_frame_) {
      on_frame_({report_.frames, frames_total_, report_.cells});
    }
  }

  void add_to_report(const FrameSlot& slot) {
    ++report_.frames;
    report_.width_px = slot.left.width();
    report_.height_px = slot.left.height();
    report_.cells += slot.match.cells;
    report_.plan = slot.match.plan;
    add_stage("read", slot.read_seconds);
    for (const StageTime& stage : slot.match.stages) {
      add_stage(stage.name, stage.seconds);
    }
    if (!slot.views.empty()) {
      add_stage("views", slot.views_seconds);
    }
    if (options_.saves(SequenceOutput::kPreview)) {
      add_stage("preview", slot.preview_seconds);
    }
    add_stage("write", slot.write_seconds);
  }

  void add_stage(std::string_view name, double seconds) {
    const auto known = std::ranges::find(report_.stages, name, &SequenceStage::name);
    if (known != report_.stages.end()) {
      known->seconds += seconds;
    } else {
      report_.stages.push_back({std::string(name), seconds});
    }
  }

  const SequenceOptions& options_;
  StereoMatcher matcher_;
  ViewSynthesizer synthesizer_;
  FrameSource& left_;
  FrameSource& right_;
  SequenceLayout layout_;
  const std::function<void(const SequenceProgress&)>& on_frame_;
  std::vector<FrameSlot> slots_;
  std::optional<int> frames_total_;
  int frames_read_ = 0;    // only the reading step touches it
  SequenceReport report_;  // only the writing step touches it
  BusyClock compute_clock_;
};

}  // namespace

SequenceRunner::SequenceRunner(const SequenceOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
}

SequenceReport SequenceRunner::run(FrameSource& left, FrameSource& right,
                                   const std::filesystem::path& folder,
                                   const std::function<void(const SequenceProgress&)>& on_frame,
                                   const std::atomic<bool>* stop) const {
  constexpr int kDefaultMaxInFlight = 8;
  scheduler::Executor& executor = execution_.executor();
  const int in_flight =
      options_.in_flight.value_or(std::min(executor.thread_count() + 1, kDefaultMaxInFlight));
  Run run(options_, execution_, in_flight, left, right, folder, on_frame);
  try {
    const scheduler::FrameOutcome outcome =
        scheduler::run_frames(executor, in_flight, run.steps(), stop);
    return run.finish(outcome.interrupted);
  } catch (const FrameError& error) {
    throw Error(fmt::format("frame {} ({}, {}): {}", error.frame(), left.describe(error.frame()),
                            right.describe(error.frame()), error.what()));
  }
}

}  // namespace vantage
