#include "engine/io/files/encoded_text.h"

#include "tests/engine/engine_test.h"

#include <nlohmann/json.hpp>

namespace vantage::stored_name_test {

TEST(StoredName, UsualNamesStayAsTheyAre) {
  for (const std::string name : {"", "left/%06d.png", "a b/c.pfm", "J\xc3\xbcrg/\xe5\xb7\xa6.png",
                                 "\xf0\x9f\x8e\xa5.mp4", "a\\b", "a\\x4", "a\\xZZ", "\\"}) {
    EXPECT_EQ(stored_name(name), name);
    EXPECT_EQ(name_of_stored(name), name);
  }
}

TEST(StoredName, BytesThatAreNoUtf8AreEscaped) {
  EXPECT_EQ(stored_name("x\xff/a.png"), "x\\xff/a.png");
  EXPECT_EQ(stored_name("\xc3\xbc\xc3"), "\xc3\xbc\\xc3");
  EXPECT_EQ(stored_name("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(stored_name("\xc0\xaf"), "\\xc0\\xaf");           // too long a form
  EXPECT_EQ(stored_name("\\xff"), "\\x5cxff");                // would be read as a byte
}

TEST(StoredName, ComesBackByteForByteThroughJson) {
  std::mt19937 random(7);
  // Much of what decides how bytes are read.
  const std::string bytes = "\\x4fF09ab/\x7f\x80\xbf\xc0\xc2\xdf\xe0\xed\xef\xf0\xf4\xf5\xff";
  for (int round = 0; round < 20000; ++round) {
    std::string name;
    for (auto i = random() % 9; i > 0; --i) {
      name += bytes[random() % bytes.size()];
    }
    const std::string stored = stored_name(name);
    const std::string json = nlohmann::json(stored).dump();  // throws where it is no UTF-8
    ASSERT_EQ(name_of_stored(nlohmann::json::parse(json).get<std::string>()), name) << stored;
  }
}

}  // namespace vantage::stored_name_test
