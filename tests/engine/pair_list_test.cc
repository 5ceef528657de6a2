#include "engine/sequence/pairs/pair_list.h"

#include "tests/engine/engine_test.h"

namespace vantage::pair_list_test {

using namespace std::string_literals;

/// "left|right" of every pair.
std::vector<std::string> parsed(const std::string& text) {
  std::vector<std::string> pairs;
  for (const ListedPair& pair : parse_pair_list(text, "list.csv")) {
    pairs.push_back(pair.left.string() + "|" + pair.right.string());
  }
  return pairs;
}

std::string problem(const std::string& text) {
  return error_of([&] { parse_pair_list(text, "list.csv"); });
}

TEST(PairList, LinesWithAndWithoutHeading) {
  EXPECT_THAT(parsed("a.png,b.png\nc.png,d.png\n"), ElementsAre("a.png|b.png", "c.png|d.png"));
  EXPECT_THAT(parsed("left,right\na,b"), ElementsAre("a|b"));
  EXPECT_THAT(parsed("Left, RIGHT\na,b"), ElementsAre("a|b"));
  EXPECT_THAT(parsed("a,b\nleft,right\n"), ElementsAre("a|b", "left|right"));
  EXPECT_THAT(parsed("l/a b.png , r/c.png\t\n"), ElementsAre("l/a b.png|r/c.png"));
}

TEST(PairList, EmptyLinesCommentsAndMark) {
  EXPECT_THAT(parsed("\xEF\xBB\xBFleft,right\n\n# a comment, \"with a quote\n  \t\na,b\n\n#"),
              ElementsAre("a|b"));
  EXPECT_THAT(parsed("\xEF\xBB\xBF# one\n#two\na#,#b\n"), ElementsAre("a#|#b"));
  EXPECT_THAT(parsed("\"#a\",b"), ElementsAre("#a|b"));
}

TEST(PairList, LineEnds) {
  EXPECT_THAT(parsed("a,b\r\nc,d\r\n"), ElementsAre("a|b", "c|d"));
  EXPECT_THAT(parsed("a,b\rc,d\r"), ElementsAre("a|b", "c|d"));
  EXPECT_THAT(parsed("#x\r\n\r\na,b\r\n\n\rc,d"), ElementsAre("a|b", "c|d"));
}

TEST(PairList, Quotes) {
  EXPECT_THAT(parsed("\"a,1.png\",\"b \"\"2\"\".png\"\n"), ElementsAre("a,1.png|b \"2\".png"));
  EXPECT_THAT(parsed(" \"a\" , \" b \" \n\"c\nd\",\"e\r\nf\"\ng,h"),
              ElementsAre("a| b ", "c\nd|e\r\nf", "g|h"));
  EXPECT_THAT(parsed("\"\"\"\",\"\"\"\"\"\""), ElementsAre("\"|\"\""));
  EXPECT_THAT(parsed("\"left\",\"right\"\na,b"), ElementsAre("a|b"));
}

TEST(PairList, OtherSeparators) {
  EXPECT_THAT(parsed("a 1.png;b 1.png\nc.png;d.png"), ElementsAre("a 1.png|b 1.png", "c.png|d.png"))
      << "of a German spreadsheet";
  EXPECT_THAT(parsed("left\tright\na b\tc d"), ElementsAre("a b|c d"));
  EXPECT_THAT(parsed("a.png  b.png \n \"c d\" e.png"), ElementsAre("a.png|b.png", "c d|e.png"));
  const auto pairs = parse_pair_list("name;left;right\r\ngate;a;b\r\n;c;d", "list.csv");
  EXPECT_EQ(pairs.at(0).details.name, "gate");
  EXPECT_EQ(pairs.at(1).right, "d");
  EXPECT_THAT(problem("a;b;c"), HasSubstr("3 fields, expected two: left,right; further columns"));
  EXPECT_EQ(problem("a;b\nc\n"), "list.csv line 2: 1 field, expected two: left,right");
}

TEST(PairList, AFirstLineWithoutFilesIsAHeading) {
  const TemporaryFolder folder;
  put_text(folder / "a.png", "");
  put_text(folder / "list.csv", "file_left,file_right\na.png,a.png\nb.png,a.png\n");
  std::vector<std::string> remarks;
  EXPECT_EQ(read_pair_list(folder / "list.csv", &remarks).size(), 2U);
  EXPECT_THAT(remarks,
              ElementsAre(HasSubstr("'file_left' and 'file_right' are taken for a heading")));
  // A missing image is one, and nothing tells that a line is a heading where no other has files.
  put_text(folder / "list.csv", "b.png,a.png\na.png,a.png\n");
  EXPECT_EQ(read_pair_list(folder / "list.csv").size(), 2U);
  put_text(folder / "list.csv", "file_left,file_right\nb.png,c.png\n");
  EXPECT_EQ(read_pair_list(folder / "list.csv").size(), 2U);
}

TEST(PairList, MalformedLinesAreNamed) {
  EXPECT_EQ(problem("a,b\n\n#\nc\n"), "list.csv line 4: 1 field, expected two: left,right");
  EXPECT_EQ(problem("a,b,c"),
            "list.csv line 1: 3 fields, expected two: left,right; further columns need a heading");
  EXPECT_THAT(problem("a,b,"), HasSubstr("list.csv line 1: 3 fields, expected two: left,right"));
  EXPECT_THAT(problem("\"a\nb\",c\n,d"), HasSubstr("line 3: the left name is empty"));
  EXPECT_THAT(problem("a,\"\""), HasSubstr("line 1: the right name is empty"));
  EXPECT_THAT(problem("a,b\r\nc,\"d\r\ne,f\r\n"), HasSubstr("line 2: a quote is not closed"));
  EXPECT_THAT(problem("a,b\r\n\"c\r\nd\"e,f\n"), HasSubstr("line 3: text after a closing quote"));
  EXPECT_THAT(problem("a,b\rc,d\"e\n"), HasSubstr("line 2: a quote inside of 'd\"e'"));
  EXPECT_THAT(problem("a,b\0"s), HasSubstr("list.csv: holds a zero byte"));
  for (const char* nothing : {"", "\n", "left,right\n", "# a,b", "\xEF\xBB\xBF", "\r\n\r\n"}) {
    EXPECT_THAT(problem(nothing), HasSubstr("list.csv: holds no pairs")) << nothing;
  }
}

TEST(PairList, AHeadingNamesFurtherColumnsInAnyOrder) {
  const auto pairs = parse_pair_list(
      "Name,right,left,max-disparity,min-disparity,calibration\n"
      "tower,b.png,a.png,40,-3,rigs/one.yml\n"
      ",d.png,c.png,,,\n",
      "folder/list.csv");
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].left, "a.png");
  EXPECT_EQ(pairs[0].right, "b.png");
  EXPECT_EQ(pairs[0].details, (PairDetails{.name = "tower",
                                           .calibration = "folder/rigs/one.yml",
                                           .disparities = DisparityRange{-3, 40}}));
  EXPECT_EQ(pairs[1].left, "c.png");
  EXPECT_EQ(pairs[1].details, PairDetails());
}

TEST(PairList, FoldersOfAPairNameItsCamerasOfKitti) {
  const auto pairs = parse_pair_list(
      "left,right,calibration\nimage_2/a.png,image_3/a.png,c.txt\nimage_0/a.png,image_1/"
      "a.png,c.txt\n"
      "image_2/a.png,image_1/a.png,c.txt\nimage_2/a.png,image_3/a.png,\n",
      "list.csv");
  EXPECT_EQ(pairs[0].details.kitti_cameras, KittiCameras::kColour);
  EXPECT_EQ(pairs[1].details.kitti_cameras, KittiCameras::kGrey);
  EXPECT_EQ(pairs[2].details.kitti_cameras, std::nullopt);
  EXPECT_EQ(pairs[3].details, PairDetails());
}

TEST(PairList, WrongColumnsAndFieldsAreNamed) {
  EXPECT_EQ(problem("left,right,width\na,b,3"),
            "list.csv line 1: the column 'width' is not known, expected left, right, name, "
            "calibration, min-disparity, max-disparity");
  EXPECT_THAT(problem("left,right,name,NAME\n"), HasSubstr("the column name is given twice"));
  EXPECT_THAT(problem("left,right,min-disparity\n"),
              HasSubstr("one of the columns min-disparity and max-disparity is missing"));
  EXPECT_EQ(problem("left,right,name\na,b"),
            "list.csv line 2: 2 fields, expected 3 as in the "
            "heading");
  for (const char* name : {"a/b", "..", ".hidden", "a\\b", "\"a\tb\"", "caf\xe9"}) {
    EXPECT_THAT(problem("left,right,name\na,b,"s + name), HasSubstr("line 2: the name is '"))
        << name;
  }
  EXPECT_EQ(problem("left,right,name\na,b,x\na,b,y\na,b,x"),
            "list.csv line 4: the name 'x' is that of line 2, too, expected different names");
  // --every may give any pair any number.
  EXPECT_THAT(problem("left,right,name\na,b,\na,b,x\na,b,0000001\n"),
              HasSubstr("line 4: the name '0000001' looks like the number of a pair"));
  EXPECT_EQ(parse_pair_list("left,right,name\na,b,000001\na,b,12\n", "list.csv").size(), 2U);
  for (const char* range : {"5,4", "0,", ",9", "1.5,9", "a,b", "0,9px"}) {
    EXPECT_THAT(problem("left,right,min-disparity,max-disparity\na,b,"s + range),
                HasSubstr("line 2: the disparities are '"))
        << range;
  }
}

TEST(PairList, AnyTextIsPairsOrAnErrorOfOneLine) {
  std::mt19937 generator(3);
  const std::string characters = "a,b\"#\r\n \0"s;
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    for (unsigned length = generator() % 16; length > 0; --length) {
      text.push_back(characters[generator() % characters.size()]);
    }
    if (const std::string error = problem(text); !error.empty()) {
      EXPECT_TRUE(error.starts_with("list.csv")) << error;
      EXPECT_EQ(error.find_first_of("\r\n"), std::string::npos) << error;
    } else {
      EXPECT_FALSE(parsed(text).empty());
    }
  }
}

TEST(PairList, FilesAreReadOrNamed) {
  const TemporaryFolder folder;
  put_text(folder / "list.csv", "a,b\n");
  EXPECT_EQ(read_pair_list(folder / "list.csv").size(), 1U);
  EXPECT_THAT(error_of([&] { read_pair_list(folder / "no.csv"); }), HasSubstr("no such file"));
  put_text(folder / "list.csv", "a\n");
  EXPECT_THAT(error_of([&] { read_pair_list(folder / "list.csv"); }),
              HasSubstr(folder / "list.csv" + " line 1: "));
}

}  // namespace vantage::pair_list_test
