#include "engine/io/video/libav_filter.h"

#include <fmt/format.h>

#include <new>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"
#include "engine/late_library.h"

extern "C" {
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavutil/frame.h>
#include <libavutil/macros.h>
#include <libavutil/mem.h>
}

namespace vantage {
namespace {

/// The functions of libavfilter, as LibavFunctions has those of other libraries.
class FilterFunctions {
 private:
  LateLibrary filter_{"libavfilter.so." AV_STRINGIFY(LIBAVFILTER_VERSION_MAJOR),
                      "cannot filter the pictures of a video"};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define VANTAGE_LATE_FUNCTION(name) \
  decltype(&::name) name = filter_.function<decltype(&::name)>(#name)

 public:
  VANTAGE_LATE_FUNCTION(av_buffersink_get_frame);
  VANTAGE_LATE_FUNCTION(av_buffersrc_add_frame_flags);
  VANTAGE_LATE_FUNCTION(avfilter_get_by_name);
  VANTAGE_LATE_FUNCTION(avfilter_graph_alloc);
  VANTAGE_LATE_FUNCTION(avfilter_graph_config);
  VANTAGE_LATE_FUNCTION(avfilter_graph_create_filter);
  VANTAGE_LATE_FUNCTION(avfilter_graph_free);
  VANTAGE_LATE_FUNCTION(avfilter_graph_parse_ptr);
  VANTAGE_LATE_FUNCTION(avfilter_inout_alloc);
  VANTAGE_LATE_FUNCTION(avfilter_inout_free);

#undef VANTAGE_LATE_FUNCTION
};

const FilterFunctions& filters() {
  static const FilterFunctions functions;
  return functions;
}

/// One end of the chain, for the parser, which takes it over.
AVFilterInOut* end_of_chain(const char* name, AVFilterContext* filter) {
  AVFilterInOut* end = filters().avfilter_inout_alloc();
  if (end == nullptr) {
    throw std::bad_alloc();
  }
  end->name = libav().av_strdup(name);
  end->filter_ctx = filter;
  return end;
}

}  // namespace

void LibavFree::operator()(AVFilterGraph* graph) const noexcept {
  filters().avfilter_graph_free(&graph);
}

LibavFilter::LibavFilter(const std::string& chain, const AVFrame& first)
    : graph_(filters().avfilter_graph_alloc()) {
  if (graph_ == nullptr) {
    throw std::bad_alloc();
  }
  silence_libav();
  graph_->nb_threads = 1;
  const auto require = [&](int result) {
    if (result < 0) {
      throw Error(
          fmt::format("this FFmpeg's filter {} cannot be used ({})", chain, libav_message(result)));
    }
  };
  const std::string shape = fmt::format("video_size={}x{}:pix_fmt={}:time_base=1/1", first.width,
                                        first.height, first.format);
  require(filters().avfilter_graph_create_filter(&source_, filters().avfilter_get_by_name("buffer"),
                                                 "in", shape.c_str(), nullptr, graph_.get()));
  require(filters().avfilter_graph_create_filter(
      &sink_, filters().avfilter_get_by_name("buffersink"), "out", nullptr, nullptr, graph_.get()));
  AVFilterInOut* outputs = end_of_chain("in", source_);
  AVFilterInOut* inputs = end_of_chain("out", sink_);
  const int parsed =
      filters().avfilter_graph_parse_ptr(graph_.get(), chain.c_str(), &inputs, &outputs, nullptr);
  filters().avfilter_inout_free(&inputs);
  filters().avfilter_inout_free(&outputs);
  require(parsed);
  require(filters().avfilter_graph_config(graph_.get(), nullptr));
}

void LibavFilter::put(const AVFrame& frame) {
  const LibavFrame numbered(libav().av_frame_clone(&frame));
  if (numbered == nullptr) {
    throw std::bad_alloc();
  }
  numbered->pts = frames_put_++;
  const int result = filters().av_buffersrc_add_frame_flags(source_, numbered.get(), 0);
  if (result < 0) {
    throw Error(fmt::format("a picture cannot be filtered ({})", libav_message(result)));
  }
}

void LibavFilter::end() {
  if (filters().av_buffersrc_add_frame_flags(source_, nullptr, 0) < 0) {
    throw Error("the last picture cannot be filtered");
  }
}

LibavFrame LibavFilter::take() {
  LibavFrame frame = make_libav_frame();
  return filters().av_buffersink_get_frame(sink_, frame.get()) < 0 ? nullptr : std::move(frame);
}

}  // namespace vantage
