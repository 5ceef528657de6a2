#include "engine/scene_graph/position_list.h"

#include "tests/engine/engine_test.h"

#include <fmt/format.h>

namespace vantage::position_list_test {

std::vector<std::string> parsed(const std::string& text) {
  std::vector<std::string> images;
  for (const SceneImage& image : parse_position_list(text, "folder/list.csv")) {
    images.push_back(
        fmt::format("{} {} {}", image.file.string(), image.position.x, image.position.y));
  }
  return images;
}

std::string problem(const std::string& text) {
  return error_of([&] { parse_position_list(text, "list.csv"); });
}

TEST(PositionList, LinesWithAndWithoutHeading) {
  EXPECT_THAT(parsed("image,x,y\na.png,0,1.5\n/b/c.png,-2e-1,0\n"),
              ElementsAre("folder/a.png 0 1.5", "/b/c.png -0.2 0"));
  EXPECT_THAT(parsed("# comment\n\"a, b.png\" , 3 , 4\r\n"), ElementsAre("folder/a, b.png 3 4"));
}

TEST(PositionList, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(problem("a.png,0\n"), HasSubstr("list.csv line 1: 2 fields, expected three"));
  EXPECT_THAT(problem("image,x,y\na.png,0,one\n"), HasSubstr("line 2: y is 'one'"));
  EXPECT_THAT(problem("a.png,nan,0\n"), HasSubstr("x is 'nan', expected a finite number"));
  EXPECT_THAT(problem("a.png,1 2,0\n"), HasSubstr("x is '1 2'"));
  EXPECT_THAT(problem(",1,0\n"), HasSubstr("the name is empty"));
  EXPECT_THAT(problem("image,x,y\n"), HasSubstr("holds no images"));
  EXPECT_THAT(problem(""), HasSubstr("holds no images"));
}

}  // namespace vantage::position_list_test
