#include "engine/scene_graph/scene_folder.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <set>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/files/temporary_name.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHashDigits = 16;

std::string path_from(const fs::path& folder, const fs::path& file) {
  if (is_address(file)) {
    return file.string();
  }
  const fs::path parent = fs::weakly_canonical(fs::absolute(file).parent_path());
  return (parent / file.filename())
      .lexically_relative(fs::weakly_canonical(fs::absolute(folder)))
      .generic_string();
}

void make_folder(const fs::path& folder) {
  require_local_folder(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(fmt::format("{}: the folder cannot be made, {}", folder.string(), error.message()));
  }
}

/// "maps/003-004-first": file names of an edge's maps without extension.
std::string map_name(const SceneEdge& edge, std::size_t side) {
  return fmt::format("maps/{:03}-{:03}-{}", edge.first, edge.second,
                     side == 0 ? "first" : "second");
}

constexpr const char* kMapEnd = ".pfm";
constexpr const char* kMaskEnd = "-unmatched.png";

bool is_there(const fs::path& folder, const StoredFile& file) {
  std::error_code error;
  const auto bytes = fs::file_size(folder / file.name, error);
  return !error && bytes == file.bytes;
}

}  // namespace

fs::path scene_lock_file(const fs::path& folder) {
  make_folder(folder / "maps");
  fs::path file = folder / ".lock";
  if (!FileDescriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)).valid()) {
    fail_to_write(file, errno);
  }
  return file;
}

std::string stored_image_file(const fs::path& folder, const fs::path& image,
                              const std::string& content, bool copy) {
  std::string name = path_from(folder, image);
  const bool is_inside = !is_address(image) && fs::path(name).begin()->string() != "..";
  if (!copy || is_inside) {
    return name;
  }
  make_folder(folder / "images");
  // The end of the content's description is its hash.
  name = fmt::format("images/{}-{}{}", image.stem().string(),
                     content.substr(content.size() - kHashDigits), image.extension().string());
  remove_temporary_files_of(folder / name);
  std::error_code ignored;
  if (!fs::exists(folder / name, ignored) || content_of_file(folder / name) != content) {
    write_binary_file(folder / name, read_file_bytes(image));
  }
  return name;
}

void store_maps(const fs::path& folder, const DisparityMaps& maps, StoredEdge& edge) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const std::string name = map_name(edge.edge, index_of(side));
    const auto stored = [&](const std::string& file) {
      return StoredFile{.name = file, .bytes = fs::file_size(folder / file)};
    };
    write_disparity(folder / (name + kMapEnd), maps.of(side).disparity_px.view());
    edge.maps[index_of(side)] = stored(name + kMapEnd);
    write_mask(folder / (name + kMaskEnd), maps.of(side).unmatched.view());
    edge.unmatched[index_of(side)] = stored(name + kMaskEnd);
  }
}

bool has_maps(const fs::path& folder, const StoredEdge& edge) {
  return is_there(folder, edge.maps[0]) && is_there(folder, edge.maps[1]) &&
         is_there(folder, edge.unmatched[0]) && is_there(folder, edge.unmatched[1]);
}

void remove_leftovers(const fs::path& folder, std::span<const SceneEdge> edges) {
  remove_temporary_files_of(folder / "scene.json");
  remove_temporary_files_of(scene_lock_file(folder));
  std::set<std::string> maps;
  for (const SceneEdge& edge : edges) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (const char* end : {kMapEnd, kMaskEnd}) {
        maps.insert(fs::path(map_name(edge, side) + end).filename().string());
      }
    }
  }
  remove_temporary_files(folder / "maps",
                         [&](const std::string& name) { return maps.contains(name); });
}

void remove_outdated_maps(const fs::path& folder, const StoredScene& before,
                          const StoredScene& scene) {
  std::set<std::string> kept;
  const auto for_each_file = [](const StoredEdge& edge, const auto& body) {
    for (std::size_t side = 0; side < 2; ++side) {
      body(edge.maps[side].name);
      body(edge.unmatched[side].name);
    }
  };
  for (const StoredEdge& edge : scene.edges) {
    for_each_file(edge, [&](const std::string& name) { kept.insert(name); });
  }
  for (const StoredEdge& edge : before.edges) {
    for_each_file(edge, [&](const std::string& name) {
      const fs::path path(name);
      if (!kept.contains(name) && path.parent_path() == "maps") {
        std::error_code ignored;
        fs::remove(folder / path, ignored);
      }
    });
  }
}

}  // namespace vantage
