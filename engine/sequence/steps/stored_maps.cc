#include "engine/sequence/steps/stored_maps.h"

#include <algorithm>
#include <filesystem>

#include "engine/io/files/checksum.h"
#include "engine/io/maps/map_io.h"

namespace vantage {

bool videos_show_views(const SequenceOptions& options) {
  return std::ranges::any_of(options.video, [](SequenceOutput output) {
    return is_per_view(output) || output == SequenceOutput::kStereo;
  });
}

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

bool read_stored_maps(const SequenceLayout& layout, const FrameRecord& record, Side reference,
                      bool needs_both, DisparityMaps& maps) {
  for (const OutputStream& stream : layout.streams()) {
    const bool is_primary = stream.output == SequenceOutput::kDisparity;
    if (!is_primary && !(needs_both && stream.output == SequenceOutput::kRightDisparity)) {
      continue;
    }
    const auto file = std::ranges::find_if(record.files, [&](const FileRecord& one) {
      return std::filesystem::path(one.name).parent_path() == stream.name;
    });
    if (file == record.files.end() || file_content(layout.folder() / file->name) != file->content) {
      return false;
    }
    const bool is_left = is_primary && reference == Side::kLeft;
    (is_left ? maps.left.disparity_px : maps.right.disparity_px) =
        read_disparity(layout.folder() / file->name);
  }
  return true;
}

}  // namespace vantage
