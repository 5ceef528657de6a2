#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>

#include "engine/io/files/checksum.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/reprojection/ply_file.h"
#include "engine/reprojection/point_cloud.h"
#include "engine/sequence/steps/frame_pictures.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool needs_files(const FrameTools& tools, const FrameSlot& slot) {
  return tools.writes_files && slot.stored == nullptr;
}

std::string extension_of(const FrameTools& tools, const FrameSlot& slot,
                         const OutputStream& stream) {
  if (stream.output == SequenceOutput::kDepth) {
    return tools.options.depth_format;
  }
  if (stream.output == SequenceOutput::kCloud || stream.output == SequenceOutput::kMesh) {
    return "ply";
  }
  if (!is_picture(stream.output)) {
    return tools.options.map_format;
  }
  // Pictures keep their depth: PNG holds no floats.
  const Photograph* picture = stored_picture(slot, stream);
  return picture != nullptr && std::holds_alternative<Image<float>>(picture->pixels) ? "tiff"
                                                                                     : "png";
}

void encode_points(const FrameTools& tools, FrameSlot& slot, const OutputStream& stream) {
  const MatchedMap& map = slot.maps.of(tools.options.match.reference);
  const CloudSource source{
      .disparity_px = map.disparity_px.view(),
      .colours = tools.options.match.reference == Side::kLeft ? slot.left : slot.right,
      .unmatched = map.unmatched.view(),
      .confidence = map.confidence.view(),
      .camera = tools.cameras.point_camera(slot)};
  const std::string_view frame = tools.cameras.poses != nullptr ? kWorldFrame : kCameraFrame;
  // A film may fade to black.
  CloudOptions options = tools.options.cloud;
  options.may_be_empty = true;
  bool is_empty = false;
  if (stream.output == SequenceOutput::kCloud) {
    const PointCloud cloud = point_cloud(source, options, tools.execution);
    is_empty = cloud.size() == 0;
    slot.encoded = encode_ply(cloud, frame);
  } else {
    const TriangleMesh mesh = triangle_mesh(source, options, tools.execution);
    is_empty = mesh.triangles.empty();
    slot.encoded = encode_ply(mesh, frame);
  }
  if (is_empty) {
    slot.pair.remarks.push_back(
        fmt::format("its {} is empty: no pixel has a disparity that was measured", stream.name));
  }
}

/// Writes to the slot's `encoded`, as encode_points().
void encode(const FrameTools& tools, FrameSlot& slot, const OutputStream& stream,
            const std::filesystem::path& path) {
  const MatchedMap& map = slot.maps.of(tools.options.match.reference);
  const auto encode_map = [&](const Image<float>& values) {
    encode_disparity(path, values.view(), slot.encoded, &tools.execution);
  };
  switch (stream.output) {
    case SequenceOutput::kDisparity:
      encode_map(map.disparity_px);
      break;
    case SequenceOutput::kRightDisparity:
      encode_map(slot.maps.right.disparity_px);
      break;
    case SequenceOutput::kConfidence:
      encode_map(map.confidence);
      break;
    case SequenceOutput::kPosteriorMean:
      encode_map(slot.posterior.mean_px());
      break;
    case SequenceOutput::kPosteriorVariance:
      encode_map(slot.posterior.variance_px2());
      break;
    case SequenceOutput::kCyclopean:
      encode_map(slot.cyclopean.disparity_px);
      break;
    case SequenceOutput::kDepth: {
      Image<float> depth_m;
      depth_map(map.disparity_px.view(), tools.cameras.map_camera_of(slot)->scale,
                tools.options.cloud.max_depth.value_or(largest_depth_m(path)), tools.execution,
                depth_m);
      encode_depth(path, depth_m.view(), slot.encoded, &tools.execution);
      break;
    }
    case SequenceOutput::kDepthResolution: {
      Image<float> resolution_m;
      depth_resolution_map(map.disparity_px.view(), tools.cameras.map_camera_of(slot)->scale,
                           tools.options.used_disparity_step_px(), tools.execution, resolution_m);
      encode_map(resolution_m);
      break;
    }
    case SequenceOutput::kCloud:
    case SequenceOutput::kMesh:
      encode_points(tools, slot, stream);
      break;
    default:
      if (const Photograph* picture = stored_picture(slot, stream)) {
        encode_photograph(path, *picture, slot.encoded, &tools.execution);
      } else {
        encode_photograph(path,
                          Photograph{mask_of(slot, stream, tools.options.match.reference).copy()},
                          slot.encoded, &tools.execution);
      }
  }
}

/// Makes the files of a frame and writes them without their final names.
void encode_files(const FrameTools& tools, FrameSlot& slot) {
  for (const OutputStream& stream : tools.layout.streams()) {
    if (stream.as_video) {
      continue;
    }
    const std::filesystem::path name = SequenceLayout::file(
        stream, slot.frame, slot.pair.details.name, extension_of(tools, slot, stream));
    const std::filesystem::path path = tools.layout.folder() / name;
    encode(tools, slot, stream, path);
    slot.files.add(path, slot.encoded);
    slot.file_records.push_back({name.string(), {slot.encoded.size(), crc32_of(slot.encoded)}});
  }
}

StepBytes encode_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t pixels = shape.pixels();
  // A map being written: with unknown pixels replaced, and encoded.
  std::size_t bytes = 2 * pixels * sizeof(float) + shape.photograph_bytes();
  if (options.is_metric()) {
    // Points, colours and outlines of all pixels; those that are kept, in vectors that grow, and as
    // a file; triangles of a mesh.
    const auto step = static_cast<std::size_t>(options.cloud.step_px);
    const std::size_t of_point = options.saves(SequenceOutput::kMesh) ? 156 : 57;
    bytes += pixels * 16 + (options.saves_points() ? pixels / (step * step) * of_point : 0);
  }
  return {.of_frame = bytes};
}

}  // namespace

StepEntry encode_step() {
  return {.name = "encode",
          .account = "encode",
          .kind = WorkKind::kWriting,
          .make = make_step<needs_files, encode_files>,
          .planned_bytes = encode_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.encoded); }};
}

}  // namespace vantage
