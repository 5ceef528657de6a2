#include <algorithm>
#include <filesystem>

#include "engine/io/files/checksum.h"
#include "engine/io/maps/map_io.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Whether the files of a frame hold the maps that its pictures in videos, and its flicker
/// measurement, are made from. False if more is needed than maps contain: masks of filled pixels,
/// or what later frames take from this one.
bool maps_are_stored(const SequenceOptions& options) {
  const bool needs_masks = options.temporal.uses_past() ||
                           options.saves_as_video(SequenceOutput::kUnmatched) ||
                           options.saves_as_video(SequenceOutput::kCyclopeanOcclusion) ||
                           options.saves_as_video(SequenceOutput::kRightUnmatched);
  const bool needs_both =
      videos_show_views(options) || (options.measure_flicker && !options.views.empty());
  const bool has_both =
      options.match.reference == Side::kLeft && options.saves(SequenceOutput::kRightDisparity);
  // PNG rounds.
  return options.map_format != "png" && options.saves(SequenceOutput::kDisparity) && !needs_masks &&
         (has_both || !needs_both);
}

/// Takes the maps of a stored frame from its files if all that is needed is in them with its
/// original content; otherwise it is no longer a stored frame.
class ReadMapsStep final : public RunStep {
 public:
  explicit ReadMapsStep(const FrameTools& tools)
      : options_(tools.options),
        layout_(tools.layout),
        maps_are_stored_(maps_are_stored(tools.options)) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return slot.stored != nullptr && maps_are_stored_;
  }

  void run(FrameSlot& slot) override {
    slot.maps_are_read = read(slot);
    if (!slot.maps_are_read) {
      slot.stored = nullptr;
    }
  }

 private:
  /// False if a file has changed since it was written.
  [[nodiscard]] bool read(FrameSlot& slot) const {
    for (const OutputStream& stream : layout_.streams()) {
      const bool is_primary = stream.output == SequenceOutput::kDisparity;
      if (!is_primary &&
          !(stream.output == SequenceOutput::kRightDisparity && needs_views(options_, slot))) {
        continue;
      }
      const auto file = std::ranges::find_if(slot.stored->files, [&](const FileRecord& one) {
        return std::filesystem::path(one.name).parent_path() == stream.name;
      });
      if (file == slot.stored->files.end() ||
          file_content(layout_.folder() / file->name) != file->content) {
        return false;
      }
      const bool is_left = is_primary && options_.match.reference == Side::kLeft;
      (is_left ? slot.maps.left : slot.maps.right).disparity_px =
          read_disparity(layout_.folder() / file->name);
    }
    return true;
  }

  const SequenceOptions& options_;
  const SequenceLayout& layout_;
  bool maps_are_stored_;
};

}  // namespace

StepEntry read_maps_step() {
  return {.name = "read maps",
          .account = "read",
          .kind = WorkKind::kReading,
          .phase = StepPhase::kCompute,
          .make = make_step<ReadMapsStep>};
}

}  // namespace vantage
