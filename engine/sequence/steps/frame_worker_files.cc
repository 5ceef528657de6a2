// What a frame's files hold: the parts of FrameWorker that turn results into bytes.
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <variant>

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/reprojection/ply_file.h"
#include "engine/reprojection/point_cloud.h"
#include "engine/sequence/steps/frame_worker.h"

namespace vantage {

const Mask& FrameWorker::mask_of(const FrameSlot& slot, const OutputStream& stream) const {
  if (stream.output == SequenceOutput::kHoles) {
    return slot.views[static_cast<std::size_t>(stream.view)].holes;
  }
  if (stream.output == SequenceOutput::kSources) {
    return slot.views[static_cast<std::size_t>(stream.view)].sources;
  }
  if (stream.output == SequenceOutput::kCyclopeanOcclusion) {
    return slot.cyclopean.seen_by;
  }
  const bool left =
      options_.match.reference == Side::kLeft && stream.output == SequenceOutput::kUnmatched;
  return left ? slot.maps.left.unmatched : slot.maps.right.unmatched;
}

/// Null for masks and maps.
const Photograph* FrameWorker::stored_picture(const FrameSlot& slot,
                                              const OutputStream& stream) const {
  switch (stream.output) {
    case SequenceOutput::kPreview:
      return &slot.preview;
    case SequenceOutput::kViews:
      return &slot.views[static_cast<std::size_t>(stream.view)].image;
    case SequenceOutput::kStereo:
      return &slot.stereo;
    case SequenceOutput::kDepthVideo:
      return &slot.depth;
    default:
      return nullptr;
  }
}

std::string FrameWorker::extension_of(const FrameSlot& slot, const OutputStream& stream) const {
  switch (stream.output) {
    case SequenceOutput::kDisparity:
    case SequenceOutput::kRightDisparity:
    case SequenceOutput::kConfidence:
    case SequenceOutput::kPosteriorMean:
    case SequenceOutput::kPosteriorVariance:
    case SequenceOutput::kCyclopean:
    case SequenceOutput::kDepthResolution:
      return options_.map_format;
    case SequenceOutput::kDepth:
      return options_.depth_format;
    case SequenceOutput::kCloud:
    case SequenceOutput::kMesh:
      return "ply";
    default:
      break;
  }
  // Pictures keep their depth: PNG holds no floats.
  const Photograph* picture = stored_picture(slot, stream);
  return picture != nullptr && std::holds_alternative<Image<float>>(picture->pixels) ? "tiff"
                                                                                     : "png";
}

MapCamera FrameWorker::point_camera(const FrameSlot& slot) const {
  if (poses_ == nullptr) {
    return *map_camera_of(slot);
  }
  const CameraPose& pose = poses_->of(slot.pair);
  const RectifiedPair* const cameras =
      slot.cameras != nullptr ? &slot.cameras->rectifier.pair() : cameras_;
  return in_world(*map_camera_of(slot), pose.rotation.transpose(), pose.centre(),
                  cameras != nullptr ? cameras->left.rotation : Eigen::Matrix3d::Identity());
}

void FrameWorker::encode_metric(FrameSlot& slot, const OutputStream& stream,
                                const std::filesystem::path& path) const {
  const MatchedMap& map = slot.maps.of(options_.match.reference);
  if (stream.output == SequenceOutput::kDepth) {
    Image<float> depth_m;
    depth_map(map.disparity_px.view(), map_camera_of(slot)->scale,
              options_.cloud.max_depth.value_or(largest_depth_m(path)), execution_, depth_m);
    encode_depth(path, depth_m.view(), slot.encoded);
    return;
  }
  if (stream.output == SequenceOutput::kDepthResolution) {
    Image<float> resolution_m;
    depth_resolution_map(map.disparity_px.view(), map_camera_of(slot)->scale,
                         options_.used_disparity_step_px(), execution_, resolution_m);
    encode_disparity(path, resolution_m.view(), slot.encoded);
    return;
  }
  const CloudSource source{
      .disparity_px = map.disparity_px.view(),
      .colours = options_.match.reference == Side::kLeft ? slot.left : slot.right,
      .unmatched = map.unmatched.view(),
      .confidence = map.confidence.view(),
      .camera = point_camera(slot)};
  const std::string_view frame = poses_ != nullptr ? kWorldFrame : kCameraFrame;
  // A film may fade to black.
  CloudOptions options = options_.cloud;
  options.may_be_empty = true;
  bool is_empty = false;
  if (stream.output == SequenceOutput::kCloud) {
    const PointCloud cloud = point_cloud(source, options, execution_);
    is_empty = cloud.size() == 0;
    slot.encoded = encode_ply(cloud, frame);
  } else {
    const TriangleMesh mesh = triangle_mesh(source, options, execution_);
    is_empty = mesh.triangles.empty();
    slot.encoded = encode_ply(mesh, frame);
  }
  if (is_empty) {
    slot.pair.remarks.push_back(
        fmt::format("its {} is empty: no pixel has a disparity that was measured", stream.name));
  }
}

/// Writes to the slot's `encoded`.
void FrameWorker::encode_stream(FrameSlot& slot, const OutputStream& stream,
                                const std::filesystem::path& path) const {
  switch (stream.output) {
    case SequenceOutput::kDisparity:
      encode_disparity(path, primary_map(slot).view(), slot.encoded);
      return;
    case SequenceOutput::kRightDisparity:
      encode_disparity(path, slot.maps.right.disparity_px.view(), slot.encoded);
      return;
    case SequenceOutput::kConfidence:
      encode_disparity(path, slot.maps.of(options_.match.reference).confidence.view(),
                       slot.encoded);
      return;
    case SequenceOutput::kPosteriorMean:
      encode_disparity(path, slot.posterior.mean_px().view(), slot.encoded);
      return;
    case SequenceOutput::kPosteriorVariance:
      encode_disparity(path, slot.posterior.variance_px2().view(), slot.encoded);
      return;
    case SequenceOutput::kCyclopean:
      encode_disparity(path, slot.cyclopean.disparity_px.view(), slot.encoded);
      return;
    case SequenceOutput::kDepth:
    case SequenceOutput::kDepthResolution:
    case SequenceOutput::kCloud:
    case SequenceOutput::kMesh:
      encode_metric(slot, stream, path);
      return;
    default:
      break;
  }
  if (const Photograph* picture = stored_picture(slot, stream)) {
    encode_photograph(path, *picture, slot.encoded);
    return;
  }
  encode_photograph(path, Photograph{mask_of(slot, stream).copy()}, slot.encoded);
}

}  // namespace vantage
