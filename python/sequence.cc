// Frames of a sequence, computed ahead of the loop that takes them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "engine/io/files/remote_files.h"
#include "engine/jobs/sequence_job.h"
#include "engine/jobs/sequence_session.h"
#include "engine/options/frame_step_setting.h"
#include "engine/options/synthesis_settings.h"
#include "engine/reprojection/ply_file.h"
#include "engine/sequence/frame_iterator.h"
#include "engine/sequence/memory_plan.h"
#include "engine/sequence/pairs/sequence_range.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/match_result.h"
#include "python/options.h"
#include "python/pair_feed.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

/// Outputs that are files of a run, and what is there instead.
constexpr std::array<std::pair<SequenceOutput, const char*>, 6> kNotOfFrames = {
    {{SequenceOutput::kDepth, "frame.result.depth()"},
     {SequenceOutput::kDepthResolution, "frame.result.depth_resolution()"},
     {SequenceOutput::kCloud, "frame.result.cloud()"},
     {SequenceOutput::kMesh, "frame.result.mesh()"},
     {SequenceOutput::kDepthVideo, "'vantage run'"},
     {SequenceOutput::kComfort, "'vantage run'"}}};

void require_outputs_of_frames(const SequenceOptions& options) {
  for (const auto& [output, instead] : kNotOfFrames) {
    if (options.saves(output)) {
      throw UsageError(fmt::format("save holds {}, expected {} instead",
                                   output_names({output})[0].get<std::string>(), instead));
    }
  }
}

/// What a user asked for, opened and examined. Thread rule: pure, but for the source.
struct OpenSequence {
  SequenceJob job;
  SequenceSession session;
  std::optional<ShotTable> shots;
  Execution* execution = nullptr;
  int in_flight = 1;
  ChannelOrder order = ChannelOrder::kRgb;  ///< of arrays
  std::mutex mutex;                         ///< of the next one
  std::unique_ptr<PairSource> idle;         ///< no iterator reads it

  std::unique_ptr<PairSource> take_source() {
    {
      const std::scoped_lock lock(mutex);
      if (idle) {
        return std::move(idle);
      }
    }
    return open_pair_source(job.input);
  }
  void give_back(std::unique_ptr<PairSource> source) {
    const std::scoped_lock lock(mutex);
    idle = source->is_stream() ? nullptr : std::move(source);
  }
};

bool knows_metres(const SequenceJob& job, const std::optional<StereoCalibration>& calibration) {
  return calibration ? job.rig.unit_of(*calibration).has_value()
                     : job.rig.focal_length_px && job.rig.baseline_m;
}

void open(const std::optional<StereoCalibration>& calibration, OpenSequence& opened) {
  SequenceJob& job = opened.job;
  SequenceSession& session = opened.session;
  Execution& execution = *opened.execution;
  forget_remote_files();  // a list may name addresses, too
  open_source(job, session);
  FramePair first;
  read_first_pair(*session.pairs, first);
  const bool is_metric = job.sequence.unrectified != UnrectifiedSearch::kOnPhotographs &&
                         knows_metres(job, calibration);
  prepare_pairs(job, calibration, is_metric, first, execution, session);
  (void)find_rows(job, execution, session);
  const auto rectify = [&](FramePair& pair) { session.rectify(pair, execution); };
  MatchOptions& match = job.sequence.match;
  use_ranges(session.columns, match);
  if (match.disparities_auto) {
    match.disparities =
        require_disparity_range(find_sequence_range(*session.pairs, rectify, execution));
    match.disparities_auto = false;
  }
  job.sequence.validate();
  SequenceOptions planned = job.sequence;
  planned.match.disparities = session.columns.widest_with(match.disparities);
  opened.in_flight =
      plan_memory(planned, memory_request(job.in_flight), session.shape, first, execution.options())
          .in_flight;
  if (job.sequence.needs_shots()) {
    SurveyHooks hooks;
    hooks.in_flight = opened.in_flight;
    hooks.prepare = rectify;
    opened.shots = survey_shots(*session.pairs, 0, session.selection.frame_count, job.sequence,
                                hooks, execution);
  }
  session.pairs->forget_start();
  opened.idle = std::move(session.pairs);
}

Photograph copy_of(const Photograph& photograph) {
  return std::visit([](const auto& image) { return Photograph{image.copy()}; }, photograph.pixels);
}

/// The frames of one loop. Thread rule: one thread at a time, as the GIL has it.
class FrameLoop {
 public:
  FrameLoop(std::shared_ptr<OpenSequence> opened, const std::vector<int>& frames)
      : opened_(std::move(opened)) {
    without_gil([&] {
      source_ = opened_->take_source();
      run_.emplace(run_of_source());
      frames_ = std::make_shared<FrameIterator>(opened_->job.sequence, *run_, frames,
                                                *opened_->execution);
    });
  }
  FrameLoop(const FrameLoop&) = delete;
  FrameLoop& operator=(const FrameLoop&) = delete;
  ~FrameLoop() { close(); }

  /// Attributes of a Frame; None at the end.
  py::object next() {
    // Kept while it is waited for: another thread may close the loop.
    const std::shared_ptr<FrameIterator> frames = frames_;
    if (!frames) {
      return py::none();
    }
    std::optional<ComputedFrame> frame = without_gil([&] { return frames->next(); });
    if (!frame || !frames_) {
      return py::none();
    }
    const FrameSlot& slot = *frame->slot;
    warn_of_pairing();
    warnings_.warn(source_->white_level().remarks);
    warnings_.warn(slot.match.remarks);
    if (slot.cut && slot.cut->any()) {
      const Remark remark = cut_range_remark(*slot.cut, frame->searched, false);
      warnings_.warn({&remark, 1});
    }
    return attributes_of(*frame);
  }

  void close() {
    const std::shared_ptr<FrameIterator> frames = std::move(frames_);
    if (!frames) {
      return;
    }
    skipped_ = frames->skipped();
    const ReleasedGil release;
    if (opened_->job.input.queue != nullptr) {
      opened_->job.input.queue->close();
    }
    frames->stop();
    dropped_ = source_->dropped_pairs();
    opened_->give_back(std::move(source_));
  }

  /// Pairs that a live stream left out, once the loop is closed.
  [[nodiscard]] int dropped() const { return dropped_; }
  [[nodiscard]] std::vector<std::pair<int, std::string>> skipped() const {
    std::vector<std::pair<int, std::string>> frames;
    for (const FrameRemark& remark : frames_ ? frames_->skipped() : skipped_) {
      frames.emplace_back(remark.frame, remark.text);
    }
    return frames;
  }

 private:
  void warn_of_pairing() {
    const std::vector<std::string> remarks = source_->remarks();
    const Remark remark{Remark::Kind::kWarning, "pairing",
                        fmt::format("{}", fmt::join(remarks, "; "))};
    if (!remarks.empty()) {
      warnings_.warn({&remark, 1});
    }
  }

  SequenceRun run_of_source() const {
    const SequenceSession& session = opened_->session;
    return session.run(opened_->job, *source_, opened_->shots ? &*opened_->shots : nullptr,
                       opened_->in_flight);
  }

  [[nodiscard]] ComputedMaps maps_of(ComputedFrame& frame) const {
    const SequenceOptions& options = opened_->job.sequence;
    FrameSlot& slot = *frame.slot;
    ComputedMaps computed{
        .options = options.match,
        .maps = std::move(slot.maps),
        .has = {.other = frame.has_both_maps,
                .confidence = options.saves(SequenceOutput::kConfidence),
                .posterior = options.saves_posterior()},
        .report = slot.match,
        .preview = frame.preview,
        .is_final = options.temporal.uses_past() || !options.baselines.empty() ||
                    options.unrectified != UnrectifiedSearch::kNone || slot.rows.has_value(),
        .on_photographs = options.unrectified == UnrectifiedSearch::kOnPhotographs};
    computed.options.disparities = frame.searched;
    if (options.saves_posterior()) {
      computed.posterior = {slot.posterior.mean_px().copy(), slot.posterior.variance_px2().copy()};
    }
    if (options.saves_cyclopean()) {
      computed.cyclopean.emplace(std::move(slot.cyclopean));
    }
    if (frame.camera) {
      computed.camera = {*frame.camera,
                         std::string(opened_->session.poses ? kWorldFrame : kCameraFrame)};
    }
    return computed;
  }

  [[nodiscard]] py::dict attributes_of(ComputedFrame& frame) const {
    FrameSlot& slot = *frame.slot;
    const bool is_rectified = slot.left != &slot.pair.left;
    Photograph& left = is_rectified ? slot.rectified[0] : slot.pair.left;
    Photograph& right = is_rectified ? slot.rectified[1] : slot.pair.right;
    std::pair<Photograph, Photograph> images;
    // Before others may run, who may close the loop.
    const std::string name = source_->describe(slot.frame);
    ComputedMaps computed = without_gil([&] {
      images = {copy_of(left), copy_of(right)};
      return maps_of(frame);
    });
    py::dict found;
    found["index"] = opened_->job.input.live ? slot.pair.index : slot.frame;
    found["name"] = text_of(name);
    found["left"] = array_of(std::move(images.first), opened_->order);
    found["right"] = array_of(std::move(images.second), opened_->order);
    found["result"] = py::cast(std::make_unique<MatchResult>(
        *opened_->execution, MatchedImages(std::move(left), std::move(right)),
        std::move(computed)));
    add_views(slot, found);
    found["share_reused"] = slot.match.searched_share
                                ? py::object(py::float_(1 - *slot.match.searched_share))
                                : py::none();
    py::list remarks;
    for (const std::string& remark : slot.pair.remarks) {
      remarks.append(text_of(remark));
    }
    found["remarks"] = remarks;
    return found;
  }

  void add_views(FrameSlot& slot, py::dict& found) const {
    const SequenceOptions& options = opened_->job.sequence;
    py::list views;
    py::list holes;
    py::list sources;
    for (std::size_t view = 0; view < options.views.size(); ++view) {
      views.append(array_of(std::move(slot.views[view].image), opened_->order));
      holes.append(array_of(std::as_const(slot.views[view].holes).view()));
      sources.append(array_of(Photograph{std::move(slot.views[view].sources)}, opened_->order));
    }
    found["views"] = views;
    found["holes"] = holes;
    found["sources"] = sources;
    found["stereo"] = options.saves(SequenceOutput::kStereo)
                          ? py::object(array_of(std::move(slot.stereo), opened_->order))
                          : py::none();
  }

  std::shared_ptr<OpenSequence> opened_;
  std::unique_ptr<PairSource> source_;
  std::optional<SequenceRun> run_;
  std::shared_ptr<FrameIterator> frames_;  ///< null: closed
  std::vector<FrameRemark> skipped_;
  int dropped_ = 0;
  RemarkWarnings warnings_;
};

void add_sequence_settings(Settings& settings, SequenceJob& job) {
  add_input_settings(settings, job);
  settings.flag("rectified-pixels", job.rectified_pixels, "With unrectified: as for Matcher");
  std::erase_if(add_save_setting(settings, job).words, [](const std::string& word) {
    return std::ranges::any_of(kNotOfFrames, [&word](const auto& output) {
      return output_names({output.first})[0] == word;
    });
  });
  add_picture_settings(settings, job);
  add_rig_scale_settings(settings, job.rig);
  add_poses_setting(settings, job);
  add_steadiness_settings(settings, job);
  add_frames_setting(settings, job.frames, job.step_of_frames);
  add_chunk_frames_setting(settings, job);
  add_in_flight_setting(settings, job);
  add_live_setting(settings, job);
  settings.flag("keep-going", job.keep_going, "Leave out frames that fail; they are in skipped");
  add_reference_setting(settings, job.sequence.match.reference);
  add_match_settings(settings, job.sequence.match);
  add_synthesis_settings(settings, job.sequence.synthesis);
}

/// Sequence of the package.
class Sequence {
 public:
  /// `is_unrectified`: rectification with `calibration` is part of the search. `is_supplied`: its
  /// pairs come from a PairFeed, one for each loop.
  Sequence(std::optional<StereoCalibration> calibration, bool is_unrectified, bool is_supplied,
           bool bgr, py::dict keywords)
      : opened_(std::make_shared<OpenSequence>()), calibration_(std::move(calibration)) {
    SequenceJob& job = opened_->job;
    opened_->order = bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb;
    if (is_supplied) {
      job.input.queue = std::make_shared<PairQueue>(1);  // of each loop another one
    }
    opened_->execution = &take_execution(keywords);
    Settings settings;
    add_sequence_settings(settings, job);
    set_options(settings, keywords);
    if (calibration_) {
      require_no_file_options(job.rig);
      (is_unrectified ? job.unrectified : job.calibration) =
          calibration_->file.empty() ? "calibration" : calibration_->file;
    }
    read_pose_files(job.views, read_toml);
    complete_sequence(job, is_supplied);
    require_outputs_of_frames(job.sequence);
    check_sequence(job, settings);
    if (job.input.is_stream()) {
      throw UsageError("the input is a stream, expected files: 'vantage run' reads streams");
    }
    if (is_supplied && job.sequence.needs_shots()) {
      throw UsageError("an option is shot, expected another value: pairs come one by one");
    }
    if (!is_supplied) {
      on_threads_of(*opened_->execution, [&] { open(calibration_, *opened_); });
    }
  }

  [[nodiscard]] std::shared_ptr<PairFeed> feed() const {
    const int threads = opened_->execution->executor().thread_count();
    const int room = opened_->job.in_flight.value_or(default_frames_in_flight(threads));
    return std::make_shared<PairFeed>(static_cast<std::size_t>(room), opened_->order);
  }
  /// Null where it ends before its first pair. Who supplies pairs may need the threads meanwhile.
  [[nodiscard]] std::unique_ptr<FrameLoop> loop_over(const PairFeed& feed) const {
    if (!without_gil([&] { return feed.has_pairs(); })) {
      return nullptr;
    }
    auto opened = std::make_shared<OpenSequence>();
    opened->job = opened_->job;
    opened->job.input.queue = feed.queue();
    opened->execution = opened_->execution;
    opened->order = opened_->order;
    on_threads_of(*opened->execution, [&] { open(calibration_, *opened); });
    return std::make_unique<FrameLoop>(std::move(opened), std::vector<int>());
  }

  [[nodiscard]] int count() const { return opened_->session.selection.frame_count; }
  /// Those of `frames` as a text.
  [[nodiscard]] std::pair<int, int> selected() const {
    const FrameRange range = opened_->session.selection.all();
    return {range.first, range.end};
  }
  [[nodiscard]] std::unique_ptr<FrameLoop> loop(const std::vector<int>& frames) const {
    return std::make_unique<FrameLoop>(opened_, frames);
  }

 private:
  std::shared_ptr<OpenSequence> opened_;
  std::optional<StereoCalibration> calibration_;
};

}  // namespace

void bind_sequence(py::module_& module) {
  declare_options(module, "Sequence", ThreadOptions::kTaken, add_sequence_settings,
                  {"raw-video"});  // of streams
  py::class_<FrameLoop>(module, "FrameLoop")
      .def("next", &FrameLoop::next)
      .def("close", &FrameLoop::close)
      .def("skipped", &FrameLoop::skipped)
      .def("dropped", &FrameLoop::dropped);
  py::class_<PairFeed, std::shared_ptr<PairFeed>>(module, "PairFeed")
      .def("put", &PairFeed::put)
      .def("end", &PairFeed::end)
      .def("close", &PairFeed::close);
  py::class_<Sequence>(module, "Sequence")
      .def(py::init<std::optional<StereoCalibration>, bool, bool, bool, py::dict>())
      .def("feed", &Sequence::feed)
      .def("loop_over", &Sequence::loop_over)
      .def("loop", &Sequence::loop)
      .def("selected", &Sequence::selected)
      .def("__len__", &Sequence::count);
}

}  // namespace vantage::python
