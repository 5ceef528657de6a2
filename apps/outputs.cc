#include "apps/outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

#include "engine/error.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> extensions_of(OutputKind kind) {
  switch (kind) {
    case OutputKind::kDisparity:
      return {".pfm", ".png", ".tiff", ".tif", ".exr", ".npy"};
    case OutputKind::kDisplacements:
      return {".flo", ".npy", ".tiff", ".tif", ".exr"};
    case OutputKind::kConfidence:
      return {".pfm", ".tiff", ".tif", ".exr", ".npy"};
    case OutputKind::kPhotograph:
      return {".png", ".jpg", ".jpeg", ".tiff", ".tif", ".bmp",
              ".ppm", ".pgm", ".webp", ".exr",  ".pfm"};
    case OutputKind::kMask:
      return {".png"};
    case OutputKind::kVideo:
      return {".mp4"};
    case OutputKind::kTable:
      return {".csv", ".npy"};
    case OutputKind::kPage:
      return {".html", ".htm"};
    case OutputKind::kPlot:
      return {".svg", ".png", ".jpg", ".jpeg", ".tiff", ".tif", ".bmp", ".ppm", ".webp"};
    case OutputKind::kText:
      break;
  }
  return {};
}

void require_writable(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw Error(fmt::format("{}: cannot be written, it is a folder", path.string()));
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw Error(fmt::format("{}: cannot be written, there is no folder {}", path.string(),
                            folder.string()));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(fmt::format("{}: cannot be written, no permission to write to folder {}",
                            path.string(), folder.string()));
  }
}

}  // namespace

bool has_extension(const fs::path& path, const std::vector<std::string>& extensions) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return std::ranges::find(extensions, extension) != extensions.end();
}

void FileChecks::add_input(const std::string& path) {
  if (!path.empty()) {
    inputs_.emplace_back(path);
  }
}

void FileChecks::add_output(const std::string& path, const std::string& option, OutputKind kind) {
  if (path.empty()) {
    return;
  }
  const auto extensions = extensions_of(kind);
  if (!extensions.empty() && !has_extension(path, extensions)) {
    throw UsageError(fmt::format("{} is '{}', expected a file name that ends in {}", option, path,
                                 fmt::join(extensions, " ")));
  }
  std::error_code ignored;
  const fs::path file = resolved(path);
  for (const fs::path& input : inputs_) {
    if (file == resolved(input) || fs::equivalent(file, input, ignored)) {
      throw UsageError(fmt::format("{} is '{}', which is an input as well", option, path));
    }
  }
  const auto [other, is_new] = outputs_.emplace(file, option);
  if (!is_new) {
    throw UsageError(fmt::format("{} and {} are the same file '{}'", other->second, option, path));
  }
  require_writable(path);
}

fs::path resolved(const fs::path& path) {
  std::error_code ignored;
  const fs::path absolute = fs::absolute(path, ignored);
  const fs::path canonical = fs::weakly_canonical(absolute, ignored);
  return canonical.empty() ? absolute.lexically_normal() : canonical;
}

bool is_pattern(const std::string& path) { return path.find('%') != std::string::npos; }

std::string expand_pattern(const std::string& pattern, int index) {
  const std::size_t begin = pattern.find('%');
  std::size_t end = begin == std::string::npos ? begin : begin + 1;
  std::size_t width = 0;
  bool padded = false;
  if (end != std::string::npos) {
    padded = end < pattern.size() && pattern[end] == '0';
    while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end])) != 0) {
      width = std::min<std::size_t>(width * 10 + static_cast<std::size_t>(pattern[end] - '0'), 100);
      ++end;
    }
  }
  if (end >= pattern.size() || pattern[end] != 'd' || (width > 0 && !padded) || width > 12 ||
      pattern.find('%', end) != std::string::npos) {
    throw UsageError(fmt::format(
        "'{}' is not a pattern for several files, expected one %d or %0Nd such as views/%03d.png",
        pattern));
  }
  return pattern.substr(0, begin) + fmt::format("{:0{}}", index, width) + pattern.substr(end + 1);
}

}  // namespace vantage::apps
