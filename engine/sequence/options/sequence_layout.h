#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// The table of shots, in the folder of the journal.
inline constexpr const char* kShotsFile = "shots.json";

/// One picture per frame that a run writes: as separate files, or as a video.
struct OutputStream {
  SequenceOutput output = SequenceOutput::kDisparity;
  int view = 0;  ///< number of the new view, if is_per_view()
  bool as_video = false;
  std::string extension = "mp4";  ///< of its video
  /// "disparity", or "views/0.25", "views/camera-1" and "views/path-1" if there are several views.
  /// The folder of its files, and without extension the file of its video, below the run's folder.
  std::string name;
};

/// Where the files of a run are:
///   DIR/disparity/000000.pfm, DIR/views/000000.png (one view) or DIR/views/0.25/000000.png …
///   DIR/disparity/NAME.pfm …                         of a list of pairs with names
///   DIR/preview.mp4, DIR/views/0.25.mp4 …            what is written as video
///   DIR/depth-video.mkv (.mp4, .mov), .json          the depth video, what its levels stand for
///   DIR/comfort.json, comfort.html                   the report on comfort
///   DIR/.vantage/run.json, frames-*.jsonl            the journal
///   DIR/.vantage/shots.json                          what the frames of a shot share
///   DIR/.vantage/segments/NAME/000000-000049.mp4     parts of videos until they are joined
class SequenceLayout {
 public:
  SequenceLayout(std::filesystem::path folder, const SequenceOptions& options);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path journal_folder() const { return folder_ / ".vantage"; }
  [[nodiscard]] const std::vector<OutputStream>& streams() const { return streams_; }
  [[nodiscard]] bool has_videos() const;

  /// `name`: PairDetails::name. `extension` is without the dot. Relative to the folder.
  [[nodiscard]] static std::filesystem::path file(const OutputStream& stream, int frame,
                                                  const std::string& name,
                                                  const std::string& extension);
  [[nodiscard]] std::filesystem::path video(const OutputStream& stream) const;
  [[nodiscard]] std::filesystem::path segment(const OutputStream& stream, FrameRange frames) const;
  /// What the levels of the depth video stand for; the report on comfort as "json" or "html".
  [[nodiscard]] std::filesystem::path depth_description() const {
    return folder_ / "depth-video.json";
  }
  [[nodiscard]] std::filesystem::path comfort_report(const std::string& extension) const {
    return folder_ / ("comfort." + extension);
  }
  /// Names of the reports that a run may write, relative to the folder.
  [[nodiscard]] std::vector<std::string> report_names() const {
    return {depth_description().filename().string(), comfort_report("json").filename().string(),
            comfort_report("html").filename().string()};
  }
  /// Names of all videos, or of all of their segments, relative to the folder.
  [[nodiscard]] std::vector<std::string> video_names() const;
  [[nodiscard]] std::vector<std::string> segment_names(FrameRange frames) const;

  /// Creates all folders that a run of these options needs. Throws Error.
  void make_folders() const;

 private:
  [[nodiscard]] std::filesystem::path segment_folder(const OutputStream& stream) const;

  std::filesystem::path folder_;
  std::vector<OutputStream> streams_;
};

/// Creates `folder` and its parents durably. Throws Error.
void make_folder(const std::filesystem::path& folder);

}  // namespace vantage
