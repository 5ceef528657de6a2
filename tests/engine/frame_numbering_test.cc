#include "engine/sequence/pairs/frame_numbering.h"

#include "engine/io/video/image_sequence.h"
#include "tests/engine/engine_test.h"

namespace vantage::frame_numbering_test {

/// Files that need not exist, named "l/12.png".
ListedImages numbered(const std::string& folder, const std::vector<long long>& numbers) {
  std::vector<std::filesystem::path> names;
  for (const long long number : numbers) {
    names.emplace_back(std::to_string(number) + ".png");
  }
  return {folder, folder, names};
}

std::vector<std::string> remarks_of(const std::vector<long long>& numbers) {
  const ListedImages source = numbered("l", numbers);
  return numbering_remarks({source, 0, source.frame_count()});
}

std::vector<std::string> remarks_of(const std::vector<long long>& left,
                                    const std::vector<long long>& right, int offset = 0) {
  const ListedImages left_source = numbered("l", left);
  const ListedImages right_source = numbered("r", right);
  const int first_left = std::max(0, -offset);
  const int first_right = std::max(0, offset);
  const int count =
      std::min(left_source.frame_count() - first_left, right_source.frame_count() - first_right);
  return numbering_remarks({left_source, first_left, count}, {right_source, first_right, count});
}

TEST(FrameNumbering, EvenNumbersNeedNoRemark) {
  EXPECT_THAT(remarks_of({5}), IsEmpty());
  EXPECT_THAT(remarks_of({5, 6, 7}), IsEmpty());
  EXPECT_THAT(remarks_of({0, 5, 10, 15}), IsEmpty());
  EXPECT_THAT(remarks_of({1, 2, 3}, {1, 2, 3}), IsEmpty());
  EXPECT_THAT(remarks_of({0, 2, 4}, {0, 2, 4}), IsEmpty());
}

TEST(FrameNumbering, GapsOfOneSequence) {
  EXPECT_THAT(remarks_of({0, 1, 2, 4}),
              ElementsAre("1 frame number is missing between l/0.png and l/4.png: 3"));
  EXPECT_THAT(
      remarks_of({10, 12, 14, 16, 18, 26, 28, 32}),
      ElementsAre("4 frame numbers are missing between l/10.png and l/32.png: 20 to 24, 30"));
  std::vector<long long> numbers;
  for (long long number = 0; number < 40; ++number) {
    if (number % 5 != 3) {
      numbers.push_back(number);
    }
  }
  EXPECT_THAT(remarks_of(numbers),
              ElementsAre("8 frame numbers are missing between l/0.png and l/39.png: 3, 8, 13, 18, "
                          "23 and 3 other gaps"));
}

TEST(FrameNumbering, DuplicatesOfOneSequence) {
  EXPECT_THAT(remarks_of({0, 1, 2, 2, 3}),
              ElementsAre("l/2.png and l/2.png have the same frame number"));
  EXPECT_THAT(remarks_of({0, 1, 1, 1, 2, 3, 4}),
              ElementsAre("l/1.png and l/1.png have the same frame number, and so have 1 others"));
}

TEST(FrameNumbering, UnevenNumbersSayNothing) {
  EXPECT_THAT(remarks_of({1403636579763, 1403636579813, 1403636579862, 1403636579914}), IsEmpty());
  EXPECT_THAT(remarks_of({0, 33, 67, 100, 133, 167, 200, 267}), IsEmpty());
  EXPECT_THAT(remarks_of({10, 11, 10, 11, 10}), IsEmpty());  // 000000_10, 000000_11, 000001_10
  EXPECT_THAT(remarks_of({10, 10, 10}), IsEmpty());
  EXPECT_THAT(remarks_of({10, 11, 10}, {10, 11, 10}), IsEmpty());
  EXPECT_THAT(remarks_of({100, 153, 199}, {103, 150, 204}), IsEmpty()) << "clocks of two cameras";
  ListedImages without("x", "", {"a.png", "b.png"});
  EXPECT_THAT(numbering_remarks({without, 0, 2}, {without, 0, 2}), IsEmpty());
  const ListedImages with = numbered("l", {1, 2});
  EXPECT_THAT(numbering_remarks({with, 0, 2}, {without, 0, 2}), IsEmpty());
}

TEST(FrameNumbering, ANumberMissingOnBothSidesIsADroppedFrame) {
  EXPECT_THAT(remarks_of({0, 1, 3, 4}, {0, 1, 3, 4}),
              ElementsAre("1 frame number is missing on both sides: 2"));
}

TEST(FrameNumbering, ANumberMissingOnOneSideShiftsThePairs) {
  EXPECT_THAT(remarks_of({0, 1, 2, 4, 5}, {0, 1, 2, 3, 4, 5}),
              ElementsAre("1 frame number is missing between l/0.png and l/5.png: 3",
                          "l/4.png is paired with r/3.png from pair 3 on"));
  EXPECT_THAT(remarks_of({0, 1, 2, 3, 4, 6, 7}, {0, 1, 3, 4, 6, 7}),
              ElementsAre("1 frame number is missing on both sides: 5",
                          "1 frame number is missing between r/0.png and r/7.png: 2",
                          "l/2.png is paired with r/3.png from pair 2 on"));
  EXPECT_THAT(remarks_of({100, 153, 199, 251}, {100, 199, 251, 302}),
              ElementsAre("l/153.png is paired with r/199.png from pair 1 on"))
      << "equal times";
}

TEST(FrameNumbering, NumbersThatDifferFromTheStart) {
  EXPECT_THAT(remarks_of({1, 2, 3}, {0, 1, 2}),
              ElementsAre("l/1.png is paired with r/0.png: the numbers differ from the first pair "
                          "on"));
  EXPECT_THAT(remarks_of({0, 1, 2, 3}, {0, 1, 2, 3}, 1), IsEmpty()) << "as the offset says";
  EXPECT_THAT(remarks_of({0, 1, 2, 3}, {0, 1, 2, 3}, -2), IsEmpty());
  EXPECT_THAT(remarks_of({1, 2, 3}, {0, 1, 2, 3}, 1), IsEmpty()) << "the offset makes them agree";
  EXPECT_THAT(remarks_of({0, 2, 4, 6}, {0, 2, 4, 6}, 1), IsEmpty());
  EXPECT_THAT(remarks_of({0, 1, 2, 3, 4}, {10, 11, 12, 14, 15}),
              ElementsAre("1 frame number is missing between r/10.png and r/15.png: 13",
                          "l/0.png is paired with r/10.png: the numbers differ from the first pair "
                          "on",
                          "l/3.png is paired with r/14.png from pair 3 on"));
}

}  // namespace vantage::frame_numbering_test
