#pragma once

#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"

struct AVStream;

namespace vantage {
inline namespace test {

/// A raw video: exactly the numbers that a reader has to convert.
struct RawVideo {
  std::string colours = "444";  ///< as in "C444"
  int bits = 8;
  bool full_range = false;
  int width = 0;
  int height = 0;
  std::vector<std::vector<std::vector<int>>> frames;  ///< frames, planes, samples
};

inline void put_raw_video(const std::filesystem::path& path, const RawVideo& video) {
  std::ofstream file(path, std::ios::binary);
  file << "YUV4MPEG2 W" << video.width << " H" << video.height << " F25:1 Ip A1:1 C"
       << video.colours << " XCOLORRANGE=" << (video.full_range ? "FULL" : "LIMITED") << "\n";
  for (const auto& frame : video.frames) {
    file << "FRAME\n";
    for (const auto& plane : frame) {
      for (const int sample : plane) {
        file.put(static_cast<char>(sample & 255));
        if (video.bits > 8) {
          file.put(static_cast<char>(sample >> 8));
        }
      }
    }
  }
}

/// Frame `number` of put_numbered_video().
inline Photograph numbered_frame(int width, int height, int number) {
  Photograph frame = noise<std::uint8_t>(width, height, 3, static_cast<unsigned>(number));
  auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
  for (const auto [x, y] : positions_of(3 * width, height)) {
    image.row(y)[x] = static_cast<std::uint8_t>(16 + 9 * number + image.row(y)[x] / 32);
  }
  return frame;
}

/// A video of at most 26 frames: frame i is grey of level 20 + 9i, with noise. Codings keep them
/// apart.
inline void put_numbered_video(const std::filesystem::path& path, int frames, FrameRate rate,
                               int width = 64, int height = 48, int first_number = 0) {
  VideoWriter writer(path, width, height, {.rate = rate});
  for (int i = 0; i < frames; ++i) {
    writer.write(numbered_frame(width, height, first_number + i));
  }
  writer.finish();
}

/// Which of put_numbered_video()'s frames it is.
inline int number_of_frame(const Photograph& frame) {
  const auto& image = std::get<Image<std::uint8_t>>(frame.pixels);
  double sum = 0;
  for (const auto [x, y] : positions_of(image.width() * image.channels(), image.height())) {
    sum += image.row(y)[x];
  }
  const double mean = sum / (image.width() * image.channels() * image.height());
  return static_cast<int>(std::lround((mean - 19.5) / 9));
}

/// The numbers of all frames of a video.
inline std::vector<int> frame_numbers(const std::filesystem::path& path) {
  VideoReader reader(path);
  std::vector<int> numbers;
  Photograph frame;
  while (reader.read(frame)) {
    numbers.push_back(number_of_frame(frame));
  }
  return numbers;
}

/// The same frames as put_numbered_video(); every sixth can be decoded from, and those shown before
/// it refer to the ones before that too, so that only the first one is a fresh start.
void put_open_groups_video(const std::filesystem::path& path, int frames, FrameRate rate);

/// The same frames again, with every `group` frames one that decoding can begin with; B-frames
/// between them.
void put_closed_groups_video(const std::filesystem::path& path, int frames, FrameRate rate,
                             int group);

/// The same frames again, with options of x264: "tff=1" makes them interlaced.
void put_x264_video(const std::filesystem::path& path, int frames, FrameRate rate,
                    const std::string& x264_options);

/// Copies the videos `from` into one file, a track each, which `change` may tag.
void put_tracks(
    const std::vector<std::filesystem::path>& from, const std::filesystem::path& to,
    const std::string& container,
    const std::function<void(AVStream&, int)>& change = [](AVStream&, int) {});

/// A packet of a video, in decoding order.
struct VideoPacket {
  int frame = 0;            ///< its number in order of presentation
  std::int64_t offset = 0;  ///< in the file
  bool key = false;         ///< others can be decoded from it on
};
std::vector<VideoPacket> video_packets(const std::filesystem::path& path);

/// Sound of one channel.
struct Sound {
  int samples_per_second = 0;
  std::vector<float> samples;  ///< from the beginning of the video on
};

/// Copies the video `from` into the container `container` ("mp4", "matroska"), frame i to be shown
/// at time_of(i), in frames; those for which `keeps` is false are left out. Adds `sound`, if it has
/// samples, as 16-bit numbers.
void remux_video(
    const std::filesystem::path& from, const std::filesystem::path& to,
    const std::string& container, FrameRate rate, const Sound& sound = {},
    const std::function<int(int)>& time_of = [](int frame) { return frame; },
    const std::function<bool(int)>& keeps = [](int) { return true; });

/// Sound alone, MP2 in Matroska: a tone of 48 kHz, for 0.48 s with as many channels as each of
/// `channels` says. `damaged`: packets in the middle are noise.
void put_changing_sound(const std::filesystem::path& path, const std::vector<int>& channels,
                        bool damaged = false);

/// The name of the codec of the file's sound, "" without sound.
std::string sound_codec(const std::filesystem::path& path);
/// The sound of a file; without any, no samples.
Sound read_sound(const std::filesystem::path& path);

}  // namespace test
}  // namespace vantage
