#include "engine/image/orientation.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "tests/apps/pair_fixture.h"
#include "tests/tagged_files.h"

namespace vantage::match_camera_files_test {

/// Photographs as cameras store them.
class MatchCameraFiles : public PairTest {
 protected:
  /// The same picture, stored upside down, with a tag that says so.
  std::string upside_down(const Photograph& photograph, const char* name) {
    const auto& pixels = std::get<Image<std::uint8_t>>(photograph.pixels);
    const std::string file = folder_ / name;
    write_photograph(file, {turned<std::uint8_t>(pixels.view(), Orientation::kTurn180)});
    write_text_file(file, with_exif_chunk(read_file_text(file), 3));
    return file;
  }
  ProcessResult match_files(const Words& images, const std::string& out, const Words& more = {}) {
    return run_vantage(
        joined(joined({"match"}, images), joined({"-o", out, "--disparities=0:9"}, more)));
  }
};

TEST_F(MatchCameraFiles, AreTurnedUprightBeforeTheyAreMatched) {
  const std::string left = upside_down(pair_.left, "l.png");
  const std::string right = upside_down(pair_.right, "r.png");
  succeeds(match(folder_ / "upright.pfm"));
  const ProcessResult result = succeeds(
      match_files({left, right}, folder_ / "turned.pfm", {"--report", folder_ / "a.json"}));
  EXPECT_EQ(read_file_text(folder_ / "turned.pfm"), read_file_text(folder_ / "upright.pfm"));
  EXPECT_THAT(result.err, HasSubstr("match: images are turned by 180 degrees, as their files say "
                                    "(--orientation stored leaves them)\n"));
  EXPECT_THAT(read_file_text(folder_ / "a.json"), HasSubstr("turned by 180 degrees"));

  const ProcessResult one_side = match_files({left, right_}, folder_ / "no.pfm");
  EXPECT_EQ(one_side.exit_code, 1);
  EXPECT_THAT(one_side.err, HasSubstr("left image is turned by 180 degrees, but the right one as"));
  EXPECT_FALSE(fs::exists(folder_ / "no.pfm"));
  succeeds(match_files({left, right}, folder_ / "stored.pfm", {"--orientation", "stored"}));
  EXPECT_NE(read_file_text(folder_ / "stored.pfm"), read_file_text(folder_ / "upright.pfm"));
}

TEST_F(MatchCameraFiles, HoldBothViews) {
  write_photograph(folder_ / "l.jpg", pair_.left);
  write_photograph(folder_ / "r.jpg", pair_.right);
  write_text_file(folder_ / "both.mpo",
                  mpo_of({read_file_text(folder_ / "l.jpg"), read_file_text(folder_ / "r.jpg")},
                         {0x020002, 0x020002}));
  succeeds(match_files({folder_ / "l.jpg", folder_ / "r.jpg"}, folder_ / "two.pfm"));
  succeeds(match_files({folder_ / "both.mpo"}, folder_ / "one.pfm"));
  EXPECT_EQ(read_file_text(folder_ / "one.pfm"), read_file_text(folder_ / "two.pfm"));
  const ProcessResult no_views = match_files({left_}, folder_ / "no.pfm");
  EXPECT_EQ(no_views.exit_code, 2);
  EXPECT_THAT(no_views.err, HasSubstr("RIGHT is missing"));
}

}  // namespace vantage::match_camera_files_test
