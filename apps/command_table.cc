#include <array>

#include "apps/commands.h"

namespace vantage::apps {
namespace {

constexpr std::array kCommands = {
    Command{"match", "Disparity maps of a rectified pair", command_match},
    Command{"synth", "New views of a rectified pair", command_synth},
    Command{"view", "A page that renders new views of a pair in the browser", command_view},
    Command{"rectify", "Turns photographs of two cameras so that their rows correspond",
            command_rectify},
    Command{"run", "Disparity maps and new views of a sequence of pairs", command_run},
    Command{"merge", "Checks that a run made in parts is complete, joins its videos",
            command_merge},
    Command{"verify", "Reads the results of a run, tells which have been damaged", command_verify},
    Command{"submit", "Has a cluster make a sequence (Slurm)", command_submit},
    Command{"scene build", "Matches the neighbours among many images of a row or grid",
            command_scene_build},
    Command{"scene view", "New views among the images of such a scene", command_scene_view},
    Command{"scene info", "Images and edges of such a scene", command_scene_info},
    Command{"eval", "Errors of a disparity map or a view against the truth", command_eval},
    Command{"generate book", "The synthetic pairs of the book, with truth", command_generate_book},
    Command{"generate scene", "Views of a made-up moving scene, with truth",
            command_generate_scene},
    Command{"response", "Evidence of a pair for a range of displacements", command_response},
    Command{"experiment", "Figures of the book, computed anew", command_experiment},
    Command{"tune", "Finds the plan that is fastest on this machine", command_tune},
    Command{"profile", "Where the time of match or run goes, and what holds it back",
            command_profile},
    Command{"info", "Version, instruction sets, threads and caches", command_info}};

}  // namespace

std::span<const Command> commands() { return kCommands; }

}  // namespace vantage::apps
