#include "engine/io/files/checksum.h"

#include "tests/engine/engine_test.h"

#include <nlohmann/json.hpp>

namespace vantage::checksum_test {

std::span<const std::uint8_t> bytes_in(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Bit by bit, as the standard has it.
std::uint32_t plain_crc32(const std::string& text) {
  std::uint32_t crc = 0xffffffff;
  for (const unsigned char byte : text) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
    }
  }
  return ~crc;
}

TEST(Checksum, IsTheCommonCrc32) {
  EXPECT_EQ(crc32_of(bytes_in("123456789")), 0xcbf43926U);
  EXPECT_EQ(crc32_of({}), 0U);
  std::string text;
  for (unsigned i = 0; i < 700000; ++i) {
    text += static_cast<char>(i * i >> 3U);
  }
  EXPECT_EQ(crc32_of(bytes_in(text)), plain_crc32(text));
  const TemporaryFolder folder;
  put_text(folder / "file", text);
  EXPECT_EQ(file_content(folder / "file"), (FileContent{text.size(), plain_crc32(text)}));
  EXPECT_EQ(file_content(folder / "none"), std::nullopt);
  EXPECT_EQ(file_content(folder.path()), std::nullopt);
}

TEST(Checksum, OfAnObjectIsItsLastEntry) {
  const nlohmann::ordered_json object = {
      {"frame", 3}, {"files", {{"a,\"crc32\": ", {1, "2"}}}}, {"rest", {{"x", {1, 2}}}}};
  for (const int indent : {-1, 1, 2}) {
    const std::string sealed = with_checksum(object.dump(indent) + "\n");
    auto read = nlohmann::ordered_json::parse(sealed);
    EXPECT_EQ(read.size(), 4U);
    EXPECT_EQ(std::prev(read.end()).key(), "crc32");
    read.erase("crc32");
    EXPECT_EQ(read, object);
    EXPECT_TRUE(has_valid_checksum(sealed));
    EXPECT_TRUE(has_valid_checksum(sealed.substr(0, sealed.size() - 1)));
    for (std::size_t i = 0; i + 2 < sealed.size(); ++i) {
      std::string changed = sealed;
      changed[i] = static_cast<char>(changed[i] ^ 1);
      EXPECT_FALSE(has_valid_checksum(changed)) << changed;
      EXPECT_FALSE(has_valid_checksum(sealed.substr(0, i)));
    }
    EXPECT_FALSE(has_valid_checksum(sealed + "{}"));
    EXPECT_FALSE(has_valid_checksum(object.dump(indent)));
  }
}

}  // namespace vantage::checksum_test
