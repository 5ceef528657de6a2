#pragma once

#include "engine/late_library.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/audio_fifo.h>
#include <libavutil/avstring.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswresample/swresample.h>
#include <libswscale/swscale.h>
}

namespace vantage {

/// The functions of FFmpeg that the engine calls. Its libraries load a hundred others, and a system
/// without videos need not have them, so they are opened with the first video and not at program
/// start. The types are those of FFmpeg's headers; another function takes one more line.
class LibavFunctions {
 public:
  /// Opens all. Throws Error when that fails.
  LibavFunctions();

 private:
  LateLibrary format_;
  LateLibrary codec_;
  LateLibrary resample_;
  LateLibrary scale_;
  LateLibrary util_;

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define VANTAGE_LATE_FUNCTION(library, name) \
  decltype(&::name) name = library.function<decltype(&::name)>(#name)

 public:
  VANTAGE_LATE_FUNCTION(format_, av_find_best_stream);
  VANTAGE_LATE_FUNCTION(format_, av_find_input_format);
  VANTAGE_LATE_FUNCTION(format_, av_interleaved_write_frame);
  VANTAGE_LATE_FUNCTION(format_, av_read_frame);
  VANTAGE_LATE_FUNCTION(format_, av_seek_frame);
  VANTAGE_LATE_FUNCTION(format_, av_write_trailer);
  VANTAGE_LATE_FUNCTION(format_, avformat_alloc_context);
  VANTAGE_LATE_FUNCTION(format_, avformat_alloc_output_context2);
  VANTAGE_LATE_FUNCTION(format_, avformat_close_input);
  VANTAGE_LATE_FUNCTION(format_, avformat_find_stream_info);
  VANTAGE_LATE_FUNCTION(format_, avformat_free_context);
  VANTAGE_LATE_FUNCTION(format_, avformat_index_get_entries_count);
  VANTAGE_LATE_FUNCTION(format_, avformat_index_get_entry);
  VANTAGE_LATE_FUNCTION(format_, avformat_new_stream);
  VANTAGE_LATE_FUNCTION(format_, avformat_open_input);
  VANTAGE_LATE_FUNCTION(format_, avformat_write_header);
  VANTAGE_LATE_FUNCTION(format_, avio_alloc_context);
  VANTAGE_LATE_FUNCTION(format_, avio_closep);
  VANTAGE_LATE_FUNCTION(format_, avio_context_free);
  VANTAGE_LATE_FUNCTION(format_, avio_feof);
  VANTAGE_LATE_FUNCTION(format_, avio_open);
  VANTAGE_LATE_FUNCTION(format_, avio_open2);

  VANTAGE_LATE_FUNCTION(codec_, av_packet_alloc);
  VANTAGE_LATE_FUNCTION(codec_, av_packet_free);
  VANTAGE_LATE_FUNCTION(codec_, av_packet_rescale_ts);
  VANTAGE_LATE_FUNCTION(codec_, av_packet_unref);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_alloc_context3);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_descriptor_get);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_find_decoder);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_find_encoder_by_name);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_free_context);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_get_name);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_open2);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_parameters_alloc);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_parameters_copy);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_parameters_free);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_parameters_from_context);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_parameters_to_context);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_receive_frame);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_receive_packet);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_send_frame);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_flush_buffers);
  VANTAGE_LATE_FUNCTION(codec_, avcodec_send_packet);

  VANTAGE_LATE_FUNCTION(resample_, swr_alloc_set_opts2);
  VANTAGE_LATE_FUNCTION(resample_, swr_convert);
  VANTAGE_LATE_FUNCTION(resample_, swr_free);
  VANTAGE_LATE_FUNCTION(resample_, swr_get_out_samples);
  VANTAGE_LATE_FUNCTION(resample_, swr_init);

  VANTAGE_LATE_FUNCTION(scale_, sws_alloc_context);
  VANTAGE_LATE_FUNCTION(scale_, sws_freeContext);
  VANTAGE_LATE_FUNCTION(scale_, sws_getCoefficients);
  VANTAGE_LATE_FUNCTION(scale_, sws_init_context);
  VANTAGE_LATE_FUNCTION(scale_, sws_isSupportedInput);
  VANTAGE_LATE_FUNCTION(scale_, sws_scale);
  VANTAGE_LATE_FUNCTION(scale_, sws_setColorspaceDetails);

  VANTAGE_LATE_FUNCTION(util_, av_audio_fifo_alloc);
  VANTAGE_LATE_FUNCTION(util_, av_audio_fifo_free);
  VANTAGE_LATE_FUNCTION(util_, av_audio_fifo_read);
  VANTAGE_LATE_FUNCTION(util_, av_audio_fifo_size);
  VANTAGE_LATE_FUNCTION(util_, av_audio_fifo_write);
  VANTAGE_LATE_FUNCTION(util_, av_channel_layout_compare);
  VANTAGE_LATE_FUNCTION(util_, av_channel_layout_copy);
  VANTAGE_LATE_FUNCTION(util_, av_channel_layout_default);
  VANTAGE_LATE_FUNCTION(util_, av_channel_layout_uninit);
  VANTAGE_LATE_FUNCTION(util_, av_color_primaries_name);
  VANTAGE_LATE_FUNCTION(util_, av_color_space_name);
  VANTAGE_LATE_FUNCTION(util_, av_color_transfer_name);
  VANTAGE_LATE_FUNCTION(util_, av_dict_free);
  VANTAGE_LATE_FUNCTION(util_, av_dict_get);
  VANTAGE_LATE_FUNCTION(util_, av_dict_parse_string);
  VANTAGE_LATE_FUNCTION(util_, av_dict_set);
  VANTAGE_LATE_FUNCTION(util_, av_dict_set_int);
  VANTAGE_LATE_FUNCTION(util_, av_frame_alloc);
  VANTAGE_LATE_FUNCTION(util_, av_frame_clone);
  VANTAGE_LATE_FUNCTION(util_, av_frame_free);
  VANTAGE_LATE_FUNCTION(util_, av_frame_get_buffer);
  VANTAGE_LATE_FUNCTION(util_, av_frame_get_side_data);
  VANTAGE_LATE_FUNCTION(util_, av_frame_is_writable);
  VANTAGE_LATE_FUNCTION(util_, av_free);
  VANTAGE_LATE_FUNCTION(util_, av_freep);
  VANTAGE_LATE_FUNCTION(util_, av_get_pix_fmt);
  VANTAGE_LATE_FUNCTION(util_, av_image_copy_to_buffer);
  VANTAGE_LATE_FUNCTION(util_, av_image_get_buffer_size);
  VANTAGE_LATE_FUNCTION(util_, av_log_set_level);
  VANTAGE_LATE_FUNCTION(util_, av_malloc);
  VANTAGE_LATE_FUNCTION(util_, av_match_list);
  VANTAGE_LATE_FUNCTION(util_, av_opt_set_double);
  VANTAGE_LATE_FUNCTION(util_, av_opt_set_int);
  VANTAGE_LATE_FUNCTION(util_, av_pix_fmt_desc_get);
  VANTAGE_LATE_FUNCTION(util_, av_reduce);
  VANTAGE_LATE_FUNCTION(util_, av_rescale_q);
  VANTAGE_LATE_FUNCTION(util_, av_strdup);
  VANTAGE_LATE_FUNCTION(util_, av_strerror);

#undef VANTAGE_LATE_FUNCTION
};

/// The functions; the first call opens the libraries. Throws Error when that fails. Thread rule:
/// may be called concurrently.
const LibavFunctions& libav();

}  // namespace vantage
