#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vantage::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Something that reads what others wrote. It takes any bytes: returns, or throws an Error.
struct Target {
  std::string_view name;
  void (*take)(Bytes bytes);
  bool names_input;  ///< messages name the file, which is called "input…"
};

/// All targets that are linked, in any order.
std::vector<Target>& targets();
/// Null where there is none of that name.
const Target* find_target(std::string_view name);

/// A file of targets has one of these for each, in its unnamed namespace.
struct Registration {
  Registration(std::string_view name, void (*take)(Bytes), bool names_input = true) {
    targets().push_back({name, take, names_input});
  }
};

/// Gives `bytes` to the target. Throws std::logic_error for a find that is no crash: an exception
/// that is no Error, a message of several lines or without the file's name, or values that the
/// engine excludes.
void run(const Target& target, Bytes bytes);

inline std::string text_of(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

/// The bytes as a file in a folder of this process, which the next call of that name replaces.
std::filesystem::path file_of(Bytes bytes, const std::string& name = "input");

/// The bytes up to the first zero byte, and those after it.
std::pair<Bytes, Bytes> halves_of(Bytes bytes);

/// Throws std::logic_error unless `holds`.
void require(bool holds, const char* what);

/// Values from the front of bytes; zeros after the end.
class Values {
 public:
  explicit Values(Bytes bytes) : bytes_(bytes) {}

  template <typename T>
  T next() {
    T value{};
    const std::size_t count = std::min(sizeof(T), bytes_.size());
    if (count > 0) {  // memcpy() takes no null pointer
      std::memcpy(&value, bytes_.data(), count);
    }
    bytes_ = bytes_.subspan(count);
    return value;
  }
  /// From `min` to `max`.
  int between(int min, int max) { return min + next<std::uint8_t>() % (max - min + 1); }
  [[nodiscard]] Bytes rest() const { return bytes_; }

 private:
  Bytes bytes_;
};

}  // namespace vantage::fuzz
