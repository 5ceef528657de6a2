#include "engine/io/video/film_properties.h"

#include "engine/io/files/file_bytes.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav_filter.h"
#include "engine/io/video/video_decoder.h"
#include "engine/sequence/pairs/pair_source.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/stereo3d.h>
}

namespace vantage::film_properties_test {

constexpr FrameRate kRate{24, 1};

std::string packing_name(const FilmProperties& film) {
  return film.packing ? std::string(to_name(*film.packing)) : "";
}

PairSourceOptions stereo_film(const std::filesystem::path& path) {
  PairSourceOptions options;
  options.stereo = path;
  return options;
}

/// Numbers of put_numbered_video(): "left right" of each pair.
std::vector<std::string> numbers_of(PairSource& source) {
  std::vector<std::string> numbers;
  for (FramePair pair; source.fetch(pair);) {
    source.decode(pair);
    numbers.push_back(std::to_string(number_of_frame(pair.left)) + " " +
                      std::to_string(number_of_frame(pair.right)));
  }
  return numbers;
}

TEST(FilmProperties, StereoModeOfMatroskaIsThePacking) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 2, kRate, 128, 48);
  // Names of the Matroska specification; 128x48 is side by side 4:3 in full size.
  const std::pair<const char*, const char*> expected[] = {{"left_right", "sbsl"},
                                                          {"right_left", "sbsr"},
                                                          {"top_bottom", "ab2l"},
                                                          {"bottom_top", "ab2r"},
                                                          {"row_interleaved_lr", "irl"},
                                                          {"row_interleaved_rl", "irr"},
                                                          {"col_interleaved_lr", "icl"},
                                                          {"col_interleaved_rl", "icr"},
                                                          {"block_lr", "al"},
                                                          {"block_rl", "ar"},
                                                          {"checkerboard_lr", ""},

                                                          {"mono", ""}};
  for (const auto& [mode, packing] : expected) {
    SCOPED_TRACE(mode);
    put_tracks({folder / "a.mp4"}, folder / "b.mkv", "matroska", [&](AVStream& stream, int) {
      av_dict_set(&stream.metadata, "stereo_mode", mode, 0);
    });
    const FilmProperties film = examine_film(folder / "b.mkv", kMainVideo);
    EXPECT_EQ(packing_name(film), packing);
    EXPECT_EQ(film.stereo.empty(), std::string(mode) == "mono");
    if (film.packing) {
      EXPECT_THAT(open_pair_source(stereo_film(folder / "b.mkv"))->remarks(),
                  testing::Contains(HasSubstr("StereoMode")));
    } else {
      const std::string error = error_of([&] { open_pair_source(stereo_film(folder / "b.mkv")); });
      EXPECT_THAT(error, HasSubstr(film.stereo.empty() ? "does not say" : "which is not read"));
    }
  }
}

TEST(FilmProperties, St3dOfMp4IsThePacking) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 2, kRate, 64, 96);
  for (const bool inverted : {false, true}) {
    put_tracks({folder / "a.mp4"}, folder / "b.mp4", "mp4", [&](AVStream& stream, int) {
      AVStereo3D* stereo = av_stereo3d_alloc();
      stereo->type = inverted ? AV_STEREO3D_SIDEBYSIDE : AV_STEREO3D_TOPBOTTOM;
      av_stream_add_side_data(&stream, AV_PKT_DATA_STEREO3D,
                              reinterpret_cast<std::uint8_t*>(stereo), sizeof *stereo);
    });
    EXPECT_EQ(packing_name(examine_film(folder / "b.mp4", kMainVideo)), inverted ? "sbs2l" : "abl");
  }
}

TEST(FilmProperties, FramePackingOfTheBitstreamIsThePacking) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> expected[] = {
      {"0", ""}, {"1", "icl"}, {"2", "irl"}, {"3", "sbs2l"}, {"4", "ab2l"}, {"5", "al"}};
  for (const auto& [number, packing] : expected) {
    put_x264_video(folder / "a.mp4", 2, kRate, std::string("frame-packing=") + number);
    const FilmProperties film = examine_film(folder / "a.mp4", kMainVideo);
    EXPECT_EQ(packing_name(film), packing);
    EXPECT_THAT(film.stereo, HasSubstr("bitstream"));
  }
}

TEST(FilmProperties, AnOptionThatContradictsIsObeyedWithANote) {
  const TemporaryFolder folder;
  put_x264_video(folder / "a.mp4", 2, kRate, "frame-packing=4");
  PairSourceOptions options = stereo_film(folder / "a.mp4");
  const auto found = open_pair_source(options);
  FramePair pair;
  ASSERT_TRUE(found->fetch(pair));
  found->decode(pair);
  EXPECT_EQ(pair.left.width(), 64);
  EXPECT_THAT(found->remarks(), ElementsAre(HasSubstr("images of half size are assumed (else "
                                                      "`packing` abl)")));
  options.packing = StereoPacking{};
  const auto given = open_pair_source(options);
  ASSERT_TRUE(given->fetch(pair));
  given->decode(pair);
  EXPECT_EQ(pair.left.width(), 32);
  EXPECT_THAT(given->remarks(), ElementsAre(HasSubstr("`packing` sbsl is given, but")));
  options.packing = StereoPacking{.layout = StereoLayout::kAboveBelow};
  EXPECT_THAT(open_pair_source(options)->remarks(), IsEmpty());
}

TEST(FilmProperties, PicturesThatTakeTurnsAreHalfAsManyPairs) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 9, kRate);
  for (const bool right_first : {false, true}) {
    PairSourceOptions options = stereo_film(folder / "a.mp4");
    options.packing = StereoPacking{StereoLayout::kFrames, false, right_first};
    const auto all = open_pair_source(options);
    EXPECT_EQ(all->frame_rate(), (FrameRate{12, 1}));
    EXPECT_THAT(numbers_of(*all), right_first ? ElementsAre("1 0", "3 2", "5 4", "7 6")
                                              : ElementsAre("0 1", "2 3", "4 5", "6 7"));
    options.every.pairs = 2;
    options.every.first = 1;
    const auto some = open_pair_source(options);
    EXPECT_EQ(some->frame_rate(), (FrameRate{6, 1}));
    EXPECT_THAT(numbers_of(*some),
                right_first ? ElementsAre("3 2", "7 6") : ElementsAre("2 3", "6 7"));
  }
}

TEST(FilmProperties, TwoTracksAreTwoCameras) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 3, kRate);
  put_numbered_video(folder / "b.mp4", 3, kRate, 64, 48, 10);
  for (const bool is_named : {false, true}) {
    put_tracks({folder / "a.mp4", folder / "b.mp4"}, folder / "c.mkv", "matroska",
               [&](AVStream& stream, int track) {
                 if (is_named) {
                   av_dict_set(&stream.metadata, "title", track == 0 ? "Right eye" : "Left eye", 0);
                 }
               });
    const auto pairs = open_pair_source(stereo_film(folder / "c.mkv"));
    EXPECT_THAT(numbers_of(*pairs), is_named ? ElementsAre("10 0", "11 1", "12 2")
                                             : ElementsAre("0 10", "1 11", "2 12"));
    EXPECT_THAT(pairs->remarks(),
                testing::Contains(HasSubstr(is_named ? "the left image is #1, the right one #0, as "
                                                       "their names say"
                                                     : "the left image is #0, the right one #1 "
                                                       "(assumed)")));
  }
  PairSourceOptions options;
  options.left = (folder / "c.mkv") + "#1";
  options.right = (folder / "c.mkv") + "#0";
  const auto pairs = open_pair_source(options);
  EXPECT_THAT(numbers_of(*pairs), ElementsAre("10 0", "11 1", "12 2"));
  EXPECT_NE(pairs->identities()[0], pairs->identities()[1]);
  EXPECT_THAT(pairs->describe(1), HasSubstr("c.mkv#1 frame 1"));
  options.right = (folder / "c.mkv") + "#2";
  EXPECT_THAT(error_of([&] { open_pair_source(options); }),
              HasSubstr("has 2 video tracks, expected #0 to #1"));
  options.right = (folder / "c.mkv") + "#x";
  EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("number of a video track"));
}

/// Replaces bytes of a file that are there once.
void patch(const std::filesystem::path& path, const std::string& from, const std::string& to) {
  std::string bytes = read_file_text(path);
  const std::size_t place = bytes.find(from);
  ASSERT_NE(place, std::string::npos);
  bytes.replace(place, from.size(), to);
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(FilmProperties, FurtherViewsAreNamedAndNotMatchedAsHalves) {
  const TemporaryFolder folder;
  const std::string film = folder / "a.mp4";
  const auto refused = [&](const std::string& coding) {
    PairSourceOptions options = stereo_film(film);
    options.packing = StereoPacking{};
    EXPECT_THAT(error_of([&] { open_pair_source(options); }), HasSubstr("holds " + coding));
    options = {};
    options.left = options.right = film;
    EXPECT_THAT(open_pair_source(options)->remarks(),
                testing::Contains(HasSubstr(coding + ", of which only the base view is read")));
  };
  put_numbered_video(film, 2, kRate);
  EXPECT_EQ(examine_film(film, kMainVideo).further_views, "");
  patch(film, "btrt", "lhvC");  // of the description of the samples
  refused("MV-HEVC");
  patch(film, "lhvC", "mvcC");
  refused("MVC");
  // A list of parameters in avcC that has High profile becomes a subset for Stereo High.
  put_numbered_video(film, 2, kRate);
  patch(film, std::string("\x67\x64\x00", 3), std::string("\x6F\x80\x00", 3));
  EXPECT_EQ(error_of([&] { examine_film(film, kMainVideo); }), "");
  EXPECT_EQ(examine_film(film, kMainVideo).further_views, "MVC");
  // HEVC: the parameters of the video say how many layers there are.
  VideoWriter writer(film, 64, 48, {.rate = kRate, .coding = VideoCoding::kHevc_10});
  Photograph grey = noise<std::uint16_t>(64, 48, 1);
  writer.write(grey);
  writer.finish();
  EXPECT_EQ(examine_film(film, kMainVideo).further_views, "");
  patch(film, std::string("\x40\x01\x0C\x01", 4), std::string("\x40\x01\x0C\x11", 4));
  refused("MV-HEVC");
}

TEST(FilmProperties, TheDisplayMatrixTurnsPictures) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 1, kRate, 32, 16);
  Photograph stored;
  ASSERT_TRUE(open_frame_source(folder / "a.mp4")->next(stored));
  for (const double degrees : {0, 90, 180, 270}) {
    for (const auto& [mirrors, flips] :
         {std::pair{false, false}, std::pair{true, false}, std::pair{false, true}}) {
      SCOPED_TRACE(testing::Message() << degrees << " " << mirrors << flips);
      std::int32_t matrix[9];
      av_display_rotation_set(matrix, degrees);
      av_display_matrix_flip(matrix, mirrors ? 1 : 0, flips ? 1 : 0);
      put_tracks({folder / "a.mp4"}, folder / "b.mp4", "mp4", [&](AVStream& stream, int) {
        std::uint8_t* data =
            av_stream_new_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, sizeof matrix);
        std::memcpy(data, matrix, sizeof matrix);
      });
      Photograph shown;
      ASSERT_TRUE(open_frame_source(folder / "b.mp4")->next(shown));
      const bool lies = degrees == 90 || degrees == 270;
      ASSERT_EQ(shown.width(), lies ? 16 : 32);
      const auto& from = std::get<Image<std::uint8_t>>(stored.pixels);
      const auto& to = std::get<Image<std::uint8_t>>(shown.pixels);
      // The matrix maps a column and a row to those shown, up to a shift.
      const auto place = [](int along_x, int along_y, int x, int y, int size) {
        const int shift = along_x < 0 || along_y < 0 ? size - 1 : 0;
        return std::clamp(along_x * x + along_y * y + shift, 0, size - 1);
      };
      for (const auto [x, y] : positions_of(32, 16)) {
        const int column = place(matrix[0] >> 16, matrix[3] >> 16, x, y, to.width());
        const int row = place(matrix[1] >> 16, matrix[4] >> 16, x, y, to.height());
        ASSERT_EQ(from.at(x, y, 1), to.at(column, row, 1));
      }
      Photograph left;
      ASSERT_TRUE(open_frame_source(folder / "b.mp4", {.turns_upright = false})->next(left));
      EXPECT_TRUE(same(left, stored));
    }
  }
  // The last one is turned, its partner is not.
  PairSourceOptions options;
  options.left = folder / "a.mp4";
  options.right = folder / "b.mp4";
  EXPECT_THAT(error_of([&] {
                const auto pairs = open_pair_source(options);
                FramePair pair;
                pairs->fetch(pair);
                pairs->decode(pair);
              }),
              HasSubstr("expected the same of both"));
}

std::vector<Photograph> frames_of(FrameSource& source) {
  std::vector<Photograph> frames;
  for (Photograph frame; source.next(frame); frame = {}) {
    frames.push_back(std::move(frame));
  }
  return frames;
}

/// The picture after it is needed for deinterlacing, so damage is found a frame early, and told at
/// its own.
TEST(FilmProperties, DamageOfAnInterlacedFilmIsAtItsFrame) {
  const TemporaryFolder folder;
  put_x264_video(folder / "a.mp4", 8, kRate, "tff=1:keyint=3:bframes=0");
  const std::vector<VideoPacket> packets = video_packets(folder / "a.mp4");
  auto bytes = bytes_of(folder / "a.mp4");
  std::fill_n(bytes.begin() + packets.at(4).offset, 4, std::uint8_t{0xFF});
  put_bytes(folder / "a.mp4", bytes);
  const auto source = open_frame_source(folder / "a.mp4", {.deinterlaces = true});
  FetchedFrame frame;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(source->fetch(frame)) << i;
    EXPECT_EQ(error_of([&] { frame.decode(); }), "") << i;
  }
  EXPECT_THAT(error_of([&] { source->fetch(frame); }), HasSubstr("frame 4 "));
}

TEST(FilmProperties, InterlacedPicturesAreDeinterlacedTheSameFromAnywhere) {
  const TemporaryFolder folder;
  put_x264_video(folder / "a.mp4", 8, kRate, "tff=1:keyint=3:bframes=0");
  const FilmProperties film = examine_film(folder / "a.mp4", kMainVideo);
  EXPECT_TRUE(film.is_interlaced && film.has_interlaced_flags);
  EXPECT_THAT(open_frame_source(folder / "a.mp4")->remarks(),
              ElementsAre(HasSubstr("field first: edges that move")));
  const auto source = open_frame_source(folder / "a.mp4", {.deinterlaces = true});
  EXPECT_THAT(source->remarks(), ElementsAre(HasSubstr("its pictures are deinterlaced")));
  const std::vector<Photograph> all = frames_of(*source);
  ASSERT_EQ(all.size(), 8U);
  // One chain of the filter for the whole film gives the same.
  VideoDecoder decoder(folder / "a.mp4", 1);
  std::unique_ptr<LibavFilter> filter;
  const auto converters = std::make_shared<PictureConverters>();
  std::size_t compared = 0;
  const auto compare = [&] {
    while (const LibavFrame frame = filter->take()) {
      Photograph expected;
      VideoPicture(*frame, converters, "expected").convert(expected);
      EXPECT_TRUE(same(all.at(compared++), expected)) << compared;
    }
  };
  while (decoder.next() == VideoDecoder::Step::kFrame) {
    if (!filter) {
      filter = std::make_unique<LibavFilter>("bwdif=mode=send_frame", decoder.frame());
    }
    filter->put(decoder.frame());
    compare();
  }
  filter->end();
  compare();
  EXPECT_EQ(compared, 8U);
  for (const int first : {5, 7, 1, 3, 4, 0}) {
    source->skip_to(first);
    Photograph frame;
    ASSERT_TRUE(source->next(frame));
    EXPECT_TRUE(same(frame, all.at(static_cast<std::size_t>(first)))) << first;
  }
}

TEST(FilmProperties, FieldsThatAreTwoImagesKeepTheirColours) {
  const TemporaryFolder folder;
  constexpr int kWidth = 16;
  constexpr int kHeight = 16;
  RawVideo video{"420mpeg2", 8, false, kWidth, kHeight, {}};
  std::vector<int> red;
  std::vector<int> blue;
  for (int i = 0; i < kWidth / 2 * kHeight / 2; ++i) {
    const bool upper = i / (kWidth / 2) % 2 == 0;
    blue.push_back(upper ? 90 : 200);
    red.push_back(upper ? 200 : 90);
  }
  video.frames.push_back({std::vector<int>(kWidth * kHeight, 126), blue, red});
  put_raw_video(folder / "a.y4m", video);
  patch(folder / "a.y4m", " Ip ", " It ");
  PairSourceOptions options = stereo_film(folder / "a.y4m");
  options.packing = StereoPacking{StereoLayout::kRows, false, true};
  const auto pairs = open_pair_source(options);
  FramePair pair;
  ASSERT_TRUE(pairs->fetch(pair));
  pairs->decode(pair);
  for (const Photograph* image : {&pair.left, &pair.right}) {
    const auto& pixels = std::get<Image<std::uint8_t>>(image->pixels);
    EXPECT_EQ(pixels.height(), 8);
    for (const auto [x, y] : positions_of(kWidth, 8)) {
      EXPECT_EQ(pixels.at(x, y, 0), pixels.at(0, 0, 0));
      EXPECT_EQ(pixels.at(x, y, 0) > pixels.at(x, y, 2), image == &pair.right);
    }
  }
  EXPECT_THAT(pairs->remarks(), ElementsAre(HasSubstr("two fields of a picture are the two")));
  options.reading.deinterlaces = true;
  EXPECT_THAT(error_of([&] { open_pair_source(options); }),
              HasSubstr("deinterlace cannot be used with packing irr"));
}

TEST(FilmProperties, AChangeOfSizeInASpliceIsNamed) {
  const TemporaryFolder folder;
  put_numbered_video(folder / "a.mp4", 8, kRate);
  put_numbered_video(folder / "b.mp4", 8, kRate, 96, 64);
  put_tracks({folder / "a.mp4"}, folder / "a.ts", "mpegts");
  put_tracks({folder / "b.mp4"}, folder / "b.ts", "mpegts");
  std::ofstream(folder / "c.ts", std::ios::binary)
      << read_file_text(folder / "a.ts") << read_file_text(folder / "b.ts");
  VideoReader reader(folder / "c.ts");
  for (int i = 0; i < 8; ++i) {
    Photograph frame;
    ASSERT_TRUE(reader.read(frame));
    EXPECT_EQ(number_of_frame(frame), i);
  }
  EXPECT_THAT(error_of([&] { reader.skip(); }),
              testing::AllOf(HasSubstr("frame 8"), HasSubstr("from 64x48 to 96x64")));
}

}  // namespace vantage::film_properties_test
