#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::apps {

/// The arguments after the command's name.
using Arguments = std::vector<std::string>;

/// A subcommand. `run` returns the exit code for what is not an error (0, or 130 for a run that was
/// interrupted cleanly) and throws UsageError (exit 2) or anything else (exit 1).
struct Command {
  std::string_view name;  ///< one word, or two: "generate scene"
  std::string_view summary;
  int (*run)(const Arguments& arguments);
  std::string_view group;  ///< title above it in --help
};

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitSkipped = 3;
inline constexpr int kExitInterrupted = 130;

/// All subcommands, in the order of --help; those of a group stand together.
std::span<const Command> commands();

int command_check(const Arguments& arguments);
int command_match(const Arguments& arguments);
int command_synth(const Arguments& arguments);
int command_view(const Arguments& arguments);
int command_run(const Arguments& arguments);
int command_batch(const Arguments& arguments);
int command_reproject(const Arguments& arguments);
int command_rectify(const Arguments& arguments);
int command_eval(const Arguments& arguments);
int command_scene_poses(const Arguments& arguments);
int command_scene_build(const Arguments& arguments);
int command_scene_view(const Arguments& arguments);
int command_asp(const Arguments& arguments);
int command_scene_cloud(const Arguments& arguments);
int command_scene_info(const Arguments& arguments);
int command_generate_scene(const Arguments& arguments);
int command_merge(const Arguments& arguments);
int command_verify(const Arguments& arguments);
int command_submit(const Arguments& arguments);
int command_tune(const Arguments& arguments);
int command_profile(const Arguments& arguments);
int command_info(const Arguments& arguments);
int command_book_figure(const Arguments& arguments);
int command_book_pair(const Arguments& arguments);

}  // namespace vantage::apps
