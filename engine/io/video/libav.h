#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

struct AVAudioFifo;
struct AVCodec;
struct AVCodecContext;
struct AVFilterContext;
struct AVFilterGraph;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;
struct AVStream;
struct SwrContext;
struct SwsContext;

namespace vantage {

/// Deleter for objects of FFmpeg's libraries.
struct LibavFree {
  void operator()(AVAudioFifo* samples) const noexcept;
  void operator()(AVCodecContext* codec) const noexcept;
  void operator()(AVFilterGraph* graph) const noexcept;
  void operator()(AVFormatContext* input) const noexcept;
  void operator()(AVFrame* frame) const noexcept;
  void operator()(AVPacket* packet) const noexcept;
  void operator()(SwrContext* resampler) const noexcept;
  void operator()(SwsContext* scaler) const noexcept;
};

using LibavCodec = std::unique_ptr<AVCodecContext, LibavFree>;
using LibavFilterGraph = std::unique_ptr<AVFilterGraph, LibavFree>;
using LibavFrame = std::unique_ptr<AVFrame, LibavFree>;
using LibavInput = std::unique_ptr<AVFormatContext, LibavFree>;
using LibavPacket = std::unique_ptr<AVPacket, LibavFree>;
using LibavResampler = std::unique_ptr<SwrContext, LibavFree>;
using LibavSamples = std::unique_ptr<AVAudioFifo, LibavFree>;
using LibavScaler = std::unique_ptr<SwsContext, LibavFree>;

/// Empty objects. Throw std::bad_alloc.
LibavFrame make_libav_frame();
LibavPacket make_libav_packet();
/// To the same pixels. Throws std::bad_alloc.
LibavFrame another_reference(const AVFrame& frame);
/// Memory of its pixels.
std::size_t bytes_of(const AVFrame& frame);

/// Message for a negative return value of an FFmpeg function, in lower case.
std::string libav_message(int error);

/// Keeps FFmpeg's libraries from writing to stderr; their errors reach the user as ours. The first
/// call applies to the whole process. Thread rule: may be called concurrently.
void silence_libav();

/// Leaves the demultiplexers and decoders that footage uses, and limits what is read to find out
/// what a file holds. No demultiplexer opens what its content names. Before avformat_open_input().
void limit_to_footage(AVFormatContext& input);
/// Whether a decoder is one of these.
bool is_for_footage(const AVCodec& decoder);

/// Opens a video file, local or at an address, and determines its streams. Only this file is
/// opened, and only containers that hold one video: no playlists, which name other files, no text,
/// no images. A truncated file opens if its container allows it. Throws Error when the file is
/// missing, empty or not a video.
LibavInput open_media_file(const std::filesystem::path& path);

/// Its videos in the order of the file, without cover art.
std::vector<AVStream*> video_streams(AVFormatContext& input);
/// Number of the only or main one instead of an index.
constexpr int kMainVideo = -1;
/// "film.mkv", "film.mkv#1".
std::string name_of_track(const std::filesystem::path& path, int track);
/// That of video_streams(), or its only or main video; null when there is none.
AVStream* find_video_stream(AVFormatContext& input, int track = kMainVideo);
/// Its only or main sound, also one that nothing is known about; null when there is none.
AVStream* find_sound_stream(AVFormatContext& input);
/// Discards the packets of all other streams, except those already read by opening the file.
void read_only(AVFormatContext& input, const AVStream& stream);
/// FFmpeg's error when the system could not read the file, else 0. Demultiplexers may take it for
/// the end. Throws what reading from an address has thrown; so does fetch_packet().
int read_error(const AVFormatContext& input);
/// The next packet: 0, AVERROR_EOF after the last one, or another error of FFmpeg.
int fetch_packet(AVFormatContext& input, AVPacket& packet);

}  // namespace vantage
