#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <new>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/writing/sound_packets.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/audio_fifo.h>
#include <libavutil/opt.h>
#include <libswresample/swresample.h>
}

namespace vantage {
namespace {

constexpr std::int64_t kBitsPerSecondAndChannel = 96'000;
constexpr int kUsualSampleRate = 48'000;

LibavCodec make_codec(const AVCodec* codec) {
  LibavCodec result(libav().avcodec_alloc_context3(codec));
  if (result == nullptr) {
    throw std::bad_alloc();
  }
  return result;
}

bool encodes_sample_rate(const AVCodec& encoder, int rate) {
  for (const int* known = encoder.supported_samplerates; known != nullptr && *known != 0; ++known) {
    if (*known == rate) {
      return true;
    }
  }
  return false;
}

/// Format of a frame's samples.
struct SoundFormat {
  AVChannelLayout layout{};
  int sample_format = AV_SAMPLE_FMT_NONE;
  int rate = 0;

  SoundFormat() = default;
  explicit SoundFormat(const AVFrame& frame)
      : sample_format(frame.format), rate(frame.sample_rate) {
    if (frame.ch_layout.order == AV_CHANNEL_ORDER_UNSPEC) {
      libav().av_channel_layout_default(&layout, frame.ch_layout.nb_channels);
    } else if (libav().av_channel_layout_copy(&layout, &frame.ch_layout) < 0) {
      throw std::bad_alloc();
    }
  }
  SoundFormat(SoundFormat&& other) noexcept { swap(other); }
  SoundFormat& operator=(SoundFormat&& other) noexcept {
    swap(other);
    return *this;
  }
  ~SoundFormat() { libav().av_channel_layout_uninit(&layout); }

  [[nodiscard]] bool equals(const SoundFormat& other) const {
    return sample_format == other.sample_format && rate == other.rate &&
           libav().av_channel_layout_compare(&layout, &other.layout) == 0;
  }

 private:
  void swap(SoundFormat& other) noexcept {
    std::swap(layout, other.layout);
    std::swap(sample_format, other.sample_format);
    std::swap(rate, other.rate);
  }
};

class EncodedSound : public SoundPackets {
 public:
  explicit EncodedSound(SoundInput input);
  ~EncodedSound() override { libav().avcodec_parameters_free(&parameters_); }

  [[nodiscard]] const AVCodecParameters& parameters() const override { return *parameters_; }
  [[nodiscard]] AVRational time_unit() const override { return encoder_->time_base; }
  bool next() override;

 private:
  void open_decoder();
  void open_encoder();
  /// Adapts the resampler to `frame`: television recordings switch between stereo, mono and 5.1.
  void follow_format(const AVFrame& frame);
  /// Sends the encoder its next frame, decoding as needed, or the end of the stream.
  void feed_encoder();
  /// Decodes the next samples into the queue; false after the last ones.
  bool decode_more();
  /// Converts `frame`, or the resampler's delayed samples if it is null, and queues the samples
  /// inside the part. The frame has the resampler's input format.
  void queue_samples(const AVFrame* frame);

  SoundInput input_;
  LibavCodec decoder_;
  LibavCodec encoder_;
  LibavResampler resampler_;  ///< null before the first frame
  SoundFormat resampled_;     ///< its input format
  LibavSamples queue_;
  LibavPacket source_packet_ = make_libav_packet();
  LibavFrame decoded_ = make_libav_frame();
  AVCodecParameters* parameters_ = nullptr;
  std::int64_t samples_of_part_ = 0;
  std::int64_t next_sample_ = AV_NOPTS_VALUE;     ///< index, in the part, of the next one decoded
  std::int64_t next_to_encode_ = AV_NOPTS_VALUE;  ///< index of the first one in the queue
  bool decoded_all_ = false;
};

EncodedSound::EncodedSound(SoundInput input) : input_(std::move(input)) {
  open_decoder();
  open_encoder();
}

void EncodedSound::open_decoder() {
  const AVCodecParameters& source = *input_.stream()->codecpar;
  const AVCodec* codec = libav().avcodec_find_decoder(source.codec_id);
  if (codec == nullptr || !is_for_footage(*codec)) {
    input_.fail(std::string("no decoder for ") + libav().avcodec_get_name(source.codec_id));
  }
  decoder_ = make_codec(codec);
  int result = libav().avcodec_parameters_to_context(decoder_.get(), &source);
  decoder_->pkt_timebase = input_.stream()->time_base;
  decoder_->thread_count = 1;
  if (result >= 0) {
    result = libav().avcodec_open2(decoder_.get(), codec, nullptr);
  }
  if (result < 0 || decoder_->sample_rate <= 0 || decoder_->ch_layout.nb_channels <= 0) {
    input_.fail(result < 0 ? libav_message(result) : "no sample rate or channels");
  }
}

void EncodedSound::open_encoder() {
  const AVCodec* codec = libav().avcodec_find_encoder_by_name("aac");
  if (codec == nullptr) {
    throw Error("FFmpeg was built without its AAC encoder");
  }
  encoder_ = make_codec(codec);
  const int channels = std::min(decoder_->ch_layout.nb_channels, 2);
  libav().av_channel_layout_default(&encoder_->ch_layout, channels);
  encoder_->sample_rate =
      encodes_sample_rate(*codec, decoder_->sample_rate) ? decoder_->sample_rate : kUsualSampleRate;
  encoder_->sample_fmt = AV_SAMPLE_FMT_FLTP;
  encoder_->time_base = {1, encoder_->sample_rate};
  encoder_->bit_rate = kBitsPerSecondAndChannel * channels;
  encoder_->thread_count = 1;
  encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  if (const int result = libav().avcodec_open2(encoder_.get(), codec, nullptr); result < 0) {
    input_.fail("AAC: " + libav_message(result));
  }
  samples_of_part_ = std::llround(input_.length_seconds() * encoder_->sample_rate);
  parameters_ = libav().avcodec_parameters_alloc();
  queue_.reset(libav().av_audio_fifo_alloc(AV_SAMPLE_FMT_FLTP, channels, encoder_->frame_size));
  if (parameters_ == nullptr || queue_ == nullptr ||
      libav().avcodec_parameters_from_context(parameters_, encoder_.get()) < 0) {
    throw std::bad_alloc();
  }
}

void EncodedSound::follow_format(const AVFrame& frame) {
  SoundFormat format(frame);
  if (resampler_ != nullptr && format.equals(resampled_)) {
    return;
  }
  if (resampler_ != nullptr) {
    queue_samples(nullptr);
  }
  SwrContext* resampler = nullptr;
  int result = libav().swr_alloc_set_opts2(
      &resampler, &encoder_->ch_layout, AV_SAMPLE_FMT_FLTP, encoder_->sample_rate, &format.layout,
      static_cast<AVSampleFormat>(format.sample_format), format.rate, 0, nullptr);
  resampler_.reset(resampler);
  if (result >= 0 && encoder_->ch_layout.nb_channels == 1) {
    // Mixing two channels to one must not raise the level.
    result = libav().av_opt_set_double(resampler, "rematrix_maxval", 1, 0);
  }
  if (result >= 0) {
    result = libav().swr_init(resampler_.get());
  }
  if (result < 0) {
    input_.fail(libav_message(result));
  }
  resampled_ = std::move(format);
}

bool EncodedSound::next() {
  for (;;) {
    const int result = libav().avcodec_receive_packet(encoder_.get(), &packet());
    if (result >= 0) {
      return true;
    }
    if (result == AVERROR_EOF) {
      return false;
    }
    if (result != AVERROR(EAGAIN)) {
      input_.fail("AAC: " + libav_message(result));
    }
    feed_encoder();
  }
}

void EncodedSound::feed_encoder() {
  while (!decoded_all_ && libav().av_audio_fifo_size(queue_.get()) < encoder_->frame_size) {
    decoded_all_ = !decode_more();
  }
  const int samples = std::min(libav().av_audio_fifo_size(queue_.get()), encoder_->frame_size);
  if (samples == 0) {
    libav().avcodec_send_frame(encoder_.get(), nullptr);
    return;
  }
  const LibavFrame frame = make_libav_frame();
  frame->format = AV_SAMPLE_FMT_FLTP;
  frame->sample_rate = encoder_->sample_rate;
  frame->nb_samples = samples;
  if (libav().av_channel_layout_copy(&frame->ch_layout, &encoder_->ch_layout) < 0 ||
      libav().av_frame_get_buffer(frame.get(), 0) < 0) {
    throw std::bad_alloc();
  }
  libav().av_audio_fifo_read(queue_.get(), reinterpret_cast<void**>(frame->extended_data), samples);
  frame->pts = next_to_encode_;
  next_to_encode_ += samples;
  if (const int result = libav().avcodec_send_frame(encoder_.get(), frame.get()); result < 0) {
    input_.fail("AAC: " + libav_message(result));
  }
}

bool EncodedSound::decode_more() {
  for (;;) {
    const int result = libav().avcodec_receive_frame(decoder_.get(), decoded_.get());
    if (result >= 0) {
      follow_format(*decoded_);
      queue_samples(decoded_.get());
      return true;
    }
    if (result == AVERROR_EOF) {
      if (resampler_ != nullptr) {
        queue_samples(nullptr);
      }
      return false;
    }
    if (result != AVERROR(EAGAIN)) {
      input_.fail(libav_message(result));
    }
    int sent = 0;
    if (input_.read(*source_packet_)) {
      sent = libav().avcodec_send_packet(decoder_.get(), source_packet_.get());
      libav().av_packet_unref(source_packet_.get());
    } else {
      sent = libav().avcodec_send_packet(decoder_.get(), nullptr);
    }
    if (sent < 0) {
      input_.fail(libav_message(sent));
    }
  }
}

void EncodedSound::queue_samples(const AVFrame* frame) {
  const int capacity =
      libav().swr_get_out_samples(resampler_.get(), frame != nullptr ? frame->nb_samples : 0);
  if (capacity <= 0) {
    return;
  }
  const LibavFrame converted = make_libav_frame();
  converted->format = AV_SAMPLE_FMT_FLTP;
  converted->nb_samples = capacity;
  if (libav().av_channel_layout_copy(&converted->ch_layout, &encoder_->ch_layout) < 0 ||
      libav().av_frame_get_buffer(converted.get(), 0) < 0) {
    throw std::bad_alloc();
  }
  const int samples = libav().swr_convert(
      resampler_.get(), converted->extended_data, capacity,
      frame != nullptr ? const_cast<const std::uint8_t**>(frame->extended_data) : nullptr,
      frame != nullptr ? frame->nb_samples : 0);
  if (samples < 0) {
    input_.fail(libav_message(samples));
  }
  if (next_sample_ == AV_NOPTS_VALUE) {
    next_sample_ =
        frame == nullptr || frame->best_effort_timestamp == AV_NOPTS_VALUE
            ? 0
            : std::llround(input_.seconds(frame->best_effort_timestamp) * encoder_->sample_rate);
  }
  const std::int64_t first = std::max<std::int64_t>(next_sample_, 0);
  const std::int64_t end = std::min(next_sample_ + samples, samples_of_part_);
  if (first < end) {
    std::array<void*, 2> planes{};
    for (int channel = 0; channel < encoder_->ch_layout.nb_channels; ++channel) {
      planes.at(static_cast<std::size_t>(channel)) =
          converted->extended_data[channel] +
          static_cast<std::size_t>(first - next_sample_) * sizeof(float);
    }
    if (libav().av_audio_fifo_write(queue_.get(), planes.data(), static_cast<int>(end - first)) <
        0) {
      throw std::bad_alloc();
    }
    if (next_to_encode_ == AV_NOPTS_VALUE) {
      next_to_encode_ = first;
    }
  }
  next_sample_ += samples;
}

}  // namespace

std::unique_ptr<SoundPackets> make_encoded_sound(SoundInput input) {
  return std::make_unique<EncodedSound>(std::move(input));
}

}  // namespace vantage
