#include "engine/sequence/steps/frame_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/image/content_hash.h"
#include "engine/image/stereo_display.h"
#include "engine/io/files/checksum.h"
#include "engine/io/images/preview.h"
#include "engine/matching/search/epipolar/rectified_map.h"
#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/shots/preview_range.h"
#include "engine/sequence/steps/stored_maps.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

/// A look takes up to a tenth of the time of a match; whether frames are cut off is known after a
/// few.
constexpr int kMaxLooksBeyond = 4;

using Clock = std::chrono::steady_clock;

/// Adds the time until its destruction to the times of a slot and to traces, its processor time to
/// an account.
class TimedStep {
 public:
  TimedStep(FrameSlot& slot, std::string_view name, scheduler::ProcessorAccount* account)
      : slot_(slot), name_(name), span_(name), charge_(account) {}
  TimedStep(const TimedStep&) = delete;
  TimedStep& operator=(const TimedStep&) = delete;
  ~TimedStep() {
    slot_.times.push_back({name_, std::chrono::duration<double>(Clock::now() - start_).count()});
  }

 private:
  FrameSlot& slot_;
  std::string_view name_;
  Clock::time_point start_ = Clock::now();
  scheduler::Span span_;
  scheduler::ProcessorCharge charge_;
};

void require_size(const Photograph& photograph, std::string_view side, ImageExtent expected) {
  if (photograph.width() != expected.width_px || photograph.height() != expected.height_px) {
    throw Error(fmt::format("the {} image is {}x{}, expected {}x{} as at the start of the sequence",
                            side, photograph.width(), photograph.height(), expected.width_px,
                            expected.height_px));
  }
}

template <typename T>
void copy_image(const Image<T>& image, Photograph& copy) {
  Image<T> pixels = take_image<T>(copy, {image.width(), image.height(), image.channels()});
  const auto row_values =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels());
  for (int y = 0; y < image.height(); ++y) {
    std::copy_n(image.row(y), row_values, pixels.row(y));
  }
  copy.pixels = std::move(pixels);
}

}  // namespace

ImageExtent extent_of(const ViewPath& view, ImageExtent images) {
  const auto* camera = std::get_if<PosedCamera>(&view.keys.front().pose);
  return camera != nullptr && camera->width_px > 0
             ? ImageExtent{camera->width_px, camera->height_px}
             : images;
}

bool views_show_photographs(const SequenceOptions& options) {
  return options.synthesis.warp == WarpColour::kOnePass &&
         (!options.views.empty() || options.saves(SequenceOutput::kStereo));
}

FrameWorker::FrameWorker(const FrameTools& tools)
    : options_(tools.options),
      layout_(tools.layout),
      pairs_(tools.pairs),
      frame_size_(tools.frame_size),
      rectifier_(tools.rectifier),
      pair_cameras_(tools.pair_cameras),
      cameras_(tools.cameras),
      map_camera_(tools.map_camera),
      poses_(tools.poses),
      shots_(tools.shots),
      execution_(tools.execution),
      accounts_(tools.accounts),
      matchers_(tools.options.match, tools.shots,
                tools.options.unrectified != UnrectifiedSearch::kNone ? tools.rectifier : nullptr,
                tools.execution),
      renderer_(tools.options.synthesis, tools.cameras, tools.execution),
      videos_show_views_(videos_show_views(tools.options)),
      maps_are_stored_(maps_are_stored(tools.options)),
      temporal_(tools.options.temporal),
      reuse_(tools.options.temporal.threshold, tools.execution) {
  if (rectifier_ != nullptr && rectifier_->needs_rectification() &&
      views_show_photographs(options_)) {
    photograph_grid_.emplace(*rectifier_, execution_);
  }
}

void FrameWorker::prepare(FrameSlot& slot) const {
  if (slot.is_absent) {
    return;
  }
  {
    const TimedStep step(slot, "decode", accounts_.of(RunStep::kDecode));
    pairs_.decode(slot.pair);
    slot.content = {content_hash(slot.pair.left), content_hash(slot.pair.right)};
    if (pairs_.is_stream() && options_.needs_shots()) {
      slot.thumbnail = make_thumbnail(slot.pair.left);
    }
  }
  if (frame_size_) {
    require_size(slot.pair.left, "left", *frame_size_);
    require_size(slot.pair.right, "right", *frame_size_);
    for (std::size_t k = 0; k < slot.pair.more.size(); ++k) {
      require_size(slot.pair.more[k], fmt::format("camera {}'s", k + 3), *frame_size_);
    }
  }
  slot.left = &slot.pair.left;
  slot.right = &slot.pair.right;
  slot.cameras.reset();
  if (!slot.pair.details.calibration.empty()) {
    require_size(slot.pair.right, "right", {slot.pair.left.width(), slot.pair.left.height()});
    slot.cameras =
        pair_cameras_->of(slot.pair.details, {slot.pair.left.width(), slot.pair.left.height()});
  }
  const Rectifier* const rectifier = rectifier_of(slot);
  if (rectifier != nullptr && options_.unrectified != UnrectifiedSearch::kOnPhotographs) {
    const BusyClock::Activity activity(compute_clock_);
    const TimedStep step(slot, "rectify", accounts_.of(RunStep::kRectify));
    rectifier->apply(slot.pair.left, Side::kLeft, slot.rectified[0], execution_);
    rectifier->apply(slot.pair.right, Side::kRight, slot.rectified[1], execution_);
    slot.left = &slot.rectified[0];
    slot.right = &slot.rectified[1];
  }
}

const Rectifier* FrameWorker::rectifier_of(const FrameSlot& slot) const {
  if (slot.cameras == nullptr) {
    return rectifier_;
  }
  return slot.cameras->rectifier.needs_rectification() ? &slot.cameras->rectifier : nullptr;
}

void FrameWorker::compute(FrameSlot& slot) {
  if (slot.is_absent) {
    return;
  }
  const BusyClock::Activity activity(compute_clock_);
  if (slot.stored != nullptr && maps_are_stored_) {
    read_maps(slot);
  }
  slot.deferred = {};
  slot.shot.reset();
  if (slot.stored == nullptr || !maps_are_stored_) {
    const scheduler::ProcessorCharge charge(accounts_.of(RunStep::kMatch));
    slot.shot = matchers_.of(slot.frame, slot.pair.details.disparities);
    match(slot, *slot.shot);
  }
}

void FrameWorker::finish(FrameSlot& slot) {
  const std::shared_ptr<const ShotMatcher> shot = std::move(slot.shot);
  DeferredMatch deferred = std::exchange(slot.deferred, {});
  if (slot.is_absent || (slot.is_lead_in && !options_.measure_flicker)) {
    return;
  }
  const BusyClock::Activity activity(compute_clock_);
  if (shot != nullptr) {
    const scheduler::ProcessorCharge charge(accounts_.of(RunStep::kMatch));
    if (deferred.is_pending) {
      MatchRequest request = this->request();
      request.deferred = &deferred;
      shot->matcher.match(*slot.left, *slot.right, request, slot.maps, &slot.match);
    }
    check_range(slot, shot->options);
    if (options_.saves_cyclopean()) {
      const TimedStep step(slot, "cyclopean map", accounts_.of(RunStep::kMatch));
      make_cyclopean_map(slot.maps.left, execution_, slot.cyclopean);
    }
  }
  synthesize(slot);
  if (slot.is_lead_in) {
    return;
  }
  paint_preview(slot);
  paint_depth_picture(slot);
  pack_stereo_picture(slot);
  measure_comfort_of(slot);
  measure_disparities_of(slot);
}

void FrameWorker::read_maps(FrameSlot& slot) const {
  const TimedStep step(slot, "read maps", accounts_.of(RunStep::kRead));
  slot.match = {};
  if (!read_stored_maps(layout_, *slot.stored, options_.match.reference, needs_views(slot),
                        slot.maps)) {
    slot.stored = nullptr;
  }
}

bool FrameWorker::wants(const FrameSlot& slot, SequenceOutput output) const {
  return slot.stored == nullptr ? options_.saves(output) : options_.saves_as_video(output);
}

bool FrameWorker::needs_views(const FrameSlot& slot) const {
  return slot.stored == nullptr || videos_show_views_ || options_.measure_flicker;
}

MatchRequest FrameWorker::request() const {
  const bool right_is_primary = options_.match.reference == Side::kRight;
  const bool both = !options_.views.empty() || options_.saves(SequenceOutput::kStereo) ||
                    options_.saves(SequenceOutput::kRightDisparity) ||
                    options_.saves(SequenceOutput::kRightUnmatched) ||
                    options_.temporal.weight > 0;  // both are stored for the next frame
  return {.left = !right_is_primary || both || options_.saves_cyclopean(),
          .right = right_is_primary || both,
          .confidence = options_.saves(SequenceOutput::kConfidence) ||
                        (options_.saves_points() && options_.cloud.reads_confidence())};
}

void FrameWorker::match(FrameSlot& slot, const ShotMatcher& shot) {
  const StereoMatcher& matcher = shot.matcher;
  MatchRequest request = this->request();
  const VolumeRequest posterior{.side = options_.match.reference, .sink = &slot.posterior};
  if (options_.saves_posterior()) {
    request.volumes = {&posterior, 1};
  }
  if (shot.unrectified) {
    match_along_lines(slot, *shot.unrectified, request);
    return;
  }
  if (!computes_in_order()) {
    match_images(slot, matcher, request);
    return;
  }
  // A chunk has no state from before it, whichever of its frames is the first good one.
  const int chunk = slot.frame / options_.chunk_frames;
  const bool is_first = chunk != chunk_of_past_;
  chunk_of_past_ = chunk;
  if (options_.temporal.reuse == Reuse::kFrame) {
    match_with_reuse(slot, matcher, request, is_first);
  } else {
    match_with_prior(slot, matcher, request, is_first);
  }
}

void FrameWorker::match_along_lines(FrameSlot& slot, const UnrectifiedMatcher& matcher,
                                    const MatchRequest& request) const {
  matcher.match(slot.pair.left, slot.pair.right,
                {.left = request.left, .right = request.right, .confidence = request.confidence},
                slot.maps, &slot.match);
  if (options_.unrectified != UnrectifiedSearch::kOnRectified) {
    return;
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (side == Side::kLeft ? request.left : request.right) {
      bring_to_rectified(*rectifier_, side, execution_, slot.maps.of(side));
    }
  }
}

void FrameWorker::match_images(FrameSlot& slot, const StereoMatcher& matcher,
                               const MatchRequest& request) const {
  if (options_.baselines.empty()) {
    matcher.match(*slot.left, *slot.right, request, slot.maps, &slot.match);
    return;
  }
  std::vector<const Photograph*> images = {slot.left, slot.right};
  for (const Photograph& image : slot.pair.more) {
    images.push_back(&image);
  }
  std::vector<double> positions = {0};
  positions.insert(positions.end(), options_.baselines.begin(), options_.baselines.end());
  slot.match = {};
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (!(side == Side::kLeft ? request.left : request.right)) {
      continue;
    }
    // The other image of the pair is the first: disparities are those of the pair.
    const std::size_t reference = index_of(side);
    std::vector<OtherView> others = {
        {images[1 - reference], positions[1 - reference] - positions[reference]}};
    for (std::size_t k = 2; k < images.size(); ++k) {
      others.push_back({images[k], positions[k] - positions[reference]});
    }
    DisparityMaps maps;
    MatchReport report;
    matcher.match_several(*images[reference], others, request, maps, &report);
    slot.maps.of(side) = std::move(maps.of(side));
    slot.match.add(report);
  }
}

void FrameWorker::match_with_prior(FrameSlot& slot, const StereoMatcher& matcher,
                                   MatchRequest request, bool is_first) {
  if (is_first) {
    temporal_.restart();
  }
  request.prior = temporal_.priors_for(*slot.left, *slot.right, execution_);
  match_images(slot, matcher, request);
  temporal_.remember(*slot.left, *slot.right, slot.maps, execution_);
}

void FrameWorker::match_with_reuse(FrameSlot& slot, const StereoMatcher& matcher,
                                   MatchRequest request, bool is_first) {
  reuse_.start_frame(slot.frame % options_.chunk_frames, is_first);
  request.previous = &reuse_;
  request.deferred = &slot.deferred;
  try {
    matcher.match(*slot.left, *slot.right, request, slot.maps, &slot.match);
  } catch (...) {
    reuse_.forget();  // its maps may be those of two frames
    throw;
  }
}

void FrameWorker::check_range(FrameSlot& slot, const MatchOptions& options) {
  if (!options_.baselines.empty() || options_.unrectified != UnrectifiedSearch::kNone) {
    slot.may_be_cut = false;
    return;
  }
  const MatchesAtEnds matches = matches_at_ends(slot.maps, options);
  slot.may_be_cut = may_be_cut(matches, options, false);
  slot.cut.reset();
  if (slot.may_be_cut && looks_beyond_++ < kMaxLooksBeyond) {
    const TimedStep step(slot, "range check", accounts_.of(RunStep::kMatch));
    slot.cut = look_beyond(matches, *slot.left, *slot.right, options, execution_);
  }
}

/// Null unless the view is at a camera's position.
const Photograph* FrameWorker::photograph_at(const FrameSlot& slot, double view_x) const {
  return view_x == 0 ? slot.left : view_x == 1 ? slot.right : nullptr;
}

void FrameWorker::synthesize(FrameSlot& slot) const {
  slot.view_poses.clear();
  if (!needs_views(slot)) {
    return;
  }
  for (const ViewPath& path : options_.views) {
    slot.view_poses.push_back(placed(path.at(slot.frame), options_.look_at_px, cameras_,
                                     slot.left->width(), slot.left->height()));
  }
  if (options_.saves(SequenceOutput::kStereo)) {
    for (const double view_x : options_.stereo_views_x) {
      if (photograph_at(slot, view_x) == nullptr) {
        slot.view_poses.emplace_back(BaselinePosition{view_x, 0});
      }
    }
  }
  if (slot.view_poses.empty()) {
    return;
  }
  const TimedStep step(slot, "views", accounts_.of(RunStep::kViews));
  slot.views.resize(slot.view_poses.size());
  ViewSource source{*slot.left,
                    *slot.right,
                    slot.maps.left.disparity_px.view(),
                    slot.maps.right.disparity_px.view(),
                    {}};
  if (photograph_grid_) {
    photograph_grid_->bring(slot.maps, slot.photograph_maps);
    source.photographs.emplace(
        photograph_grid_->pair_of(slot.pair.left, slot.pair.right, slot.photograph_maps));
  }
  const std::array<IntensityFit, 4>* fit =
      options_.intensity_fit == FitScope::kShot ? &shots_->shot_of(slot.frame).intensity : nullptr;
  for (std::size_t view = 0; view < slot.views.size(); ++view) {
    renderer_.render(source, slot.view_poses[view], slot.views[view], fit);
  }
}

PreviewRange FrameWorker::preview_range_of_frame(const FrameSlot& slot) const {
  if (options_.preview_range_per_shot) {
    return shots_->shot_of(slot.frame).preview_range;
  }
  return preview_range_of(
      slot.pair.details.disparities.value_or(searched_in_all(options_.match.disparities, shots_)));
}

void FrameWorker::paint_preview(FrameSlot& slot) const {
  if (!wants(slot, SequenceOutput::kPreview)) {
    return;
  }
  const TimedStep step(slot, "preview", accounts_.of(RunStep::kPictures));
  const PreviewRange range = preview_range_of_frame(slot);
  slot.preview.pixels = colour_preview(primary_map(slot).view(), range.min_px, range.max_px);
}

void FrameWorker::paint_depth_picture(FrameSlot& slot) const {
  if (!wants(slot, SequenceOutput::kDepthVideo)) {
    return;
  }
  const TimedStep step(slot, "depth", accounts_.of(RunStep::kPictures));
  const DisparityMap& map = primary_map(slot);
  auto picture = take_image<std::uint16_t>(slot.depth, {map.width(), map.height(), 1});
  paint_depth(map.view(),
              depth_range_of(options_.depth_scale, options_.match.disparities, shots_, slot.frame),
              picture);
  slot.depth.pixels = std::move(picture);
}

void FrameWorker::measure_comfort_of(FrameSlot& slot) const {
  slot.comfort.reset();
  if (!options_.saves(SequenceOutput::kComfort) || slot.stored != nullptr) {
    return;
  }
  const TimedStep step(slot, "comfort", accounts_.of(RunStep::kComfort));
  slot.comfort = measure_comfort(*slot.left, *slot.right, slot.maps.of(options_.match.reference),
                                 options_.match.reference);
}

void FrameWorker::measure_disparities_of(FrameSlot& slot) const {
  slot.disparities.reset();
  if (!options_.saves(SequenceOutput::kDepthResolution) || slot.stored != nullptr) {
    return;
  }
  const TimedStep step(slot, "depth", accounts_.of(RunStep::kPictures));
  if (const auto disparities = disparity_quantiles(primary_map(slot).view())) {
    slot.disparities = {*disparities, map_camera_of(slot)->scale};
  }
}

void FrameWorker::pack_stereo_picture(FrameSlot& slot) const {
  if (!wants(slot, SequenceOutput::kStereo)) {
    return;
  }
  const TimedStep step(slot, "stereo", accounts_.of(RunStep::kPictures));
  std::size_t next_view = options_.views.size();
  const auto picture_at = [&](double view_x) {
    const Photograph* photograph = photograph_at(slot, view_x);
    return photograph != nullptr ? photograph : &slot.views[next_view++].image;
  };
  const Photograph* left = picture_at(options_.stereo_views_x[0]);
  const Photograph* right = picture_at(options_.stereo_views_x[1]);
  show_stereo(*left, *right, options_.stereo_packing, slot.stereo);
}

const DisparityMap& FrameWorker::primary_map(const FrameSlot& slot) const {
  return slot.maps.of(options_.match.reference).disparity_px;
}

void FrameWorker::copy_picture(const FrameSlot& slot, const OutputStream& stream,
                               Photograph& picture) const {
  if (const Photograph* stored = stored_picture(slot, stream)) {
    std::visit([&](const auto& image) { copy_image(image, picture); }, stored->pixels);
  } else {
    copy_image(mask_of(slot, stream), picture);
  }
}

void FrameWorker::encode(FrameSlot& slot) const {
  slot.files.discard();  // left by an abandoned frame
  slot.file_records.clear();
  if (slot.is_lead_in || slot.is_absent || slot.stored != nullptr) {
    return;
  }
  const TimedStep step(slot, "encode", accounts_.of(RunStep::kEncode));
  for (const OutputStream& stream : layout_.streams()) {
    if (stream.as_video) {
      continue;
    }
    const std::filesystem::path name = SequenceLayout::file(
        stream, slot.frame, slot.pair.details.name, extension_of(slot, stream));
    const std::filesystem::path path = layout_.folder() / name;
    encode_stream(slot, stream, path);
    slot.files.add(path, slot.encoded);
    slot.file_records.push_back({name.string(), {slot.encoded.size(), crc32_of(slot.encoded)}});
  }
}

}  // namespace vantage
