#pragma once

#include "engine/late_library.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace vantage {

/// The functions of libavformat and libavcodec that the engine calls. Both libraries load a hundred
/// others, so they are opened with the first video and not at program start. The types are those of
/// FFmpeg's headers; another function takes one more line. Functions of libavutil, libswscale and
/// libswresample are linked as usual.
class LibavFunctions {
 public:
  /// Opens both. Throws Error when that fails.
  LibavFunctions();

 private:
  LateLibrary format_;
  LateLibrary codec_;

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
  VANTAGE_LATE_FUNCTION(codec_, avcodec_send_packet);

#undef VANTAGE_LATE_FUNCTION
};

/// The functions; the first call opens the libraries. Throws Error when that fails. Thread rule:
/// may be called concurrently.
const LibavFunctions& libav();

}  // namespace vantage
