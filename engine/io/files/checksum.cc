#include "engine/io/files/checksum.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"

namespace vantage {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kKey = "\"crc32\": ";

std::uint32_t crc32_of(std::string_view text) {
  return libdeflate_crc32(0, text.data(), text.size());
}

/// `before`, the content of an object, and its last entry after `gap`.
std::string with_entry(std::string_view before, std::string_view gap) {
  const std::string text = fmt::format("{},{}{}", before, gap, kKey);
  return fmt::format("{}\"{:08x}\"", text, crc32_of(text));
}

}  // namespace

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
  return libdeflate_crc32(0, bytes.data(), bytes.size());
}

std::optional<FileContent> file_content(const std::filesystem::path& file) {
  // A pipe would wait for a writer, and a device may have no end.
  const FileDescriptor input(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!input.valid() || ::fstat(input.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return std::nullopt;
  }
  (void)::posix_fadvise(input.get(), 0, 0, POSIX_FADV_SEQUENTIAL);
  FileContent content;
  std::vector<std::uint8_t> block(std::size_t{1} << 18);
  for (;;) {
    const ssize_t count = ::read(input.get(), block.data(), block.size());
    if (count == 0) {
      return content;
    }
    if (count < 0 && errno != EINTR) {
      return std::nullopt;
    }
    if (count > 0) {
      const auto bytes = static_cast<std::size_t>(count);
      content.crc32 = libdeflate_crc32(content.crc32, block.data(), bytes);
      content.bytes += bytes;
    }
  }
}

std::string with_checksum(std::string_view object) {
  const std::string_view members = object.substr(0, object.rfind('}'));
  const std::size_t end = members.find_last_not_of(kBlanks) + 1;
  // The entry follows directly after the one before it, as in pretty-printed text.
  const std::string_view before = members.substr(0, end);
  const std::size_t line = before.rfind('\n');
  const std::string_view last_line = line == std::string_view::npos ? "" : before.substr(line);
  const std::string_view gap = last_line.substr(0, last_line.find_first_not_of(kBlanks));
  return with_entry(before, gap) + std::string(object.substr(end));
}

bool has_valid_checksum(std::string_view text) {
  const std::size_t key = text.rfind(kKey);
  const std::size_t comma = key == std::string_view::npos ? key : text.rfind(',', key);
  if (comma == std::string_view::npos) {
    return false;
  }
  const std::string expected =
      with_entry(text.substr(0, comma), text.substr(comma + 1, key - comma - 1));
  if (!text.starts_with(expected)) {
    return false;
  }
  const std::string_view rest = text.substr(expected.size());
  const std::size_t brace = rest.find_first_not_of(kBlanks);
  return brace != std::string_view::npos && rest[brace] == '}' &&
         rest.find_first_not_of(kBlanks, brace + 1) == std::string_view::npos;
}

void Fnv1aHash::add(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 0x100000001b3ULL;
  for (const char byte : bytes) {
    value_ = (value_ ^ static_cast<unsigned char>(byte)) * kPrime;
  }
}

void Fnv1aHash::add(std::uint64_t value) {
  char bytes[sizeof(value)];
  for (char& byte : bytes) {
    byte = static_cast<char>(value & 0xffU);
    value >>= 8U;
  }
  add(std::string_view(bytes, sizeof(bytes)));
}

void FileIdentity::add(std::string_view name, const std::filesystem::path& file) {
  // The length separates names from the data after them.
  hash_.add(static_cast<std::uint64_t>(name.size()));
  hash_.add(name);
  struct stat status {};
  const std::optional<FileStatus> remote =
      is_address(file) ? remote_files(file).status(file.string()) : std::nullopt;
  if (remote) {
    ++files_;
    bytes_ += remote->bytes;
    hash_.add(remote->bytes);
    hash_.add(remote->version);
    return;
  }
  if (is_address(file) || ::stat(file.c_str(), &status) != 0) {
    hash_.add(std::string_view("missing"));
    return;
  }
  ++files_;
  bytes_ += static_cast<std::uint64_t>(status.st_size);
  hash_.add(static_cast<std::uint64_t>(status.st_size));
  hash_.add(static_cast<std::uint64_t>(status.st_mtim.tv_sec));
  hash_.add(static_cast<std::uint64_t>(status.st_mtim.tv_nsec));
}

std::string FileIdentity::to_string() const {
  return fmt::format("{} file{}, {} bytes, hash {:016x}", files_, files_ == 1 ? "" : "s", bytes_,
                     hash_.value());
}

}  // namespace vantage
