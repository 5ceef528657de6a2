#include "engine/io/video/libav.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <new>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_structure.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/audio_fifo.h>
#include <libavutil/macros.h>
#include <libswresample/swresample.h>
#include <libswscale/swscale.h>
}

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWithoutThem = "cannot read or write videos";

void check_is_video_file(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) {
    throw Error(fmt::format("cannot read {}: no such file", path.string()));
  }
  if (!fs::is_regular_file(status)) {
    throw Error(fmt::format("cannot read {}: expected a video file", path.string()));
  }
  std::error_code error;
  if (fs::file_size(path, error) == 0 || error) {
    throw Error(fmt::format("cannot read {}: the file is empty", path.string()));
  }
}

/// Options for the decoders that find_streams() may start: none may allocate the size in a damaged
/// header.
class ProbeOptions {
 public:
  explicit ProbeOptions(unsigned streams) : options_(streams, nullptr) {
    for (AVDictionary*& option : options_) {
      av_dict_set_int(&option, "max_pixels", max_image_pixels(), 0);
      av_dict_set_int(&option, "threads", 1, 0);
    }
  }
  ProbeOptions(const ProbeOptions&) = delete;
  ProbeOptions& operator=(const ProbeOptions&) = delete;
  ~ProbeOptions() {
    for (AVDictionary*& option : options_) {
      av_dict_free(&option);
    }
  }
  AVDictionary** data() { return options_.empty() ? nullptr : options_.data(); }

 private:
  std::vector<AVDictionary*> options_;
};

AVStream* find_stream(AVFormatContext& input, AVMediaType type) {
  const int index = libav().av_find_best_stream(&input, type, -1, -1, nullptr, 0);
  return index < 0 ? nullptr : input.streams[index];
}

}  // namespace

// The major versions of the headers: FFmpeg changes types only between major versions.
LibavFunctions::LibavFunctions()
    : format_("libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR), kWithoutThem),
      codec_("libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR), kWithoutThem) {}

const LibavFunctions& libav() {
  static const LibavFunctions functions;
  return functions;
}

void LibavFree::operator()(AVAudioFifo* samples) const noexcept { av_audio_fifo_free(samples); }
void LibavFree::operator()(AVCodecContext* codec) const noexcept {
  libav().avcodec_free_context(&codec);
}
void LibavFree::operator()(AVFormatContext* input) const noexcept {
  libav().avformat_close_input(&input);
}
void LibavFree::operator()(AVFrame* frame) const noexcept { av_frame_free(&frame); }
void LibavFree::operator()(AVPacket* packet) const noexcept { libav().av_packet_free(&packet); }
void LibavFree::operator()(SwrContext* resampler) const noexcept { swr_free(&resampler); }
void LibavFree::operator()(SwsContext* scaler) const noexcept { sws_freeContext(scaler); }

LibavFrame make_libav_frame() {
  LibavFrame frame(av_frame_alloc());
  if (frame == nullptr) {
    throw std::bad_alloc();
  }
  return frame;
}

LibavFrame another_reference(const AVFrame& frame) {
  LibavFrame reference(av_frame_clone(&frame));
  if (reference == nullptr) {
    throw std::bad_alloc();
  }
  return reference;
}

std::size_t bytes_of(const AVFrame& frame) {
  std::size_t bytes = 0;
  for (const AVBufferRef* buffer : frame.buf) {
    bytes += buffer == nullptr ? 0 : buffer->size;
  }
  return bytes;
}

LibavPacket make_libav_packet() {
  LibavPacket packet(libav().av_packet_alloc());
  if (packet == nullptr) {
    throw std::bad_alloc();
  }
  return packet;
}

std::string libav_message(int error) {
  if (error == AVERROR(EPERM)) {
    return "invalid data found";  // several decoders return −1
  }
  std::array<char, AV_ERROR_MAX_STRING_SIZE> buffer{};
  av_strerror(error, buffer.data(), buffer.size());
  std::string message(buffer.data());
  if (!message.empty()) {
    message[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(message[0])));
  }
  return message;
}

void silence_libav() {
  static const bool silent = [] {
    av_log_set_level(AV_LOG_QUIET);
    return true;
  }();
  (void)silent;
}

LibavInput open_media_file(const fs::path& path) {
  silence_libav();
  check_is_video_file(path);
  check_video_tables(path);
  if (find_video_extent(path) == VideoExtent::kWithoutIndex) {
    throw Error(
        fmt::format("{}: is an MP4 without index (moov): truncated after {} bytes, or its "
                    "recording was not finished",
                    path.string(), fs::file_size(path)));
  }
  AVFormatContext* opened = libav().avformat_alloc_context();
  if (opened == nullptr) {
    throw std::bad_alloc();
  }
  opened->format_whitelist = av_strdup(kVideoContainers);
  opened->protocol_whitelist = av_strdup("file");
  // "file:" keeps names with a colon from being parsed as URLs. On failure `opened` is freed.
  const std::string address = "file:" + path.string();
  int result = libav().avformat_open_input(&opened, address.c_str(), nullptr, nullptr);
  LibavInput input(result < 0 ? nullptr : opened);
  if (result >= 0) {
    result = libav().avformat_find_stream_info(input.get(), ProbeOptions(input->nb_streams).data());
  }
  if (result < 0) {
    throw Error(fmt::format("{}: is not a video, or a truncated one ({})", path.string(),
                            libav_message(result)));
  }
  return input;
}

std::vector<AVStream*> video_streams(AVFormatContext& input) {
  std::vector<AVStream*> videos;
  for (unsigned i = 0; i < input.nb_streams; ++i) {
    AVStream* stream = input.streams[i];
    if (stream->codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
        (stream->disposition & AV_DISPOSITION_ATTACHED_PIC) == 0) {
      videos.push_back(stream);
    }
  }
  return videos;
}

std::string name_of_track(const fs::path& path, int track) {
  return track == kMainVideo ? path.string() : fmt::format("{}#{}", path.string(), track);
}

AVStream* find_video_stream(AVFormatContext& input, int track) {
  if (track != kMainVideo) {
    const std::vector<AVStream*> videos = video_streams(input);
    return static_cast<std::size_t>(track) < videos.size() ? videos[static_cast<std::size_t>(track)]
                                                           : nullptr;
  }
  AVStream* stream = find_stream(input, AVMEDIA_TYPE_VIDEO);
  const bool cover = stream != nullptr && (stream->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0;
  return cover ? nullptr : stream;
}

AVStream* find_sound_stream(AVFormatContext& input) {
  return find_stream(input, AVMEDIA_TYPE_AUDIO);
}

void read_only(AVFormatContext& input, const AVStream& stream) {
  for (unsigned i = 0; i < input.nb_streams; ++i) {
    input.streams[i]->discard = input.streams[i] == &stream ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  }
}

}  // namespace vantage
