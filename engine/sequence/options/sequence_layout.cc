#include "engine/sequence/options/sequence_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool is_fixed_camera(const ViewPath& view) {
  return !view.moves() && std::holds_alternative<PosedCamera>(view.keys.front().pose);
}

/// For a fixed view its position, or its number among cameras; for a moving one its number among
/// those.
std::string view_name(const std::vector<ViewPath>& views, int view) {
  const auto path = views.begin() + view;
  if (path->moves()) {
    return fmt::format("path-{}", std::count_if(views.begin(), path + 1, [](const ViewPath& other) {
                         return other.moves();
                       }));
  }
  if (is_fixed_camera(*path)) {
    return fmt::format("camera-{}", std::count_if(views.begin(), path + 1, is_fixed_camera));
  }
  return to_string(std::get<BaselinePosition>(path->at(0)));
}

}  // namespace

SequenceLayout::SequenceLayout(fs::path folder, const SequenceOptions& options)
    : folder_(std::move(folder)) {
  for (const SequenceOutput output : options.save) {
    const auto known = std::ranges::find(sequence_output_names(), output,
                                         &std::pair<std::string_view, SequenceOutput>::second);
    const std::string name(known->first);
    if (is_of_all_frames(output)) {
      continue;
    }
    const std::string extension(
        traits_of(output == SequenceOutput::kDepthVideo ? options.depth_coding : VideoCoding::kH264)
            .extension);
    const bool as_video = options.saves_as_video(output);
    if (!is_per_view(output) || options.views.size() == 1) {
      streams_.push_back({output, 0, as_video, extension, name});
      continue;
    }
    for (int view = 0; view < static_cast<int>(options.views.size()); ++view) {
      streams_.push_back(
          {output, view, as_video, extension, name + "/" + view_name(options.views, view)});
    }
  }
}

bool SequenceLayout::has_videos() const {
  return std::ranges::any_of(streams_, &OutputStream::as_video);
}

fs::path SequenceLayout::file(const OutputStream& stream, int frame, const std::string& name,
                              const std::string& extension) {
  return fs::path(stream.name) /
         (name.empty() ? fmt::format("{:06}.{}", frame, extension) : name + "." + extension);
}

fs::path SequenceLayout::video(const OutputStream& stream) const {
  return folder_ / (stream.name + "." + stream.extension);
}

fs::path SequenceLayout::segment_folder(const OutputStream& stream) const {
  return journal_folder() / "segments" / stream.name;
}

fs::path SequenceLayout::segment(const OutputStream& stream, FrameRange frames) const {
  return segment_folder(stream) /
         fmt::format("{:06}-{:06}.{}", frames.first, frames.end - 1, stream.extension);
}

std::vector<std::string> SequenceLayout::video_names() const {
  std::vector<std::string> names;
  for (const OutputStream& stream : streams_) {
    if (stream.as_video) {
      names.push_back(video(stream).lexically_relative(folder_).string());
    }
  }
  return names;
}

std::vector<std::string> SequenceLayout::segment_names(FrameRange frames) const {
  std::vector<std::string> names;
  for (const OutputStream& stream : streams_) {
    if (stream.as_video) {
      names.push_back(segment(stream, frames).lexically_relative(folder_).string());
    }
  }
  return names;
}

void SequenceLayout::make_folders() const {
  make_folder(journal_folder());
  for (const OutputStream& stream : streams_) {
    make_folder(stream.as_video ? segment_folder(stream) : folder_ / stream.name);
    if (stream.as_video) {
      make_folder(video(stream).parent_path());
    }
  }
}

void make_folder(const fs::path& folder) {
  require_local_folder(folder);
  std::error_code error;
  std::vector<fs::path> changed;  // folders that get a new entry
  for (fs::path made = fs::absolute(folder, error); !error && !fs::exists(made, error);
       made = made.parent_path()) {
    changed.push_back(made.parent_path());
  }
  fs::create_directories(folder, error);
  if (error) {
    throw Error(fmt::format("{}: cannot create the folder: {}", folder.string(), error.message()));
  }
  std::ranges::for_each(changed, flush_folder);
}

}  // namespace vantage
