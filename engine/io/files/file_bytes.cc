#include "engine/io/files/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"

namespace vantage {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<long long> accepted_pixels = kMaxImagePixels;

namespace fs = std::filesystem;

[[noreturn]] void fail_to_read(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("cannot read {}: {}", path.string(), reason));
}

}  // namespace

long long max_image_pixels() { return accepted_pixels; }

void set_max_image_pixels(long long pixels) {
  if (pixels < 1 || pixels > kMaxImagePixels) {
    throw UsageError(fmt::format("max-pixels is {}, expected 1 to {}", pixels, kMaxImagePixels));
  }
  accepted_pixels = pixels;
}

std::vector<std::uint8_t> read_file_bytes(const fs::path& path, bool may_be_empty) {
  // Size of the largest image: float RGBA. Larger files are not images.
  constexpr std::uintmax_t kMaxBytes =
      static_cast<std::uintmax_t>(kMaxImagePixels) * 16 + (1U << 20);
  if (is_address(path)) {
    std::vector<std::uint8_t> bytes = remote_files(path).read(path.string(), kMaxBytes);
    if (bytes.empty() && !may_be_empty) {
      fail_to_read(path, "the file is empty");
    }
    return bytes;
  }
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    fail_to_read(path,
                 status.type() == fs::file_type::not_found ? "no such file" : error.message());
  }
  if (!fs::is_regular_file(status)) {
    fail_to_read(path, fs::is_directory(status) ? "it is a folder, expected a file"
                                                : "it is not a regular file");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) {
    fail_to_read(path, error.message());
  }
  if (size == 0 && !may_be_empty) {
    fail_to_read(path, "the file is empty");
  }
  if (size > kMaxBytes) {
    fail_to_read(path, fmt::format("has {} bytes, too many for an image", size));
  }
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.valid()) {
    fail_to_read(path, std::generic_category().message(errno));
  }
  std::vector<std::uint8_t> bytes(size);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t count = ::read(file.get(), bytes.data() + filled, bytes.size() - filled);
    if (count == 0) {
      break;
    }
    if (count < 0 && errno != EINTR) {
      fail_to_read(path, std::generic_category().message(errno));
    }
    filled += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }
  bytes.resize(filled);
  return bytes;
}

std::string read_file_text(const fs::path& path, bool may_be_empty) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(path, may_be_empty);
  return {bytes.begin(), bytes.end()};
}

void FileBytes::check_dimensions(long long width, long long height) const {
  if (width < 1 || height < 1) {
    fail(fmt::format("its header says {}x{} pixels, expected at least 1x1", width, height));
  }
  if (width > kMaxImageSide || height > kMaxImageSide || width * height > max_image_pixels()) {
    fail(fmt::format("its header says {}x{} pixels, expected at most {} a side and {} in all",
                     width, height, kMaxImageSide, max_image_pixels()));
  }
}

std::string lower_case_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace vantage
