#include "engine/io/video/frame_source.h"

#include <fmt/format.h>

#include <utility>

#include "engine/error.h"
#include "engine/io/files/numbered_part.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/video/image_sequence.h"
#include "engine/io/video/video_frames.h"

namespace vantage {

void FetchedFrame::note_missing(int count, const std::string& name) {
  frames_missing = count;
  if (count > 0) {
    remarks.push_back(
        fmt::format("{} frame{} missing before {}", count, count == 1 ? " is" : "s are", name));
  }
}

void FetchedFrame::decode() {
  if (!file.empty()) {
    photograph = read_photograph(file, reading, std::move(photograph));
  } else if (!picture.is_empty()) {
    picture.convert(photograph);
  }
}

bool FrameSource::next(Photograph& frame) {
  FetchedFrame fetched;
  std::swap(fetched.photograph, frame);
  if (!fetch(fetched)) {
    return false;
  }
  fetched.decode();
  frame = std::move(fetched.photograph);
  return true;
}

std::unique_ptr<FrameSource> open_frame_source(const std::string& spec,
                                               const PhotographReading& reading) {
  namespace fs = std::filesystem;
  const auto with_reading = [&](std::unique_ptr<ImageSequence> images) {
    if (reading.deinterlaces) {
      throw UsageError(fmt::format("deinterlace has no effect on the images of {}", spec));
    }
    images->set_reading(reading);
    return images;
  };
  if (is_folder(spec)) {
    return with_reading(open_image_folder(spec));
  }
  if (is_there(spec)) {
    if (has_image_extension(spec)) {
      const fs::path path = spec;
      return with_reading(std::make_unique<ListedImages>(spec, path.parent_path(),
                                                         std::vector<fs::path>{path.filename()}));
    }
    return std::make_unique<VideoFrames>(spec, kMainVideo, reading);
  }
  if (const NumberedPart part = numbered_part(spec); part.number && is_file(part.file)) {
    if (has_image_extension(part.file)) {
      PhotographReading of_page = reading;
      of_page.page = part.number;
      return open_frame_source(part.file.string(), of_page);
    }
    return std::make_unique<VideoFrames>(part.file.string(), *part.number, reading);
  }
  if (const std::size_t mark = spec.rfind('#');
      mark != std::string::npos && is_file(spec.substr(0, mark))) {
    throw UsageError(fmt::format("{}: expected the number of a video track after #, from 0", spec));
  }
  if (spec.find('%') != std::string::npos) {
    return with_reading(open_image_pattern(spec));
  }
  if (spec.find_first_of("*?[") != std::string::npos) {
    return with_reading(open_image_glob(spec));
  }
  throw Error(fmt::format("{}: no such file or folder, expected images or a video", spec));
}

}  // namespace vantage
