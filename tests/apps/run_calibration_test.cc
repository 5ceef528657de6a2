// Runs that rectify their pairs first.

#include <array>

#include "engine/image/stereo_packing.h"
#include "engine/rectification/rectifier.h"
#include "tests/apps/run_fixture.h"

namespace vantage::run_calibration_test {

constexpr int kFrame = 3;

class RunCalibration : public RunTest {
 protected:
  void SetUp() override { write_file(rig_, kTurnedRig); }

  [[nodiscard]] Words with_rig(const Words& more) const {
    return joined({"--calibration", rig_}, more);
  }

  /// A frame as the run saw it: the views at its cameras are the photographs themselves.
  [[nodiscard]] std::array<Image<std::uint8_t>, 2> seen_by_run(const std::string& out,
                                                               const Words& more) const {
    succeeds(run(out, joined(more, {"--save", "stereo", "--stereo-views", "0,1", "--frames",
                                    std::to_string(kFrame) + "-" + std::to_string(kFrame)})));
    Photograph left;
    Photograph right;
    unpack_stereo(read_photograph(out + "/stereo/" + frame_file(kFrame)), {}, left, right);
    return {std::get<Image<std::uint8_t>>(std::move(left.pixels)),
            std::get<Image<std::uint8_t>>(std::move(right.pixels))};
  }

  std::string rig_ = folder_ / "rig.yml";
};

bool same_pixels(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
  const int values = a.width() * a.channels();
  bool same = a.width() == b.width() && a.height() == b.height() && a.channels() == b.channels();
  for (int y = 0; same && y < a.height(); ++y) {
    same = std::equal(a.row(y), a.row(y) + values, b.row(y));
  }
  return same;
}

TEST_F(RunCalibration, MatchesRectifiedFramesAndKeepsAsMuchOfThemAsIsAskedFor) {
  Execution execution(ExecutionOptions{});
  const StereoCalibration calibration = read_stereo_calibration(rig_);
  for (const std::string kept : {"0", "0.5", "1"}) {
    const auto seen = seen_by_run(folder_ / ("kept-" + kept), with_rig({"--kept-outline", kept}));
    const Rectifier rectifier(calibration, kWidth, kHeight, {.kept_outline = std::stod(kept)});
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const std::string& folder = side == Side::kLeft ? left_ : right_;
      Photograph expected;
      rectifier.apply(read_photograph(folder + "/" + frame_file(kFrame)), side, expected,
                      execution);
      EXPECT_TRUE(same_pixels(seen[index_of(side)], std::get<Image<std::uint8_t>>(expected.pixels)))
          << "kept-outline " << kept;
    }
  }
}

using InputRunCalibration = RunCalibration;

TEST_F(InputRunCalibration, RefusesAnOutlineThatCannotBeKept) {
  for (const auto& [more, says] :
       {std::pair{Words{"--kept-outline", "1"},
                  "--kept-outline has no effect without --calibration"},
        {with_rig({"--kept-outline", "1.5"}), "kept-outline is 1.5, expected 0 to 1"}}) {
    expect_one_line(run(folder_ / "out", joined(more, {"--quiet"})), 2, "run", says);
  }
}

// What a frame becomes depends on it, so a run must not go on with another one.
TEST_F(RunCalibration, AnotherOutlineIsAnotherRun) {
  const std::string out = folder_ / "out";
  succeeds(run(out, with_rig({"--frames", "0-1"})));
  expect_failure(run(out, with_rig({"--kept-outline", "1", "--resume", "--quiet"})), 1,
                 "kept-outline");
}

}  // namespace vantage::run_calibration_test
