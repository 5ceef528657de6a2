#include <algorithm>
#include <filesystem>

#include "engine/io/files/checksum.h"
#include "engine/io/maps/map_io.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Whether the files of a frame hold the maps that its pictures in videos are made from. False if
/// more is needed than maps contain: masks of filled pixels, or what later frames take from this
/// one.
bool maps_are_stored(const SequenceOptions& options) {
  const bool needs_masks = options.temporal.uses_past() ||
                           options.saves_as_video(SequenceOutput::kUnmatched) ||
                           options.saves_as_video(SequenceOutput::kCyclopeanOcclusion) ||
                           options.saves_as_video(SequenceOutput::kRightUnmatched);
  const bool has_both =
      options.match.reference == Side::kLeft && options.saves(SequenceOutput::kRightDisparity);
  // PNG rounds.
  return options.map_format != "png" && options.saves(SequenceOutput::kDisparity) && !needs_masks &&
         (has_both || !videos_show_views(options));
}

bool has_stored_maps(const FrameTools& tools, const FrameSlot& slot) {
  // Stored right maps are on other rows than those that views are made from.
  return slot.stored != nullptr && !tools.options.corrects_rows() && maps_are_stored(tools.options);
}

/// False if a file has changed since it was written.
bool read_stored_maps(const FrameTools& tools, FrameSlot& slot) {
  for (const OutputStream& stream : tools.layout.streams()) {
    const bool is_primary = stream.output == SequenceOutput::kDisparity;
    if (!is_primary &&
        !(stream.output == SequenceOutput::kRightDisparity && needs_views(tools.options, slot))) {
      continue;
    }
    const auto file = std::ranges::find_if(slot.stored->files, [&](const FileRecord& one) {
      return std::filesystem::path(one.name).parent_path() == stream.name;
    });
    if (file == slot.stored->files.end() ||
        file_content(tools.layout.folder() / file->name) != file->content) {
      return false;
    }
    const bool is_left = is_primary && tools.options.match.reference == Side::kLeft;
    (is_left ? slot.maps.left : slot.maps.right).disparity_px =
        read_disparity(tools.layout.folder() / file->name);
  }
  return true;
}

/// Takes the maps of a stored frame from its files if all that is needed is in them with its
/// original content; otherwise it is no longer a stored frame.
void read_maps(const FrameTools& tools, FrameSlot& slot) {
  slot.maps_are_read = read_stored_maps(tools, slot);
  if (!slot.maps_are_read) {
    slot.stored = nullptr;
  }
}

}  // namespace

StepEntry read_maps_step() {
  return {.name = "read maps",
          .account = "read",
          .kind = WorkKind::kReading,
          .phase = StepPhase::kCompute,
          .make = make_step<has_stored_maps, read_maps>};
}

}  // namespace vantage
