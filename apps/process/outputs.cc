#include "apps/process/outputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/existing_files.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/numbered_part.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/maps/map_formats.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> map_extensions(MapContent content) {
  std::vector<std::string> extensions;
  for (const MapFormat& format : map_formats()) {
    if (format.can_hold(content)) {
      extensions.emplace_back(format.extension);
    }
  }
  return extensions;
}

std::vector<std::string> extensions_of(OutputKind kind) {
  switch (kind) {
    case OutputKind::kDisparity:
      return map_extensions(MapContent::kDisparity);
    case OutputKind::kDisplacements:
      return map_extensions(MapContent::kDisplacements);
    case OutputKind::kConfidence:
      return map_extensions(MapContent::kConfidence);
    case OutputKind::kPhotograph:
      return {".png", ".jpg", ".jpeg", ".tiff", ".tif", ".bmp",
              ".ppm", ".pgm", ".webp", ".exr",  ".pfm"};
    case OutputKind::kMask:
      return {".png"};
    case OutputKind::kVideo:
      return {".mp4"};
    case OutputKind::kTable:
      return {".csv"};
    case OutputKind::kVolume:
      return {".npy"};
    case OutputKind::kDepth:
      return map_extensions(MapContent::kDepth);
    case OutputKind::kPoints:
      return {".ply"};
    case OutputKind::kPage:
      return {".html", ".htm"};
    case OutputKind::kText:
      break;
  }
  return {};
}

void require_writable(const fs::path& path) {
  if (is_address(path)) {
    remote_files(path).check_writable(path.string());
    return;
  }
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
  return std::ranges::find(extensions, lower_case_extension(path)) != extensions.end();
}

FileChecks::FileChecks(const Settings& settings) {
  for (const std::string& path : settings.input_paths()) {
    for (const fs::path& file : is_address(path) || fs::exists(path) ? std::vector<fs::path>{path}
                                                                     : calibration_files(path)) {
      add_input(file);
    }
  }
}

bool FileChecks::find_id(const fs::path& path, FileId& id) {
  struct stat status {};
  if (is_address(path) || ::stat(path.c_str(), &status) != 0) {
    return false;
  }
  id = {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino)};
  return true;
}

void FileChecks::refuse_in_folder(const Output& output, const Output& folder) {
  throw UsageError(fmt::format("{} is '{}', inside the output folder of {}", output.option,
                               output.path.string(), folder.option));
}

std::vector<fs::path> FileChecks::folders_of(const fs::path& path) {
  const auto folder_of = [](const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
  };
  std::vector<fs::path> folders = {folder_of(path)};
  std::error_code ignored;
  if (fs::is_symlink(path, ignored)) {
    folders.push_back(folder_of(resolved(path)));
  }
  return folders;
}

void FileChecks::add_input(const fs::path& spec) {
  if (spec.empty()) {
    return;
  }
  const fs::path path = numbered_part(spec).file;
  const auto refuse = [&](const Output& output) {
    throw UsageError(
        fmt::format("{} is '{}', which is also an input", output.option, output.path.string()));
  };
  const auto refuse_folder = [&](const Output& output) {
    throw UsageError(fmt::format("{} would write into '{}', which contains the input '{}'",
                                 output.option, output.path.string(), path.string()));
  };
  FileId id;
  if (find_id(path, id)) {
    input_ids_.try_emplace(id, path);
    if (const auto output = output_ids_.find(id); output != output_ids_.end()) {
      refuse(output->second);
    }
    if (const auto made = made_folders_.find(id); made != made_folders_.end()) {
      refuse_folder(made->second);
    }
  } else {
    const fs::path place = resolved(path);
    absent_inputs_.insert(place);
    if (const auto output = outputs_.find(place); output != outputs_.end()) {
      refuse(output->second);
    }
  }
  // Each folder is checked once: sequences have many files and few folders.
  for (const fs::path& folder : folders_of(path)) {
    if (!input_folders_.try_emplace(folder, path).second || !find_id(folder, id)) {
      continue;
    }
    if (const auto made = made_folders_.find(id); made != made_folders_.end()) {
      refuse_folder(made->second);
    }
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
  add_named_file(path, option);
  require_writable(path);
}

void FileChecks::add_made_file(const fs::path& path, const std::string& option) {
  require_local_folder(path);
  add_named_file(path, option);
  made_files_.push_back(path);
}

void FileChecks::require_nothing_made_unless(bool overwrite) const {
  if (overwrite) {
    return;
  }
  for (const fs::path& file : made_files_) {
    std::error_code ignored;
    if (fs::exists(file, ignored)) {
      refuse_to_replace(file);
    }
  }
  for (const auto& [id, folder] : made_folders_) {
    require_no_existing_file(folder.path, [](const std::string&) { return true; });
  }
}

void FileChecks::add_named_file(const fs::path& path, const std::string& option) {
  const fs::path place = resolved(path);
  FileId id;
  const bool is_there = find_id(path, id);
  if (is_there ? input_ids_.contains(id) : absent_inputs_.contains(place)) {
    throw UsageError(fmt::format("{} is '{}', which is also an input", option, path.string()));
  }
  const auto [other, is_new] = outputs_.try_emplace(place, Output{option, path});
  if (!is_new) {
    throw UsageError(fmt::format("{} and {} are the same file '{}'", other->second.option, option,
                                 path.string()));
  }
  if (is_there) {
    output_ids_.try_emplace(id, Output{option, path});
  }
  FileId folder;
  if (find_id(place.parent_path(), folder) && made_folders_.contains(folder)) {
    refuse_in_folder({option, path}, made_folders_.at(folder));
  }
}

void FileChecks::add_made_folder(const fs::path& path, const std::string& option) {
  require_local_folder(path);
  FileId id;
  if (!find_id(path, id)) {
    return;  // nothing can be in it
  }
  made_folders_.try_emplace(id, Output{option, path});
  for (const auto& [place, output] : outputs_) {
    FileId folder;
    if (find_id(place.parent_path(), folder) && folder == id) {
      refuse_in_folder(output, {option, path});
    }
  }
  const auto refuse = [&](const fs::path& input) {
    throw UsageError(fmt::format("{} would write into '{}', which contains the input '{}'", option,
                                 path.string(), input.string()));
  };
  if (const auto input = input_ids_.find(id); input != input_ids_.end()) {
    refuse(input->second);
  }
  for (const auto& [folder, input] : input_folders_) {
    FileId folder_id;
    if (find_id(folder, folder_id) && folder_id == id) {
      refuse(input);
    }
  }
}

fs::path resolved(const fs::path& path) {
  if (is_address(path)) {
    return path.lexically_normal();  // one slash less, as all of them
  }
  std::error_code ignored;
  const fs::path absolute = fs::absolute(through_links(path), ignored);
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
