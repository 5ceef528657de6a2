#include "engine/io/video/libav.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <new>
#include <vector>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/remote_input.h"
#include "engine/io/video/video_structure.h"

extern "C" {
#include <libavutil/macros.h>
}

namespace vantage {
namespace {

/// Containers, and raw streams with frames of one video.
constexpr const char* kVideoContainers =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,mpegvideo,m4v,h264,hevc,av1,obu,ivf,"
    "vc1,mjpeg,yuv4mpegpipe,nut,flv,live_flv,asf,ogg,mxf,dv,gif,apng,wtv,rm,gxf,dirac";

/// Decoders of what cameras, recorders and editing programs write. FFmpeg has about 500 more, many
/// of them for old games; few people test those against damaged files. Of recorders of screens,
/// those for games and programs, whose films in stereo are recorded side by side (fraps to fic); of
/// capture cards and the programs sold with them, those of Canopus and Grass Valley (cllc, hqx,
/// hq_hqa), NewTek (speedhq), Apple (aic), Matrox (m101), and their orders of raw pixels (v210x,
/// yuv4, y41p). Not those of conferences and remote desktops.
constexpr const char* kFootageDecoders =
    "h264,hevc,av1,libdav1d,libaom-av1,libgav1,vp8,vp9,libvpx,libvpx-vp9,mpeg1video,mpeg2video,"
    "mpegvideo,mpeg4,msmpeg4v1,msmpeg4v2,msmpeg4,h261,h263,h263i,h263p,flv,vp6,vp6a,vp6f,wmv1,wmv2,"
    "wmv3,vc1,rv10,rv20,rv30,rv40,svq1,svq3,cinepak,theora,dirac,mjpeg,mjpegb,prores,dnxhd,cfhd,"
    "dvvideo,hap,ffv1,ffvhuff,huffyuv,utvideo,magicyuv,lagarith,qtrle,rawvideo,v210,v308,v408,v410,"
    "r210,r10k,jpeg2000,libopenjpeg,png,apng,gif,"
    "fraps,dxtory,camstudio,zmbv,camtasia,tscc2,fic,cllc,hqx,hq_hqa,speedhq,aic,m101,v210x,yuv4,"
    "y41p,"
    "aac,aac_fixed,aac_latm,libfdk_aac,ac3,ac3_fixed,eac3,dca,truehd,mlp,mp1,mp1float,mp2,mp2float,"
    "mp3,mp3float,flac,alac,opus,libopus,vorbis,libvorbis,wmav1,wmav2,wmapro,amrnb,amrwb,"
    "libopencore_amrnb,libopencore_amrwb,cook,speex,libspeex,nellymoser,adpcm_ms,adpcm_ima_wav,"
    "adpcm_ima_qt,adpcm_swf,pcm_alaw,pcm_mulaw,pcm_u8,pcm_s8,pcm_s16le,pcm_s16be,pcm_s24le,"
    "pcm_s24be,pcm_s32le,pcm_s32be,pcm_f32le,pcm_f32be,pcm_f64le,pcm_f64be,pcm_bluray,pcm_dvd,"
    "s302m";

namespace fs = std::filesystem;

constexpr const char* kWithoutThem = "cannot read or write videos";

void check_is_video_file(const fs::path& path) {
  if (!is_there(path)) {
    throw Error(fmt::format("cannot read {}: no such file", path.string()));
  }
  if (!is_file(path)) {
    throw Error(fmt::format("cannot read {}: expected a video file", path.string()));
  }
  if (bytes_of_file(path) == 0) {
    throw Error(fmt::format("cannot read {}: the file is empty", path.string()));
  }
}

/// Options for the decoders that find_streams() may start: none may allocate the size in a damaged
/// header.
class ProbeOptions {
 public:
  explicit ProbeOptions(unsigned streams) : options_(streams, nullptr) {
    for (AVDictionary*& option : options_) {
      libav().av_dict_set_int(&option, "max_pixels", max_image_pixels(), 0);
      libav().av_dict_set_int(&option, "threads", 1, 0);
    }
  }
  ProbeOptions(const ProbeOptions&) = delete;
  ProbeOptions& operator=(const ProbeOptions&) = delete;
  ~ProbeOptions() {
    for (AVDictionary*& option : options_) {
      libav().av_dict_free(&option);
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
      codec_("libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR), kWithoutThem),
      resample_("libswresample.so." AV_STRINGIFY(LIBSWRESAMPLE_VERSION_MAJOR), kWithoutThem),
      scale_("libswscale.so." AV_STRINGIFY(LIBSWSCALE_VERSION_MAJOR), kWithoutThem),
      util_("libavutil.so." AV_STRINGIFY(LIBAVUTIL_VERSION_MAJOR), kWithoutThem) {}

const LibavFunctions& libav() {
  static const LibavFunctions functions;
  return functions;
}

void LibavFree::operator()(AVAudioFifo* samples) const noexcept {
  libav().av_audio_fifo_free(samples);
}
void LibavFree::operator()(AVCodecContext* codec) const noexcept {
  libav().avcodec_free_context(&codec);
}
void LibavFree::operator()(AVFormatContext* input) const noexcept {
  const std::unique_ptr<RemoteInput> remote(static_cast<RemoteInput*>(input->opaque));
  libav().avformat_close_input(&input);
}
void LibavFree::operator()(AVFrame* frame) const noexcept { libav().av_frame_free(&frame); }
void LibavFree::operator()(AVPacket* packet) const noexcept { libav().av_packet_free(&packet); }
void LibavFree::operator()(SwrContext* resampler) const noexcept { libav().swr_free(&resampler); }
void LibavFree::operator()(SwsContext* scaler) const noexcept { libav().sws_freeContext(scaler); }

LibavFrame make_libav_frame() {
  LibavFrame frame(libav().av_frame_alloc());
  if (frame == nullptr) {
    throw std::bad_alloc();
  }
  return frame;
}

LibavFrame another_reference(const AVFrame& frame) {
  LibavFrame reference(libav().av_frame_clone(&frame));
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
  libav().av_strerror(error, buffer.data(), buffer.size());
  std::string message(buffer.data());
  if (!message.empty()) {
    message[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(message[0])));
  }
  return message;
}

void silence_libav() {
  static const bool silent = [] {
    libav().av_log_set_level(AV_LOG_QUIET);
    return true;
  }();
  (void)silent;
}

void limit_to_footage(AVFormatContext& input) {
  constexpr unsigned kMaxStreams = 100;
  constexpr std::int64_t kProbedBytes = 5'000'000;
  input.format_whitelist = libav().av_strdup(kVideoContainers);
  input.codec_whitelist = libav().av_strdup(kFootageDecoders);
  input.max_streams = kMaxStreams;
  input.probesize = kProbedBytes;
}

bool is_for_footage(const AVCodec& decoder) {
  return libav().av_match_list(decoder.name, kFootageDecoders, ',') > 0;
}

LibavInput open_media_file(const fs::path& path) {
  silence_libav();
  check_is_video_file(path);
  check_video_tables(path);
  if (find_video_extent(path) == VideoExtent::kWithoutIndex) {
    throw Error(
        fmt::format("{}: is an MP4 without index (moov): truncated after {} bytes, or its "
                    "recording was not finished",
                    path.string(), bytes_of_file(path)));
  }
  AVFormatContext* opened = libav().avformat_alloc_context();
  if (opened == nullptr) {
    throw std::bad_alloc();
  }
  limit_to_footage(*opened);
  opened->protocol_whitelist = libav().av_strdup(is_address(path) ? "none" : "file");
  std::unique_ptr<RemoteInput> remote;
  if (is_address(path)) {
    remote = std::make_unique<RemoteInput>(path);
    remote->attach_to(*opened);
  }
  // "file:" keeps names with a colon from being parsed as URLs. On failure `opened` is freed.
  const std::string address = "file:" + path.string();
  int result = libav().avformat_open_input(&opened, address.c_str(), nullptr, nullptr);
  if (result < 0 && remote != nullptr) {
    remote->rethrow();
  }
  LibavInput input(result < 0 ? nullptr : opened);
  if (result >= 0) {
    (void)remote.release();  // LibavFree has it
    result = libav().avformat_find_stream_info(input.get(), ProbeOptions(input->nb_streams).data());
    (void)read_error(*input);
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
  AVStream* sound = find_stream(input, AVMEDIA_TYPE_AUDIO);
  // FFmpeg passes over a sound of which it could find out nothing.
  for (unsigned i = 0; i < input.nb_streams && sound == nullptr; ++i) {
    AVStream* stream = input.streams[i];
    sound = stream->codecpar->codec_type == AVMEDIA_TYPE_AUDIO ? stream : nullptr;
  }
  return sound;
}

void read_only(AVFormatContext& input, const AVStream& stream) {
  for (unsigned i = 0; i < input.nb_streams; ++i) {
    input.streams[i]->discard = input.streams[i] == &stream ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
  }
}

int read_error(const AVFormatContext& input) {
  if (input.opaque != nullptr) {
    static_cast<const RemoteInput*>(input.opaque)->rethrow();
  }
  return input.pb == nullptr ? 0 : std::min(input.pb->error, 0);
}

int fetch_packet(AVFormatContext& input, AVPacket& packet) {
  const int result = libav().av_read_frame(&input, &packet);
  const int error = read_error(input);
  return result == AVERROR_EOF && error < 0 ? error : result;
}

}  // namespace vantage
