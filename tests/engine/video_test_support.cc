#include "tests/engine/video_test_support.h"

#include "engine/io/video/libav.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "tests/engine/engine_test.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace vantage {
inline namespace test {
namespace {

struct Close {
  void operator()(AVFormatContext* output) const {
    avio_closep(&output->pb);
    avformat_free_context(output);
  }
};

void require(int result) {
  if (result < 0) {
    throw std::runtime_error("libav: " + libav_message(result));
  }
}

AVRational unit_of(FrameRate rate) {
  return {static_cast<int>(rate.denominator), static_cast<int>(rate.numerator)};
}

/// All packets of the video; their pts are numbers of frames.
std::vector<LibavPacket> read_packets(AVFormatContext& input, const AVStream& stream) {
  std::vector<LibavPacket> packets;
  std::vector<std::int64_t> times;
  LibavPacket packet = make_libav_packet();
  while (av_read_frame(&input, packet.get()) >= 0) {
    if (packet->stream_index == stream.index) {
      times.push_back(packet->pts);
      packets.push_back(std::exchange(packet, make_libav_packet()));
    } else {
      av_packet_unref(packet.get());
    }
  }
  std::sort(times.begin(), times.end());
  for (const LibavPacket& each : packets) {
    each->pts = std::lower_bound(times.begin(), times.end(), each->pts) - times.begin();
  }
  return packets;
}

void add_sound_stream(AVFormatContext& output, const Sound& sound) {
  AVStream* stream = avformat_new_stream(&output, nullptr);
  stream->codecpar->codec_type = AVMEDIA_TYPE_AUDIO;
  stream->codecpar->codec_id = AV_CODEC_ID_PCM_S16LE;
  stream->codecpar->format = AV_SAMPLE_FMT_S16;
  stream->codecpar->sample_rate = sound.samples_per_second;
  stream->codecpar->bits_per_coded_sample = 16;
  stream->codecpar->block_align = 2;
  av_channel_layout_default(&stream->codecpar->ch_layout, 1);
  stream->time_base = {1, sound.samples_per_second};
}

void write_sound(AVFormatContext& output, const Sound& sound) {
  constexpr std::size_t kPacketSamples = 1000;
  for (std::size_t first = 0; first < sound.samples.size(); first += kPacketSamples) {
    const std::size_t count = std::min(kPacketSamples, sound.samples.size() - first);
    const LibavPacket packet = make_libav_packet();
    require(av_new_packet(packet.get(), static_cast<int>(2 * count)));
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = static_cast<std::int16_t>(std::lround(32767 * sound.samples[first + i]));
      packet->data[2 * i] = static_cast<std::uint8_t>(value & 255);
      packet->data[2 * i + 1] = static_cast<std::uint8_t>((value >> 8) & 255);
    }
    packet->pts = packet->dts = static_cast<std::int64_t>(first);
    packet->duration = static_cast<std::int64_t>(count);
    packet->stream_index = 1;
    av_packet_rescale_ts(packet.get(), {1, sound.samples_per_second}, output.streams[1]->time_base);
    require(av_interleaved_write_frame(&output, packet.get()));
  }
}

}  // namespace

void put_x264_video(const std::filesystem::path& path, int frames, FrameRate rate,
                    const std::string& x264_options) {
  silence_libav();
  const FrameConversion convert = make_frame_conversion(VideoCoding::kH264, 64, 48);
  const LibavCodec encoder(avcodec_alloc_context3(avcodec_find_encoder_by_name("libx264")));
  encoder->width = 64;
  encoder->height = 48;
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->time_base = unit_of(rate);
  encoder->thread_count = 1;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  AVDictionary* options = nullptr;
  av_dict_set(&options, "x264-params", x264_options.c_str(), 0);
  require(avcodec_open2(encoder.get(), encoder->codec, &options));
  av_dict_free(&options);

  AVFormatContext* opened = nullptr;
  require(avformat_alloc_output_context2(&opened, nullptr, "mp4", nullptr));
  const std::unique_ptr<AVFormatContext, Close> output(opened);
  require(avio_open(&output->pb, path.c_str(), AVIO_FLAG_WRITE));
  AVStream* stream = avformat_new_stream(output.get(), nullptr);
  stream->time_base = unit_of(rate);
  require(avcodec_parameters_from_context(stream->codecpar, encoder.get()));
  require(avformat_write_header(output.get(), nullptr));
  const LibavPacket packet = make_libav_packet();
  for (int i = 0; i <= frames; ++i) {
    const LibavFrame frame = i < frames ? convert(numbered_frame(64, 48, i)) : nullptr;
    if (frame != nullptr) {
      frame->pts = i;
    }
    require(avcodec_send_frame(encoder.get(), frame.get()));
    while (avcodec_receive_packet(encoder.get(), packet.get()) >= 0) {
      packet->duration = 1;
      av_packet_rescale_ts(packet.get(), unit_of(rate), stream->time_base);
      require(av_write_frame(output.get(), packet.get()));
    }
  }
  require(av_write_trailer(output.get()));
}

void put_open_groups_video(const std::filesystem::path& path, int frames, FrameRate rate) {
  put_x264_video(path, frames, rate, "open_gop=1:keyint=6:bframes=2:b-adapt=0:scenecut=0");
}

void put_closed_groups_video(const std::filesystem::path& path, int frames, FrameRate rate,
                             int group) {
  put_x264_video(path, frames, rate,
                 "keyint=" + std::to_string(group) + ":bframes=3:b-adapt=0:scenecut=0");
}

void put_tracks(const std::vector<std::filesystem::path>& from, const std::filesystem::path& to,
                const std::string& container, const std::function<void(AVStream&, int)>& change) {
  AVFormatContext* opened = nullptr;
  require(avformat_alloc_output_context2(&opened, nullptr, container.c_str(), nullptr));
  const std::unique_ptr<AVFormatContext, Close> output(opened);
  output->strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;
  require(avio_open(&output->pb, to.c_str(), AVIO_FLAG_WRITE));
  std::vector<LibavInput> inputs;
  for (const auto& path : from) {
    inputs.push_back(open_media_file(path));
    const AVStream& source = *find_video_stream(*inputs.back());
    AVStream* target = avformat_new_stream(output.get(), nullptr);
    require(avcodec_parameters_copy(target->codecpar, source.codecpar));
    target->codecpar->codec_tag = 0;
    target->time_base = source.time_base;
    target->avg_frame_rate = source.avg_frame_rate;
    change(*target, target->index);
  }
  require(avformat_write_header(output.get(), nullptr));
  const LibavPacket packet = make_libav_packet();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const AVStream& source = *find_video_stream(*inputs[i]);
    while (av_read_frame(inputs[i].get(), packet.get()) >= 0) {
      packet->stream_index = static_cast<int>(i);
      packet->pos = -1;
      av_packet_rescale_ts(packet.get(), source.time_base, output->streams[i]->time_base);
      require(av_interleaved_write_frame(output.get(), packet.get()));
    }
  }
  require(av_write_trailer(output.get()));
}

std::vector<VideoPacket> video_packets(const std::filesystem::path& path) {
  const LibavInput input = open_media_file(path);
  std::vector<VideoPacket> result;
  for (const LibavPacket& packet : read_packets(*input, *find_video_stream(*input))) {
    result.push_back(
        {static_cast<int>(packet->pts), packet->pos, (packet->flags & AV_PKT_FLAG_KEY) != 0});
  }
  return result;
}

void remux_video(const std::filesystem::path& from, const std::filesystem::path& to,
                 const std::string& container, FrameRate rate, const Sound& sound,
                 const std::function<int(int)>& time_of, const std::function<bool(int)>& keeps) {
  const LibavInput input = open_media_file(from);
  AVStream& source = *find_video_stream(*input);
  std::vector<LibavPacket> packets = read_packets(*input, source);
  std::erase_if(packets, [&](const auto& packet) { return !keeps(static_cast<int>(packet->pts)); });
  std::vector<std::int64_t> times;
  for (const LibavPacket& packet : packets) {
    packet->pts = time_of(static_cast<int>(packet->pts));
    times.push_back(packet->pts);
  }
  std::sort(times.begin(), times.end());

  AVFormatContext* opened = nullptr;
  require(avformat_alloc_output_context2(&opened, nullptr, container.c_str(), nullptr));
  const std::unique_ptr<AVFormatContext, Close> output(opened);
  require(avio_open(&output->pb, to.c_str(), AVIO_FLAG_WRITE));
  AVStream* target = avformat_new_stream(output.get(), nullptr);
  require(avcodec_parameters_copy(target->codecpar, source.codecpar));
  target->codecpar->codec_tag = 0;
  target->time_base = unit_of(rate);
  target->avg_frame_rate = {target->time_base.den, target->time_base.num};
  if (!sound.samples.empty()) {
    add_sound_stream(*output, sound);
  }
  require(avformat_write_header(output.get(), nullptr));
  constexpr int kLead = 2;  // of decoding before showing, at most, in what VideoWriter makes
  for (std::size_t i = 0; i < packets.size(); ++i) {
    AVPacket& packet = *packets[i];
    packet.dts = i < kLead ? times[0] - kLead + static_cast<int>(i) : times[i - kLead];
    packet.duration = 1;
    packet.stream_index = 0;
    packet.pos = -1;
    av_packet_rescale_ts(&packet, unit_of(rate), target->time_base);
    require(av_interleaved_write_frame(output.get(), &packet));
  }
  if (!sound.samples.empty()) {
    write_sound(*output, sound);
  }
  require(av_write_trailer(output.get()));
}

void put_changing_sound(const std::filesystem::path& path, const std::vector<int>& channels,
                        bool damaged) {
  silence_libav();
  AVFormatContext* opened = nullptr;
  require(avformat_alloc_output_context2(&opened, nullptr, "matroska", nullptr));
  const std::unique_ptr<AVFormatContext, Close> output(opened);
  require(avio_open(&output->pb, path.c_str(), AVIO_FLAG_WRITE));
  AVStream* stream = avformat_new_stream(output.get(), nullptr);
  std::int64_t samples = 0;
  for (const int count : channels) {
    const LibavCodec encoder(avcodec_alloc_context3(avcodec_find_encoder(AV_CODEC_ID_MP2)));
    encoder->sample_rate = 48000;
    encoder->sample_fmt = AV_SAMPLE_FMT_S16;
    encoder->bit_rate = 96000 * count;
    encoder->time_base = {1, 48000};
    av_channel_layout_default(&encoder->ch_layout, count);
    require(avcodec_open2(encoder.get(), encoder->codec, nullptr));
    if (samples == 0) {
      require(avcodec_parameters_from_context(stream->codecpar, encoder.get()));
      stream->time_base = {1, 48000};
      require(avformat_write_header(output.get(), nullptr));
    }
    const std::int64_t end = samples + 20 * encoder->frame_size;
    for (; samples < end; samples += encoder->frame_size) {
      const LibavFrame frame = make_libav_frame();
      frame->format = encoder->sample_fmt;
      frame->nb_samples = encoder->frame_size;
      frame->sample_rate = encoder->sample_rate;
      frame->pts = samples;
      require(av_channel_layout_copy(&frame->ch_layout, &encoder->ch_layout));
      require(av_frame_get_buffer(frame.get(), 0));
      auto* values = reinterpret_cast<std::int16_t*>(frame->data[0]);
      for (int i = 0; i < encoder->frame_size * count; ++i) {
        const double time = static_cast<double>(samples + i / count) / 48000;
        values[i] = static_cast<std::int16_t>(16384 * std::sin(2765 * time));
      }
      require(avcodec_send_frame(encoder.get(), frame.get()));
      const LibavPacket packet = make_libav_packet();
      while (avcodec_receive_packet(encoder.get(), packet.get()) >= 0) {
        if (damaged && samples > 5 * encoder->frame_size) {
          std::fill_n(packet->data, packet->size, std::uint8_t{0x55});
        }
        av_packet_rescale_ts(packet.get(), {1, 48000}, stream->time_base);
        require(av_interleaved_write_frame(output.get(), packet.get()));
      }
    }
  }
  require(av_write_trailer(output.get()));
}

std::string sound_codec(const std::filesystem::path& path) {
  const LibavInput input = open_media_file(path);
  const AVStream* stream = find_sound_stream(*input);
  return stream == nullptr ? "" : avcodec_get_name(stream->codecpar->codec_id);
}

Sound read_sound(const std::filesystem::path& path) {
  const LibavInput input = open_media_file(path);
  AVStream* stream = find_sound_stream(*input);
  if (stream == nullptr) {
    return {};
  }
  read_only(*input, *stream);
  const AVCodec* codec = avcodec_find_decoder(stream->codecpar->codec_id);
  const LibavCodec decoder(avcodec_alloc_context3(codec));
  require(avcodec_parameters_to_context(decoder.get(), stream->codecpar));
  decoder->pkt_timebase = stream->time_base;
  require(avcodec_open2(decoder.get(), codec, nullptr));
  Sound sound{decoder->sample_rate, {}};
  // The last packet decodes to whole 1024 samples, not all of which belong to it.
  const std::int64_t end =
      av_rescale_q(stream->duration, stream->time_base, {1, sound.samples_per_second});
  const LibavPacket packet = make_libav_packet();
  const LibavFrame frame = make_libav_frame();
  for (bool ended = false; !ended;) {
    ended = av_read_frame(input.get(), packet.get()) < 0;
    if (!ended && packet->stream_index != stream->index) {
      av_packet_unref(packet.get());
      continue;
    }
    require(avcodec_send_packet(decoder.get(), ended ? nullptr : packet.get()));
    av_packet_unref(packet.get());
    while (avcodec_receive_frame(decoder.get(), frame.get()) >= 0) {
      const std::int64_t first = av_rescale_q(frame->best_effort_timestamp, stream->time_base,
                                              {1, sound.samples_per_second});
      for (int i = 0; i < frame->nb_samples; ++i) {
        if (first + i < 0 || first + i >= end) {
          continue;
        }
        sound.samples.resize(
            std::max(sound.samples.size(), static_cast<std::size_t>(first + i) + 1));
        const bool real = frame->format == AV_SAMPLE_FMT_FLTP;
        sound.samples[static_cast<std::size_t>(first + i)] =
            real ? reinterpret_cast<const float*>(frame->data[0])[i]
                 : static_cast<float>(reinterpret_cast<const std::int16_t*>(frame->data[0])[i]) /
                       32767;
      }
    }
  }
  return sound;
}

}  // namespace test
}  // namespace vantage
