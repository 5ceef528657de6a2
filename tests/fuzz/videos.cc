// Films: our readers of containers, and a few frames as the engine sees them.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <memory>
#include <optional>

#include "engine/io/video/frame_source.h"
#include "engine/io/video/streams/streamed_video.h"
#include "engine/io/video/video_structure.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

void read_structure(Bytes bytes) {
  const std::filesystem::path file = file_of(bytes);
  (void)find_video_extent(file);
  (void)further_views_in_boxes(file);
  check_video_tables(file);
}

void read_frames(Bytes bytes) {
  const auto source = open_frame_source(file_of(bytes).string());
  require(source->frame_count() >= 0, "a number of frames");
  (void)source->frame_rate();
  (void)source->film_format();
  Photograph frame;
  constexpr int kFrames = 3;
  for (int i = 0; i < kFrames && source->next(frame); ++i) {
    require(frame.width() >= 1 && frame.height() >= 1, "a picture");
  }
  if (source->frame_count() > kFrames + 2) {
    source->skip_to(source->frame_count() - 1);
    (void)source->next(frame);
  }
}

/// The bytes in a pipe; the last one says whether they are raw pictures.
void read_stream(Bytes bytes) {
  const std::filesystem::path pipe = file_of({}, "input.pipe");
  std::filesystem::remove(pipe);
  require(::mkfifo(pipe.c_str(), 0600) == 0, "a pipe");
  const int writer = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  const ssize_t written = ::write(writer, bytes.data(), std::min<std::size_t>(bytes.size(), 60000));
  auto input = std::make_unique<StreamInput>(pipe.string(), nullptr);
  ::close(writer);
  require(written >= 0, "a pipe that takes all");
  std::optional<RawVideoShape> raw;
  if (!bytes.empty() && bytes.back() == 7) {
    raw = {.width_px = 6, .height_px = 4, .pixel_format = "gray"};
  }
  StreamedVideo video(std::move(input), raw, {25, 1});
  FetchedFrame frame;
  for (int i = 0; i < 3 && video.fetch(frame); ++i) {
    frame.decode();
    require(frame.photograph.width() >= 1 && frame.photograph.height() >= 1, "a picture");
  }
}

const Registration kStream("stream", read_stream);
const Registration kStructure("video_structure", read_structure);
const Registration kVideo("video", read_frames);

}  // namespace
}  // namespace vantage::fuzz
