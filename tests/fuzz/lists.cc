// Lists of pairs, of positions, and of poses.
#include "apps/settings/toml_file.h"
#include "engine/options/pose_file.h"
#include "engine/scene_graph/position_list.h"
#include "engine/sequence/pairs/pair_list.h"
#include "engine/view_geometry/trajectory_file.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

void read_pairs(Bytes bytes) {
  std::vector<std::string> remarks;
  (void)read_pair_list(file_of(bytes), &remarks);
}

void read_positions(Bytes bytes) { (void)parse_position_list(text_of(bytes), "input"); }

void read_path(Bytes bytes) {
  const Trajectory trajectory = parse_trajectory(text_of(bytes), "input");
  require(!trajectory.poses.empty(), "a pose");
  for (const CameraPose& pose : trajectory.poses) {
    require(pose.rotation.allFinite() && pose.translation.allFinite(), "a finite pose");
  }
}

/// Entries give the same text again: what a report says of views can be read back.
void read_views(Bytes bytes, const std::string& name) {
  const std::vector<PoseEntry> poses = read_poses(file_of(bytes, name), apps::read_toml_document);
  const SettingValue list = to_value(poses);
  require(to_value(poses_in(list, "input")) == list, "the same poses");
}

const Registration kPairs("pairs", read_pairs);
const Registration kPositions("positions", read_positions);
const Registration kTrajectory("trajectory", read_path);
const Registration kPoseJson("pose_json", [](Bytes bytes) { read_views(bytes, "input.json"); });
const Registration kPoseToml("pose_toml", [](Bytes bytes) { read_views(bytes, "input.toml"); });

}  // namespace
}  // namespace vantage::fuzz
