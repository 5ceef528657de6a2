#pragma once

#include <filesystem>
#include <memory>
#include <string>

struct AVAudioFifo;
struct AVCodecContext;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;
struct AVStream;
struct SwrContext;
struct SwsContext;

namespace vantage {

/// Frees what FFmpeg's libraries allocated.
struct LibavFree {
  void operator()(AVAudioFifo* samples) const noexcept;
  void operator()(AVCodecContext* codec) const noexcept;
  void operator()(AVFormatContext* input) const noexcept;
  void operator()(AVFrame* frame) const noexcept;
  void operator()(AVPacket* packet) const noexcept;
  void operator()(SwrContext* resampler) const noexcept;
  void operator()(SwsContext* scaler) const noexcept;
};

using LibavCodec = std::unique_ptr<AVCodecContext, LibavFree>;
using LibavFrame = std::unique_ptr<AVFrame, LibavFree>;
using LibavInput = std::unique_ptr<AVFormatContext, LibavFree>;
using LibavPacket = std::unique_ptr<AVPacket, LibavFree>;
using LibavResampler = std::unique_ptr<SwrContext, LibavFree>;
using LibavSamples = std::unique_ptr<AVAudioFifo, LibavFree>;
using LibavScaler = std::unique_ptr<SwsContext, LibavFree>;

/// Empty ones. Throw std::bad_alloc.
LibavFrame make_libav_frame();
LibavPacket make_libav_packet();

/// What a negative return value of a function of FFmpeg's means, in lower case.
std::string libav_message(int error);

/// Has FFmpeg's libraries write nothing to stderr; its errors reach the user as ours. The first
/// call does it, for the whole process. Thread rule: may be called concurrently.
void silence_libav();

/// Opens a video file and finds out what streams it has. Only files are opened, and only the
/// containers that hold one video: no play lists, which name other files, no text, no images.
/// A file that is cut off opens where its container allows it. Throws Error when the file is
/// missing, empty or not a video.
LibavInput open_media_file(const std::filesystem::path& path);

/// Its only or main video; null when there is none, a cover picture of a song aside.
AVStream* find_video_stream(AVFormatContext& input);
/// Its only or main sound; null when there is none.
AVStream* find_sound_stream(AVFormatContext& input);
/// Has reading pass over all other streams, but for packets that opening the file has read.
void read_only(AVFormatContext& input, const AVStream& stream);

}  // namespace vantage
