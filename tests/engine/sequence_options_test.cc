#include "engine/sequence/options/sequence_options.h"

#include "tests/engine/engine_test.h"

namespace vantage::sequence_options_test {

TEST(SequenceOptions, WhatIsWrongIsNamed) {
  const auto refusal = [&](const std::function<void(SequenceOptions&)>& change) {
    SequenceOptions options;
    options.match.disparities = {0, 9};
    change(options);
    return error_of([&] { options.validate(); });
  };
  using Options = SequenceOptions;
  EXPECT_EQ(refusal([](Options&) {}), "");
  EXPECT_THAT(refusal([](Options& o) { o.save = {}; }), HasSubstr("save is empty"));
  EXPECT_THAT(refusal([](Options& o) {
                o.views = {ViewPath::fixed(BaselinePosition{0, 0})};
              }),
              HasSubstr("save has no views"));
  EXPECT_THAT(refusal([](Options& o) { o.save = {SequenceOutput::kSources}; }),
              HasSubstr("no view is given"));
  const auto refusal_of_views = [&](const std::vector<ViewPath>& views) {
    return refusal([&](Options& o) {
      o.save = {SequenceOutput::kViews};
      o.views = views;
    });
  };
  EXPECT_EQ(refusal_of_views({parse_view_path("0=0,17")}),
            "view is 0,17, expected numbers within ±16");
  EXPECT_THAT(refusal_of_views({parse_view_path("0=nan")}), HasSubstr("within ±16"));
  EXPECT_EQ(refusal_of_views({parse_view_path("0=1,3=0"), parse_view_path("0=1,3=0")}),
            "view 0=1,3=0 is given twice");
  EXPECT_EQ(refusal_of_views({parse_view_path("7=0.5"), ViewPath::fixed(BaselinePosition{0.5, 0})}),
            "view 0.5 is given twice");
  EXPECT_EQ(refusal_of_views({ViewPath::fixed(PosedCamera()), ViewPath::fixed(PosedCamera())}),
            "view by a camera with fx = 1 px is given twice");
  EXPECT_THAT(refusal([](Options& o) { o.map_format = "bmp"; }), HasSubstr("format is 'bmp'"));
  EXPECT_THAT(refusal([](Options& o) { o.match.parameters.window_px = 4; }), HasSubstr("window"));
  EXPECT_THAT(refusal([](Options& o) { o.video = {SequenceOutput::kDisparity}; }),
              HasSubstr("a video cannot hold"));
  EXPECT_THAT(refusal([](Options& o) { o.video = {SequenceOutput::kPreview}; }),
              HasSubstr("`save` …,preview"));
  EXPECT_THAT(refusal([](Options& o) { o.crf = 52; }), HasSubstr("crf is 52"));
  EXPECT_THAT(refusal([](Options& o) { o.chunk_frames = 0; }), HasSubstr("chunk-frames is 0"));
  EXPECT_THAT(refusal([](Options& o) { o.stereo_views_x = {0, 17}; }), HasSubstr("stereo-views"));
  EXPECT_THAT(refusal([](Options& o) { o.temporal.weight = -1; }), HasSubstr("-1"));
  EXPECT_THAT(refusal([](Options& o) {
                o.match.method = MatchMethod::kSsd;
                o.temporal.reuse = Reuse::kFrame;
              }),
              HasSubstr("reuse is frame, expected none with a method without"));
  EXPECT_THAT(refusal([](Options& o) { o.temporal = {.weight = 1, .reuse = Reuse::kFrame}; }),
              HasSubstr("temporal-prior is 1 with reuse frame, expected one of them"));
  EXPECT_THAT(refusal([](Options& o) { o.depth_format = "bmp"; }),
              HasSubstr("depth-format is 'bmp'"));
  EXPECT_THAT(refusal([](Options& o) {
                o.save = {SequenceOutput::kDepth};
                o.depth_format = "png";
                o.cloud.max_depth = 1e6;
              }),
              HasSubstr("with depth-format png"));
  EXPECT_THAT(refusal([](Options& o) { o.depth_coding = VideoCoding::kH264; }),
              HasSubstr("depth-codec is h264"));
}

}  // namespace vantage::sequence_options_test
