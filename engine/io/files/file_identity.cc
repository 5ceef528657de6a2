#include "engine/io/files/file_identity.h"

#include <fmt/format.h>
#include <sys/stat.h>

namespace vantage {

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
  if (::stat(file.c_str(), &status) != 0) {
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
