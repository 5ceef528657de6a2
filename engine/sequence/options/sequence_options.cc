#include "engine/sequence/options/sequence_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "engine/combinations/combinations.h"
#include "engine/error.h"
#include "engine/io/maps/map_formats.h"
#include "engine/io/maps/map_io.h"
#include "engine/matching/options/match_values.h"
#include "engine/matching/search/match_inputs.h"
#include "engine/quoted_text.h"
#include "engine/sequence/options/sequence_values.h"

namespace vantage {
namespace {

constexpr int kMaxChunkFrames = 100000;
constexpr int kMaxCrf = 51;

bool contains(const std::vector<SequenceOutput>& outputs, SequenceOutput output) {
  return std::ranges::find(outputs, output) != outputs.end();
}

std::string_view name_of(SequenceOutput output) {
  return std::ranges::find(sequence_output_names(), output,
                           &std::pair<std::string_view, SequenceOutput>::second)
      ->first;
}

/// "save views" of each output.
const std::map<SequenceOutput, std::string>& save_names() {
  static const std::map<SequenceOutput, std::string> names = [] {
    std::map<SequenceOutput, std::string> of_outputs;
    for (const auto& [name, output] : sequence_output_names()) {
      of_outputs[output] = fmt::format("save {}", name);
    }
    return of_outputs;
  }();
  return names;
}

/// For a fixed view, the frame of its only key does not matter.
bool is_same(const ViewPath& view, const ViewPath& other) {
  return view == other || (!view.moves() && !other.moves() && view.at(0) == other.at(0));
}

std::string text_of(const ViewPath& view) {
  if (const auto* camera = std::get_if<PosedCamera>(&view.keys.front().pose)) {
    return fmt::format("by a {} with fx = {} px", view.moves() ? "moving camera" : "camera",
                       camera->matrix(0, 0));
  }
  return view.moves() ? to_string(view) : to_string(std::get<BaselinePosition>(view.at(0)));
}

void require_near(const ViewPose& pose) {
  const auto* position = std::get_if<BaselinePosition>(&pose);
  if (position == nullptr) {
    return;  // the distance of a camera in baselines is not known here
  }
  for (const double coordinate : {position->x, position->y}) {
    if (!(std::abs(coordinate) <= kMaxViewDistance)) {
      throw UsageError(fmt::format("view is {}, expected numbers within ±{}", to_string(*position),
                                   kMaxViewDistance));
    }
  }
}

void check_baselines(const SequenceOptions& options) {
  if (options.baselines.empty()) {
    return;
  }
  std::vector<OtherView> others;
  for (const double baseline : options.baselines) {
    others.push_back({nullptr, baseline});
  }
  require_different_baselines(others);
  if (options.baselines.front() < 0) {
    throw UsageError(
        fmt::format("the baseline of the right camera is {}, expected a positive number",
                    options.baselines.front()));
  }
}

void check_views(const SequenceOptions& options) {
  const bool wanted = std::ranges::any_of(options.save, is_per_view);
  if (wanted && options.views.empty()) {
    throw UsageError(
        "save has views but no view is given, expected `view` XS, `view-path` KEYS, `pose` FILE or "
        "`path` FILE");
  }
  if (!wanted && !options.views.empty()) {
    throw UsageError("view is given but save has no views, expected both");
  }
  for (auto view = options.views.begin(); view != options.views.end(); ++view) {
    view->validate();
    for (const ViewPath::Key& key : view->keys) {
      require_near(key.pose);
    }
    if (std::find_if(options.views.begin(), view,
                     [&](const ViewPath& other) { return is_same(other, *view); }) != view) {
      throw UsageError(fmt::format("view {} is given twice", text_of(*view)));
    }
  }
  for (const double view_x : options.stereo_views_x) {
    if (!(std::abs(view_x) <= kMaxViewDistance)) {
      throw UsageError(fmt::format("stereo-views has {}, expected two numbers within ±{}", view_x,
                                   kMaxViewDistance));
    }
  }
}

void check_formats(const SequenceOptions& options) {
  const std::string map_name = "map." + options.map_format;
  if (find_map_format(map_name, MapContent::kDisparity) == nullptr) {
    throw UsageError(fmt::format("format is '{}', expected {}", quotable(options.map_format),
                                 listed_map_formats(MapContent::kDisparity, "")));
  }
  const bool saves_maps =
      options.saves(SequenceOutput::kDisparity) || options.saves(SequenceOutput::kRightDisparity) ||
      options.saves(SequenceOutput::kPosteriorMean) || options.saves(SequenceOutput::kCyclopean);
  if (saves_maps && !options.match.disparities_auto) {
    require_holds_search(map_name, options.match.disparities.min, options.match.disparities.max);
  }
  for (const SequenceOutput output :
       {SequenceOutput::kConfidence, SequenceOutput::kPosteriorVariance,
        SequenceOutput::kDepthResolution}) {
    if (options.saves(output) && find_map_format(map_name, MapContent::kConfidence) == nullptr) {
      throw UsageError(fmt::format(
          "format is {}, which holds no floats, but save has {}; expected {}", options.map_format,
          name_of(output), listed_map_formats(MapContent::kConfidence, "")));
    }
  }
  const std::string depth_name = "depth." + options.depth_format;
  if (find_map_format(depth_name, MapContent::kDepth) == nullptr) {
    throw UsageError(fmt::format("depth-format is '{}', expected {}",
                                 quotable(options.depth_format),
                                 listed_map_formats(MapContent::kDepth, "")));
  }
  options.cloud.validate();
  if (options.saves(SequenceOutput::kDepth) && options.cloud.max_depth &&
      *options.cloud.max_depth > largest_depth_m(depth_name)) {
    throw UsageError(fmt::format("max-depth is {}, expected at most {} with depth-format {}",
                                 *options.cloud.max_depth, largest_depth_m(depth_name),
                                 options.depth_format));
  }
  for (const SequenceOutput output : options.video) {
    if (!is_picture(output)) {
      throw UsageError(fmt::format(
          "video has {}, whose values a video cannot hold; expected unmatched, right-unmatched, "
          "preview, views, holes, sources, stereo, cyclopean-occlusion or depth-video",
          name_of(output)));
    }
    if (!options.saves(output)) {
      throw UsageError(
          fmt::format("video has {0} but save does not, expected `save` …,{0}", name_of(output)));
    }
  }
  if (options.crf < 0 || options.crf > kMaxCrf) {
    throw UsageError(
        fmt::format("crf is {}, expected a number from 0 to {}", options.crf, kMaxCrf));
  }
  if (options.chunk_frames < 1 || options.chunk_frames > kMaxChunkFrames) {
    throw UsageError(fmt::format("chunk-frames is {}, expected a number from 1 to {}",
                                 options.chunk_frames, kMaxChunkFrames));
  }
}

void check_films(const SequenceOptions& options) {
  if (!is_grey(options.depth_coding)) {
    throw UsageError(
        "depth-codec is h264, expected ffvhuff-16, ffv1-16, ffv1-10, hevc-10 or prores-10");
  }
  const PreviewRange given = options.depth_scale.given;
  if (!(std::isfinite(given.min_px) && std::isfinite(given.max_px) &&
        given.min_px < given.max_px)) {
    throw UsageError(fmt::format("depth-range is {}:{}, expected MIN:MAX with MIN < MAX",
                                 given.min_px, given.max_px));
  }
}

}  // namespace

const std::vector<std::pair<std::string_view, SequenceOutput>>& sequence_output_names() {
  static const std::vector<std::pair<std::string_view, SequenceOutput>> names = {
      {"disparity", SequenceOutput::kDisparity},
      {"right-disparity", SequenceOutput::kRightDisparity},
      {"confidence", SequenceOutput::kConfidence},
      {"unmatched", SequenceOutput::kUnmatched},
      {"right-unmatched", SequenceOutput::kRightUnmatched},
      {"preview", SequenceOutput::kPreview},
      {"views", SequenceOutput::kViews},
      {"holes", SequenceOutput::kHoles},
      {"sources", SequenceOutput::kSources},
      {"stereo", SequenceOutput::kStereo},
      {"posterior-mean", SequenceOutput::kPosteriorMean},
      {"posterior-variance", SequenceOutput::kPosteriorVariance},
      {"cyclopean", SequenceOutput::kCyclopean},
      {"cyclopean-occlusion", SequenceOutput::kCyclopeanOcclusion},
      {"depth", SequenceOutput::kDepth},
      {"depth-resolution", SequenceOutput::kDepthResolution},
      {"cloud", SequenceOutput::kCloud},
      {"mesh", SequenceOutput::kMesh},
      {"depth-video", SequenceOutput::kDepthVideo},
      {"comfort", SequenceOutput::kComfort}};
  return names;
}

bool is_picture(SequenceOutput output) {
  switch (output) {
    case SequenceOutput::kUnmatched:
    case SequenceOutput::kRightUnmatched:
    case SequenceOutput::kPreview:
    case SequenceOutput::kViews:
    case SequenceOutput::kHoles:
    case SequenceOutput::kSources:
    case SequenceOutput::kStereo:
    case SequenceOutput::kCyclopeanOcclusion:
    case SequenceOutput::kDepthVideo:
      return true;
    default:
      return false;
  }
}

bool SequenceOptions::saves(SequenceOutput output) const { return contains(save, output); }
bool SequenceOptions::saves_as_video(SequenceOutput output) const {
  return contains(video, output) || (is_always_video(output) && saves(output));
}

void SequenceOptions::validate() const {
  match.validate();
  synthesis.validate();
  temporal.validate();
  check_baselines(*this);
  const OptionValues values = values_of(*this);
  refuse_combinations(CombinationScope::kSequence, values);
  refuse_combinations(CombinationScope::kReuse, values);
  if (match.disparities_y) {
    throw UsageError("disparities-y is set, expected none: sequences consist of rectified pairs");
  }
  if (save.empty()) {
    throw UsageError("save is empty, expected at least one output");
  }
  check_films(*this);
  check_views(*this);
  check_formats(*this);
}

OptionValues values_of(const SequenceOptions& options) {
  OptionValues values = values_of(options.match);
  if (!options.baselines.empty()) {
    values.set("baselines", "given");
    values.set("search-size", "full", false);  // several images have no other
  }
  if (options.unrectified != UnrectifiedSearch::kNone) {
    values.set("unrectified", options.unrectified == UnrectifiedSearch::kOnPhotographs
                                  ? "photographs"
                                  : "rectified images");
  }
  values.set("temporal-prior", options.temporal.weight);
  values.set("reuse", options.temporal.reuse == Reuse::kNone ? "none" : "frame");
  values.set("search-range", options.search_scope == SearchScope::kShot   ? "shot"
                             : options.search_scope == SearchScope::kPair ? "pair"
                                                                          : "film");
  if (!options.views.empty()) {
    values.set("view", "given");
  }
  for (const SequenceOutput output : options.save) {
    values.set(save_names().at(output), "given");
  }
  if (options.saves(SequenceOutput::kDepthVideo) &&
      options.depth_scale.scope != DepthVideoScale::Scope::kGiven) {
    values.set("save depth-video", "of the search");
  }
  return values;
}

}  // namespace vantage
