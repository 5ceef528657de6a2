#include <array>

#include "apps/commands/commands.h"

namespace vantage::apps {
namespace {

constexpr std::array kCommands = {
    Command{"match", "Disparity maps of a rectified pair", command_match},
    Command{"synth", "New views of a rectified pair", command_synth},
    Command{"view", "A web page that renders new views of a pair", command_view},
    Command{"reproject", "Depths, points or a surface in metres from a disparity map",
            command_reproject},
    Command{"rectify", "Rectifies photographs of two cameras", command_rectify},
    Command{"run", "Disparity maps and new views of a sequence or video", command_run},
    Command{"merge", "Checks that all parts of a run are complete, and joins its videos",
            command_merge},
    Command{"verify", "Finds damaged files in the results of a run", command_verify},
    Command{"submit", "Runs a sequence on a Slurm cluster", command_submit},
    Command{"scene poses", "Where the cameras of hand-held photographs stood", command_scene_poses},
    Command{"scene build",
            "Matches neighbouring images: a row or grid of cameras, or hand-held ones with poses",
            command_scene_build},
    Command{"scene view", "New views between the images of a scene", command_scene_view},
    Command{"scene cloud", "A point cloud of a scene with poses", command_scene_cloud},
    Command{"scene info", "Images and edges of a scene", command_scene_info},
    Command{"asp", "A disparity map for Ames Stereo Pipeline: float TIFF with gaps", command_asp},
    Command{"eval", "Error of a disparity map or a view, compared with the truth", command_eval},
    Command{"generate book", "Synthetic pairs of Scharstein's book, with true disparities",
            command_generate_book},
    Command{"generate scene", "Views of an artificial moving scene, with true disparities",
            command_generate_scene},
    Command{"response", "Gradient evidence of a pair for a range of displacements",
            command_response},
    Command{"experiment", "Figures and tables of Scharstein's book, computed again",
            command_experiment},
    Command{"tune", "Finds the fastest plan on this machine", command_tune},
    Command{"profile", "Shows where the time of match or run goes, and why", command_profile},
    Command{"info", "Versions, system, instruction sets, threads and caches", command_info}};

}  // namespace

std::span<const Command> commands() { return kCommands; }

}  // namespace vantage::apps
