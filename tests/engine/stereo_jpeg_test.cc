#include "engine/io/images/stereo_jpeg.h"

#include "engine/image/orientation.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/sequence/pairs/pair_source.h"
#include "tests/engine/engine_test.h"
#include "tests/tagged_files.h"

namespace vantage::stereo_jpeg_test {

using Bytes = std::vector<std::uint8_t>;

/// A JPEG file of noise that is smooth enough for a lossy codec.
std::string jpeg_of(const TemporaryFolder& folder, const Photograph& photograph) {
  write_photograph(folder / "one.jpg", photograph);
  const Bytes bytes = bytes_of(folder / "one.jpg");
  return {bytes.begin(), bytes.end()};
}

class StereoJpegs : public testing::Test {
 protected:
  StereoJpegs() {
    for (const unsigned seed : {1U, 2U, 3U}) {
      jpegs_.push_back(jpeg_of(folder_, noise<std::uint8_t>(32, 16, 3, seed)));
      images_.push_back(read_photograph(folder_ / "one.jpg"));
    }
  }
  Photograph read(const std::string& name) { return read_photograph(folder_ / name); }

  TemporaryFolder folder_;
  std::vector<std::string> jpegs_;
  std::vector<Photograph> images_;  ///< of the files
};

TEST_F(StereoJpegs, MpoHasTheViewsOfItsIndexButThumbnails) {
  constexpr std::uint32_t kDisparity = 0x020002;
  constexpr std::uint32_t kThumbnail = 0x010001;
  const std::string mpo = mpo_of(jpegs_, {kDisparity, kThumbnail, kDisparity});
  put_text(folder_ / "a.mpo", mpo);
  put_text(folder_ / "b.jpg", mpo);  // the index says it
  for (const std::string name : {"a.mpo", "b.jpg"}) {
    EXPECT_TRUE(is_stereo_jpeg(folder_ / name));
    EXPECT_TRUE(same(read(name), images_[0]));
    EXPECT_THAT(read(name).origin.remarks.at(0).text, HasSubstr("first of 2 images"));
    EXPECT_TRUE(same(read(name + "#0"), images_[0]));
    EXPECT_TRUE(same(read(name + "#1"), images_[2]));
    EXPECT_THAT(error_of([&] { read(name + "#2"); }), HasSubstr("has 2 images"));
  }
  // Without a type, as Pillow writes it: a picture of its own, unless its name says more.
  put_text(folder_ / "c.mpo", mpo_of({jpegs_[0], jpegs_[1]}, {0x030000, 0}));
  put_text(folder_ / "d.jpg", mpo_of({jpegs_[0], jpegs_[1]}, {0x030000, 0}));
  EXPECT_TRUE(same(read("c.mpo#1"), images_[1]));
  EXPECT_FALSE(is_stereo_jpeg(folder_ / "d.jpg"));
  EXPECT_TRUE(read("d.jpg").origin.remarks.empty());
  put_text(folder_ / "e.mpo", mpo.substr(0, mpo.size() - 9));
  EXPECT_THAT(error_of([&] { read("e.mpo#1"); }), HasSubstr("truncated"));
}

TEST_F(StereoJpegs, JpsHasTheHalvesThatItsMarkerNames) {
  Photograph packed;
  pack_stereo(images_[0], images_[1], {}, packed);
  const std::string jpeg = jpeg_of(folder_, packed);
  const Photograph whole = read("one.jpg");
  Photograph left;
  Photograph right;
  unpack_stereo(whole, {}, left, right);
  const auto marker = [&](const std::string& descriptor) {
    return with_segment(jpeg, 0xE3, "_JPSJPS_" + big(4, 2) + descriptor);
  };
  // Separation, flags (4: left first), layout (2: side by side), kind (1: stereo).
  put_text(folder_ / "a.jpg", marker(std::string("\x00\x04\x02\x01", 4)));
  put_text(folder_ / "b.jps", marker(std::string("\x00\x00\x02\x01", 4)));
  put_text(folder_ / "c.jps", jpeg);
  EXPECT_TRUE(same(read("a.jpg"), whole));
  EXPECT_TRUE(same(read("a.jpg#0"), left));
  EXPECT_TRUE(same(read("a.jpg#1"), right));
  for (const std::string name : {"b.jps", "c.jps"}) {  // cross-eyed, as is usual
    EXPECT_TRUE(same(read(name + "#0"), right));
    EXPECT_TRUE(same(read(name + "#1"), left));
    EXPECT_EQ(read(name + "#0").origin.remarks.size(), name == "c.jps" ? 1U : 0U);
  }
  put_text(folder_ / "d.jps", marker(std::string("\x00\x00\x04\x01", 4)));
  EXPECT_THAT(error_of([&] { read("d.jps#0"); }), HasSubstr("anaglyph"));
  EXPECT_FALSE(is_stereo_jpeg(folder_ / "d.jps"));
  // Kind 0: a picture of its own.
  put_text(folder_ / "e.jpg", marker(std::string("\x00\x04\x02\x00", 4)));
  EXPECT_FALSE(is_stereo_jpeg(folder_ / "e.jpg"));
  EXPECT_TRUE(same(read("e.jpg"), whole));
}

TEST_F(StereoJpegs, FolderOfThemIsOneOfPairs) {
  std::filesystem::create_directory(folder_ / "mpo");
  for (const char* name : {"mpo/1.mpo", "mpo/2.mpo"}) {
    put_text(folder_ / name, mpo_of({jpegs_[0], jpegs_[1]}, {0x020002, 0x020002}));
  }
  PairSourceOptions options;
  options.stereo = folder_ / "mpo";
  const auto pairs = open_pair_source(options);
  ASSERT_EQ(pairs->pair_count(), 2);
  FramePair pair;
  ASSERT_TRUE(pairs->fetch(pair));
  pairs->decode(pair);
  EXPECT_TRUE(same(pair.left, images_[0]));
  EXPECT_TRUE(same(pair.right, images_[1]));
}

TEST_F(StereoJpegs, PhotographsAreTurnedAsTheirExifSays) {
  const Photograph photograph = noise<std::uint8_t>(9, 5, 3);
  write_photograph(folder_ / "a.png", photograph);
  const Bytes bytes = bytes_of(folder_ / "a.png");
  const std::string png(bytes.begin(), bytes.end());
  const Bytes lossless = [&] {
    write_photograph(folder_ / "a.webp", photograph);
    return bytes_of(folder_ / "a.webp");
  }();
  const Photograph from_webp = read("a.webp");
  const auto little = [](std::uint32_t value, int count) {
    std::string text = big(value, count);
    std::reverse(text.begin(), text.end());
    return text;
  };
  for (int tag = 1; tag <= 8; ++tag) {
    const Orientation orientation = orientation_of_tag(tag);
    const auto expect_turned = [&](const std::string& name, const Photograph& stored) {
      SCOPED_TRACE(name + " " + std::to_string(tag));
      const auto& pixels = std::get<Image<std::uint8_t>>(stored.pixels);
      EXPECT_TRUE(same(read(name), Photograph{turned<std::uint8_t>(pixels.view(), orientation)}));
      EXPECT_EQ(read(name).origin.remarks.size(), tag == 1 ? 0U : 1U);
      EXPECT_TRUE(same(read_photograph(folder_ / name, {.turns_upright = false}), stored));
    };
    put_text(folder_ / "t.jpg",
             with_segment(jpegs_[0], 0xE1, std::string("Exif\0\0", 6) + exif(tag)));
    expect_turned("t.jpg", images_[0]);
    put_text(folder_ / "t.png", with_exif_chunk(png, tag));
    expect_turned("t.png", photograph);
    // RIFF of an extended header (flag 8: EXIF), the picture, and the EXIF data.
    const std::string picture(lossless.begin() + 12, lossless.end());
    const std::string data = exif(tag);
    const std::string webp = "WEBPVP8X" + little(10, 4) + little(8, 4) + little(9 - 1, 3) +
                             little(5 - 1, 3) + picture + "EXIF" +
                             little(static_cast<std::uint32_t>(data.size()), 4) + data;
    put_text(folder_ / "t.webp",
             "RIFF" + little(static_cast<std::uint32_t>(webp.size()), 4) + webp);
    expect_turned("t.webp", from_webp);
  }
}

TEST_F(StereoJpegs, PairOfDifferentTurnsIsAnError) {
  put_text(folder_ / "l.jpg", with_segment(jpegs_[0], 0xE1, std::string("Exif\0\0", 6) + exif(3)));
  put_text(folder_ / "r.jpg", jpegs_[1]);
  PairSourceOptions options;
  options.left = folder_ / "l.jpg";
  options.right = folder_ / "r.jpg";
  const auto problem = [&] {
    const auto pairs = open_pair_source(options);
    FramePair pair;
    pairs->fetch(pair);
    pairs->decode(pair);
  };
  EXPECT_THAT(error_of(problem), AllOf(HasSubstr("left image is turned by 180 degrees"),
                                       HasSubstr("right one as stored")));
  options.reading.turns_upright = false;
  EXPECT_EQ(error_of(problem), "");
}

}  // namespace vantage::stereo_jpeg_test
