#include "engine/io/files/encoded_text.h"

#include "tests/decoded_base64.h"
#include "tests/engine/engine_test.h"

namespace vantage::base64_test {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Base64, EqualsTheExamplesOfTheStandard) {
  const std::vector<std::pair<std::string, std::string>> examples = {{"", ""},
                                                                     {"f", "Zg=="},
                                                                     {"fo", "Zm8="},
                                                                     {"foo", "Zm9v"},
                                                                     {"foob", "Zm9vYg=="},
                                                                     {"fooba", "Zm9vYmE="},
                                                                     {"foobar", "Zm9vYmFy"},
                                                                     {"\xFF\xEF", "/+8="}};
  for (const auto& [plain, encoded] : examples) {
    EXPECT_EQ(encode_base64(bytes_of(plain)), encoded);
  }
}

TEST(Base64, ComesBackWhateverTheLength) {
  // The last ones are longer than the blocks it works in.
  for (const std::size_t size : {1U, 2U, 3U, 4U, 255U, 3U << 20, (3U << 20) + 1, (6U << 20) + 5}) {
    std::vector<std::uint8_t> bytes(size);
    std::uint32_t state = 1;
    for (std::uint8_t& byte : bytes) {
      state = state * 1664525U + 1013904223U;
      byte = static_cast<std::uint8_t>(state >> 24);
    }
    const std::string text = encode_base64(bytes);
    EXPECT_EQ(text.size(), (size + 2) / 3 * 4);
    EXPECT_EQ(text.find('\0'), std::string::npos);
    EXPECT_EQ(decoded_base64(text), bytes) << size;
  }
}

}  // namespace vantage::base64_test
