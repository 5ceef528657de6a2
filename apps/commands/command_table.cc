#include <array>

#include "apps/commands/commands.h"

namespace vantage::apps {
namespace {

constexpr std::string_view kPairs = "Stereo pairs";
constexpr std::string_view kSequences = "Sequences and films";
constexpr std::string_view kScenes = "Scenes of many photographs";
constexpr std::string_view kTools = "Quality, speed and other programs";
constexpr std::string_view kBook = "Scharstein's book";

constexpr std::array kCommands = {
    Command{"check", "What a pair or film is like, and the command to type", command_check, kPairs},
    Command{"match", "Disparity maps of a rectified pair", command_match, kPairs},
    Command{"synth", "New views of a rectified pair", command_synth, kPairs},
    Command{"view", "A web page that renders new views of a pair", command_view, kPairs},
    Command{"reproject", "Depths, points or a surface in metres from a disparity map",
            command_reproject, kPairs},
    Command{"rectify", "Rectifies photographs of two cameras", command_rectify, kPairs},
    Command{"run", "Disparity maps and new views of a sequence or video", command_run, kSequences},
    Command{"batch", "Many films and pairs of a list, by any number of workers", command_batch,
            kSequences},
    Command{"merge", "Checks that all parts of a run are complete, and joins its videos",
            command_merge, kSequences},
    Command{"verify", "Finds damaged files in the results of a run", command_verify, kSequences},
    Command{"submit", "Runs a batch, or one sequence, as tasks of a cluster", command_submit,
            kSequences},
    Command{"scene poses", "Where the cameras of hand-held photographs stood", command_scene_poses,
            kScenes},
    Command{"scene build",
            "Matches neighbouring images: a row or grid of cameras, or hand-held ones with poses",
            command_scene_build, kScenes},
    Command{"scene view", "New views between the images of a scene", command_scene_view, kScenes},
    Command{"scene cloud", "A point cloud of a scene with poses", command_scene_cloud, kScenes},
    Command{"scene info", "Images and edges of a scene", command_scene_info, kScenes},
    Command{"eval", "Error of a disparity map or a view, compared with the truth", command_eval,
            kTools},
    Command{"generate scene", "Views of an artificial moving scene, with true disparities",
            command_generate_scene, kTools},
    Command{"tune", "Finds the fastest plan on this machine", command_tune, kTools},
    Command{"profile", "Shows where the time of match or run goes, and why", command_profile,
            kTools},
    Command{"info", "Versions, system, instruction sets, threads and caches", command_info, kTools},
    Command{"asp", "A disparity map for Ames Stereo Pipeline: float TIFF with gaps", command_asp,
            kTools},
    Command{"book figure", "Figures and tables of the book, computed again", command_book_figure,
            kBook},
    Command{"book pair", "Synthetic pairs of the book, with true disparities", command_book_pair,
            kBook}};

}  // namespace

std::span<const Command> commands() { return kCommands; }

}  // namespace vantage::apps
