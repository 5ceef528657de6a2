#include "engine/reprojection/ply_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <iterator>
#include <optional>
#include <span>
#include <string>

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename T>
void append(const T* values, std::size_t count, std::uint8_t*& end) {
  std::memcpy(end, values, count * sizeof(T));
  end += count * sizeof(T);
}

std::string header(const PointCloud& cloud, std::optional<std::size_t> triangles,
                   std::string_view frame) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n{}"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n",
      frame, cloud.size(),
      cloud.normals.empty() ? "" : "property float nx\nproperty float ny\nproperty float nz\n");
  if (!cloud.confidence.empty()) {
    text += "property float confidence\n";
  }
  if (triangles) {
    text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", *triangles);
  }
  return text + "end_header\n";
}

std::vector<std::uint8_t> encode(const PointCloud& cloud, std::span<const std::int32_t> corners,
                                 bool has_faces, std::string_view frame) {
  constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::int32_t);
  const std::size_t triangles = corners.size() / 3;
  const std::string text =
      header(cloud, has_faces ? std::optional(triangles) : std::nullopt, frame);
  const std::size_t vertex_bytes = (cloud.normals.empty() ? 3 : 6) * sizeof(float) + 3 +
                                   (cloud.confidence.empty() ? 0 : sizeof(float));
  std::vector<std::uint8_t> bytes(text.size() + cloud.size() * vertex_bytes +
                                  triangles * kFaceBytes);
  std::uint8_t* end = bytes.data();
  append(text.data(), text.size(), end);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    append(&cloud.positions[3 * i], 3, end);
    if (!cloud.normals.empty()) {
      append(&cloud.normals[3 * i], 3, end);
    }
    append(&cloud.colours[3 * i], 3, end);
    if (!cloud.confidence.empty()) {
      append(&cloud.confidence[i], 1, end);
    }
  }
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    *end++ = 3;
    append(&corners[i], 3, end);
  }
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> encode_ply(const PointCloud& cloud, std::string_view frame) {
  return encode(cloud, {}, false, frame);
}

std::vector<std::uint8_t> encode_ply(const TriangleMesh& mesh, std::string_view frame) {
  return encode(mesh.vertices, mesh.triangles, true, frame);
}

}  // namespace vantage
