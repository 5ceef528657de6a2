#include "engine/quoted_text.h"

#include "engine/io/files/json_text.h"
#include "engine/message_line.h"
#include "tests/engine/engine_test.h"

namespace vantage::quoted_text_test {

TEST(QuotedText, PrintableKeepsTextAndEscapesWhatSteersATerminal) {
  EXPECT_EQ(printable("left 1.png, größe ∞ 😀"), "left 1.png, größe ∞ 😀");
  EXPECT_EQ(printable("a\nb\r\t"), "a\\nb\\r\\t");
  EXPECT_EQ(printable("\x1B[31mred\x7F"), "\\x1B[31mred\\x7F");
  EXPECT_EQ(printable("\xC2\x9B"), "\\xC2\\x9B");               // a control character of 8 bits
  EXPECT_EQ(printable("x\xFFy\xE2\x82"), "x\\xFFy\\xE2\\x82");  // not UTF-8, and cut off
  EXPECT_EQ(printable("\xC0\xAF\xED\xA0\x80"), "\\xC0\\xAF\\xED\\xA0\\x80");
  EXPECT_EQ(printable(printable("\x1B\n")), printable("\x1B\n"));
  EXPECT_EQ(printable(std::string(1, '\0')), "\\x00");
}

TEST(QuotedText, QuotableShortensLongValues) {
  EXPECT_EQ(quotable(std::string(100, 'a')), std::string(100, 'a'));
  EXPECT_EQ(quotable(std::string(3000, 'a')), std::string(100, 'a') + "... (3000 bytes)");
  // Not in the middle of a character.
  EXPECT_EQ(quotable(std::string(99, 'a') + "öööö"), std::string(99, 'a') + "... (107 bytes)");
}

TEST(QuotedText, ErrorsAreOneLine) {
  EXPECT_STREQ(Error("a\nb\x1B").what(), "a\\nb\\x1B");
  EXPECT_STREQ(UsageError("a\nb").what(), "a\\nb");
}

std::string nested(int levels) {
  return "{\"a\":" + std::string(static_cast<std::size_t>(levels - 1), '[') +
         std::string(static_cast<std::size_t>(levels - 1), ']') + "}";
}

TEST(JsonText, TakesSixtyFourLevelsAndNoMore) {
  EXPECT_EQ(parse_json(nested(64), "f").dump(), nested(64));
  EXPECT_EQ(parse_json("\"" + std::string(100, '[') + "\\\"[\"", "f"),
            std::string(100, '[') + "\"[");
  for (const int levels : {65, 100000}) {
    EXPECT_EQ(error_of([&] { parse_json(nested(levels), "f.json"); }),
              "f.json:1:69: brackets are nested too deep, expected at most 64 levels");
  }
  EXPECT_THAT(error_of([&] { parse_json(std::string(100000, '['), "f"); }), HasSubstr("deep"));
}

TEST(JsonText, SaysWhereItIsNotJsonInWordsOfItsOwn) {
  const auto message = [](const std::string& text) {
    return error_of([&] { parse_json(text, "f.json"); });
  };
  EXPECT_THAT(message("{\n \"a\": 1,\n \"b\": ]\n}"),
              AllOf(HasSubstr("f.json:3:7: is not JSON: unexpected ']'"), HasSubstr("expected")));
  for (const std::string& text :
       {std::string(), std::string("{\"a\""), std::string("[1e999]"), std::string("\x1B"),
        "\"" + std::string(5000, 'x'), std::string("\"\xFF\""), std::string("[1] 2")}) {
    EXPECT_THAT(message(text), AllOf(HasSubstr("f.json"), HasSubstr("not JSON"),
                                     Not(HasSubstr("exception")), Not(HasSubstr("\x1B"))));
    EXPECT_LT(message(text).size(), 200U);
  }
}

TEST(JsonText, QuotesValuesShortened) {
  EXPECT_EQ(quoted_json("a\n"), "'a\\n'");
  EXPECT_EQ(quoted_json({1, "b"}), "[1,\"b\"]");
  EXPECT_THAT(quoted_json(nlohmann::ordered_json(std::vector<int>(1000, 7))), HasSubstr("bytes)"));
  EXPECT_EQ(quoted_json("\xFF"), "'\\xFF'");
}

TEST(MessageLine, IsShortAndPrintable) {
  EXPECT_EQ(message_line("a\nb"), "a\\nb");
  const std::string whole(4000, 'a');
  EXPECT_EQ(message_line(whole), whole);
  EXPECT_EQ(message_line(whole + 'b'), whole + "... (4001 bytes)");
  // A character of two bytes lies across the limit.
  EXPECT_EQ(message_line(whole.substr(1) + "\u00e9"), whole.substr(1) + "... (4001 bytes)");
}

}  // namespace vantage::quoted_text_test
