#include "engine/io/files/temporary_name.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <system_error>
#include <vector>

#include "engine/io/files/checksum.h"
#include "engine/io/files/numbered_names.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".tmp-";
constexpr std::size_t kHostDigits = 8;
/// Length of the mark, the host and two numbers with their dashes.
constexpr std::size_t kMaxAdded = 1 + kMark.size() + kHostDigits + 2 * 11;
/// Longer suffixes are not extensions of any format.
constexpr std::size_t kLongestExtension = 16;

std::uint32_t hash_of_host() {
  Fnv1aHash hash;
  std::array<char, 256> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  hash.add(std::string_view(host.data()));
  // Two containers may have the same host name and separate PID namespaces.
  std::error_code ignored;
  hash.add(fs::read_symlink("/proc/self/ns/pid", ignored).string());
  return static_cast<std::uint32_t>(hash.value() ^ (hash.value() >> 32U));
}

/// Stem and extension as used in a temporary name.
std::pair<std::string, std::string> shortened(const fs::path& file) {
  std::string stem = file.stem().string();
  std::string extension = file.extension().string();
  if (extension.size() > kLongestExtension) {
    stem += extension;
    extension.clear();
  }
  const std::size_t room = NAME_MAX - kMaxAdded - extension.size();
  if (stem.size() > room) {
    std::size_t end = room;
    while (end > 0 && (static_cast<unsigned char>(stem[end]) & 0xc0U) == 0x80U) {
      --end;  // not within a character
    }
    stem.resize(end);
  }
  return {stem, extension};
}

/// Removes leading characters that `accepts` returns true for; returns their number.
template <typename Accepts>
std::size_t skip(std::string_view& text, const Accepts& accepts) {
  const auto end = std::ranges::find_if_not(text, accepts);
  const auto count = static_cast<std::size_t>(end - text.begin());
  text.remove_prefix(count);
  return count;
}

bool skip_dash(std::string_view& text) {
  const bool is_dash = text.starts_with('-');
  text.remove_prefix(is_dash ? 1 : 0);
  return is_dash;
}

}  // namespace

std::string temporary_name(const fs::path& file, int number) {
  static const std::uint32_t host = hash_of_host();
  const auto [stem, extension] = shortened(file);
  return fmt::format(".{}{}{:0{}x}-{}-{}{}", stem, kMark, host, kHostDigits, ::getpid(), number,
                     extension);
}

std::optional<std::string> final_name_of(std::string_view temporary) {
  const std::size_t mark = temporary.rfind(kMark);
  if (!temporary.starts_with('.') || mark == std::string_view::npos || mark == 0) {
    return std::nullopt;
  }
  const std::string_view stem = temporary.substr(1, mark - 1);
  std::string_view rest = temporary.substr(mark + kMark.size());
  const auto is_hexadecimal = [](char letter) {
    return is_digit(letter) || (letter >= 'a' && letter <= 'f');
  };
  const bool is_ours = skip(rest, is_hexadecimal) == kHostDigits && skip_dash(rest) &&
                       skip(rest, is_digit) > 0 && skip_dash(rest) && skip(rest, is_digit) > 0 &&
                       (rest.empty() || rest.starts_with('.'));
  return is_ours ? std::optional(std::string(stem) + std::string(rest)) : std::nullopt;
}

void remove_temporary_files(const fs::path& folder,
                            const std::function<bool(const std::string& final_name)>& is_own) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const auto name = final_name_of(entry->path().filename().string());
    if (name && is_own(*name)) {
      found.push_back(entry->path());
    }
  }
  for (const fs::path& path : found) {
    fs::remove(path, error);
  }
}

void remove_temporary_files_of(const fs::path& file) {
  const auto [stem, extension] = shortened(file);
  remove_temporary_files(file.parent_path(), [wanted = stem + extension](const std::string& name) {
    return name == wanted;
  });
}

}  // namespace vantage
