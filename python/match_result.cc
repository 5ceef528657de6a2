#include "python/match_result.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <functional>
#include <memory>

#include "engine/sequence/shots/preview_range.h"
#include "python/arrays.h"
#include "python/calls.h"

namespace vantage::python {
namespace py = pybind11;

MatchResult::MatchResult(const PairMatcher& matcher, Execution& execution, MatchedImages images,
                         Wanted wanted, std::shared_ptr<const UnrectifiedPairs> unrectified,
                         std::shared_ptr<SpareMaps> spare)
    : execution_(execution),
      images_(std::move(images)),
      unrectified_(std::move(unrectified)),
      spare_(std::move(spare)) {
  computed_.maps = spare_->take();
  computed_.options = matcher.options();
  computed_.rows = matcher.rows();
  computed_.on_photographs = unrectified_ && !unrectified_->on_rectified();
  if (wanted.other && !images_.is_pair()) {
    throw UsageError("right_disparity cannot be had of several images: the first one has a map");
  }
  on_threads_of(execution_, [&] { match(matcher, images_.read(), wanted, computed_); });
}

void MatchResult::match(const PairMatcher& matcher, const std::vector<Photograph>& photographs,
                        Wanted wanted, ComputedMaps& computed) const {
  const Side side = images_.side(matcher.options().reference);
  PosteriorMoments moments;
  const VolumeRequest posterior{.side = side, .sink = &moments};
  MatchRequest request{.left = side == Side::kLeft || wanted.other,
                       .right = side == Side::kRight || wanted.other,
                       .probability = wanted.confidence};
  if (wanted.posterior) {
    request.volumes = {&posterior, 1};
  }
  computed.options =
      unrectified_ ? unrectified_->match(matcher.options(), photographs[0], photographs[1], request,
                                         computed.maps, computed.report)
                   : images_.match(matcher, photographs, request, computed.maps, &computed.report);
  computed.report.remarks.insert(computed.report.remarks.begin(), images_.remarks().begin(),
                                 images_.remarks().end());
  if (wanted.posterior) {
    moments.erase(photographs[images_.reference(side)].left_out);
    computed.posterior = {moments.mean_px().copy(), moments.variance_px2().copy()};
  }
  computed.has = wanted;
}

void MatchResult::require(Wanted wanted, const char* asked_for) {
  if (computed_.has.covers(wanted)) {
    return;
  }
  if (computed_.is_final) {
    throw Error(fmt::format(
        "{} depends on more than the images of the frame, expected it in save of the Sequence",
        asked_for));
  }
  if (unrectified_ && wanted.posterior) {
    throw UsageError(
        "posterior cannot be used with unrectified: candidates differ by fractions from pixel to "
        "pixel");
  }
  const PairMatcher matcher(computed_.options, execution_, computed_.rows);
  ComputedMaps rest;
  on_threads_of(execution_, [&] {
    match(matcher, images_.read_again(asked_for), computed_.has.with(wanted), rest);
  });
  // Another thread may have been faster meanwhile, and arrays then show its maps.
  if (wanted.other && !computed_.has.other) {
    const Side other = side() == Side::kLeft ? Side::kRight : Side::kLeft;
    computed_.maps.of(other) = std::move(rest.maps.of(other));
    computed_.has.other = true;
  }
  if (wanted.confidence && !computed_.has.confidence) {
    computed_.maps.of(side()).confidence = std::move(rest.maps.of(side()).confidence);
    computed_.has.confidence = true;
  }
  if (wanted.posterior && !computed_.has.posterior) {
    computed_.posterior = std::move(rest.posterior);
    computed_.has.posterior = true;
  }
}

void MatchResult::require_right(const char* asked_for) {
  if (!images_.is_pair()) {
    throw Error(
        fmt::format("{} cannot be had of several images: the first one has a map", asked_for));
  }
  require({.other = side() == Side::kLeft}, asked_for);
}

const CyclopeanMap& MatchResult::require_cyclopean(const char* asked_for) {
  if (!images_.is_pair() || computed_.options.resolved().selection != Selection::kSymmetric) {
    throw UsageError(
        fmt::format("{} is asked for, expected it with selection=\"symmetric\" only", asked_for));
  }
  if (!computed_.cyclopean) {
    require({.other = side() == Side::kRight}, asked_for);
    CyclopeanMap made;
    on_threads_of(execution_, [&] { make_cyclopean_map(computed_.maps.left, execution_, made); });
    if (!computed_.cyclopean) {
      computed_.cyclopean.emplace(std::move(made));
    }
  }
  return *computed_.cyclopean;
}

py::array_t<float> MatchResult::disparity(const py::object& self) const {
  return array_over(map().disparity_px, self);
}

py::object MatchResult::disparity_y(const py::object& self) const {
  return computed_.options.disparities_y ? py::object(array_over(map().disparity_y_px, self))
                                         : py::none();
}

py::array_t<float> MatchResult::right_disparity(const py::object& self) {
  require_right("right_disparity");
  return array_over(computed_.maps.right.disparity_px, self);
}

std::vector<std::string> MatchResult::remarks() const {
  std::vector<std::string> texts;
  for (const Remark& remark : computed_.report.remarks) {
    texts.push_back(remark.text);
  }
  return texts;
}

py::array_t<bool> MatchResult::unmatched() const { return array_of(map().unmatched.view()); }

py::array_t<bool> MatchResult::right_unmatched() {
  require_right("right_disparity");
  return array_of(std::as_const(computed_.maps.right.unmatched).view());
}

py::array_t<float> MatchResult::confidence(const py::object& self) {
  require({.confidence = true}, "confidence");
  return array_over(map().confidence, self);
}

py::array_t<float> MatchResult::posterior_mean(const py::object& self) {
  require({.posterior = true}, "posterior");
  return array_over(computed_.posterior.mean_px, self);
}

py::array_t<float> MatchResult::posterior_variance(const py::object& self) {
  require({.posterior = true}, "posterior");
  return array_over(computed_.posterior.variance_px2, self);
}

py::array_t<float> MatchResult::cyclopean(const py::object& self) {
  return array_over(require_cyclopean("cyclopean").disparity_px, self);
}

py::array_t<std::uint8_t> MatchResult::cyclopean_occlusion(const py::object& self) {
  return array_over(require_cyclopean("cyclopean_occlusion").seen_by, self);
}

std::string MatchResult::text() const {
  return fmt::format("<vantage.MatchResult: {}x{}, disparities {}:{}>", map().disparity_px.height(),
                     map().disparity_px.width(), computed_.options.disparities.min,
                     computed_.options.disparities.max);
}

py::array MatchResult::preview() const {
  const PreviewRange range =
      computed_.preview.value_or(preview_range_of(computed_.options.disparities));
  return array_of({colour_preview(map().disparity_px.view(), range.min_px, range.max_px)},
                  ChannelOrder::kRgb);
}

void MatchResult::require_rectified(const char* asked_for) const {
  if (computed_.on_photographs) {
    throw UsageError(fmt::format(
        "{} is of rectified pixels, expected rectified_pixels=True beside unrectified", asked_for));
  }
}

std::optional<StereoCalibration> MatchResult::cameras(
    const std::optional<StereoCalibration>& given) const {
  return given || !unrectified_ ? given
                                : unrectified_->rectified_cameras(map().disparity_px.width(),
                                                                  map().disparity_px.height());
}

py::array MatchResult::depth(const std::optional<StereoCalibration>& calibration,
                             const py::dict& keywords) const {
  require_rectified("depth");
  const MetricOptions options = metric_options(MetricOutput::kDepth, MapKind::kResult, keywords);
  return array_of(on_threads_of(execution_, [&] {
    const MetricCamera camera =
        metric_camera(metric_map(), cameras(calibration), options, MetricOutput::kDepth);
    return depths(metric_map(), camera, options, execution_);
  }));
}

py::array MatchResult::depth_resolution(const std::optional<StereoCalibration>& calibration,
                                        const py::dict& keywords) const {
  require_rectified("depth_resolution");
  const MetricOptions options =
      metric_options(MetricOutput::kDepthResolution, MapKind::kResult, keywords);
  const bool has_fractions = computed_.options.resolved().subpixel != Subpixel::kNone;
  return array_of(on_threads_of(execution_, [&] {
    const MetricCamera camera =
        metric_camera(metric_map(), cameras(calibration), options, MetricOutput::kDepthResolution);
    return depth_resolutions(metric_map(), camera, options, has_fractions ? 0.1 : 1, execution_);
  }));
}

template <typename Make>
auto MatchResult::make_points(const std::optional<StereoCalibration>& calibration,
                              const py::dict& keywords, const Make& make) {
  require_rectified("a cloud or mesh");
  const MetricOptions options = metric_options(MetricOutput::kPoints, MapKind::kResult, keywords);
  const MetricCamera camera =
      metric_camera(metric_map(), cameras(calibration), options, MetricOutput::kPoints);
  if (options.cloud.reads_confidence()) {
    require({.confidence = true}, "confidence");
  }
  return on_threads_of(execution_, [&] {
    const std::vector<Photograph> photographs = images_.read_again("the colours of points");
    const Photograph* colours = &photographs[images_.reference(side())];
    Photograph rectified;
    if (unrectified_) {
      rectified = unrectified_->rectified(*colours, side());
      colours = &rectified;
    }
    const CloudSource source{.disparity_px = map().disparity_px.view(),
                             .colours = colours,
                             .unmatched = map().unmatched.view(),
                             .confidence = map().confidence.view(),
                             .camera = camera.camera};
    return make(source, options.cloud, execution_, camera.frame);
  });
}

FramedCloud MatchResult::cloud(const std::optional<StereoCalibration>& calibration,
                               const py::dict& keywords) {
  return make_points(calibration, keywords, make_cloud);
}

FramedMesh MatchResult::mesh(const std::optional<StereoCalibration>& calibration,
                             const py::dict& keywords) {
  return make_points(calibration, keywords, make_mesh);
}

namespace {

/// A getter whose arrays keep the result alive.
template <typename Get>
auto with_owner(const Get& get) {
  return
      [get](const py::object& self) { return std::invoke(get, self.cast<MatchResult&>(), self); };
}

/// `method` with a calibration, or the path of one, and options as keyword arguments.
template <typename Method>
auto with_options(const Method& method) {
  return [method](MatchResult& self, const py::object& calibration, const py::kwargs& keywords) {
    return std::invoke(method, self, calibration_from(calibration), keywords);
  };
}

constexpr const char* kCameraOptions =
    "calibration: Calibration of the images (or the path of one), which are rectified. Instead, or "
    "for\none without a scale: focal_length (pixels) with baseline (metres), doffs, "
    "principal_point,\ncalibration_unit, as `vantage match` has them. Frames of a Sequence know "
    "theirs.\n";

}  // namespace

void bind_match_result(py::module_& module) {
  const std::string camera = kCameraOptions;
  const std::string points =
      "options: max_depth (metres), cloud_step, cloud_min_confidence, cloud_confidence, "
      "cloud_filled,\ncloud_outlines, cloud_gradient_limit. Filled pixels and outlines are left "
      "out "
      "by default.\n\n" +
      camera + "Raises Error where no point is left, or the images have changed.";
  py::class_<MatchResult>(module, "MatchResult",
                          "The maps of a pair, or of several images. Arrays are of the reference's "
                          "size, HxW.\n\nWhat compute() did not make at once is made when it is "
                          "asked for; it raises Error if the images\nhave changed by then.")
      .def_property_readonly("disparity", with_owner(&MatchResult::disparity),
                             "float32: x_left - x_right in pixels; NaN: unknown.")
      .def_property_readonly("disparity_y", with_owner(&MatchResult::disparity_y),
                             "float32: y_left - y_right in pixels, with disparities_y; else None.")
      .def_property_readonly("right_disparity", with_owner(&MatchResult::right_disparity),
                             "float32: the map of the right image. Not of several images.")
      .def_property_readonly("confidence", with_owner(&MatchResult::confidence),
                             "float32: probability that the disparity is within 1 px of the true "
                             "one; 0 where it is unknown.")
      .def_property_readonly("posterior_mean", with_owner(&MatchResult::posterior_mean),
                             "float32: mean of p(d) before refinement, in pixels; NaN: no "
                             "probability.\n\nUsageError for methods without probabilities: it "
                             "needs bayes or a preset but realtime.")
      .def_property_readonly("posterior_variance", with_owner(&MatchResult::posterior_variance),
                             "float32: variance of p(d) in square pixels, as posterior_mean.")
      .def_property_readonly("cyclopean", with_owner(&MatchResult::cyclopean),
                             "float32: disparities of a camera in the middle; NaN unless both "
                             "cameras see it.\n\nUsageError without selection=\"symmetric\".")
      .def_property_readonly("cyclopean_occlusion", with_owner(&MatchResult::cyclopean_occlusion),
                             "uint8: what sees the pixels of that camera: 0 both, 128 the left "
                             "camera alone, 255 the right one alone, 64 no match.")
      .def_property_readonly("unmatched", &MatchResult::unmatched,
                             "bool: pixels without a match, filled from their neighbours. A copy.")
      .def_property_readonly("right_unmatched", &MatchResult::right_unmatched,
                             "bool: the same of the right map.")
      .def_property_readonly("disparities", &MatchResult::disparities,
                             "(MIN, MAX): the range that was searched, ends included.")
      .def_property_readonly("remarks", &MatchResult::remarks,
                             "list of texts: what was found, assumed and corrected.")
      .def_property_readonly(
          "matched_share", [](const MatchResult& self) { return self.shares().matched; },
          "float: share of the pixels that were matched; the others are filled or unknown.")
      .def_property_readonly(
          "filled_share", [](const MatchResult& self) { return self.shares().filled; },
          "float: share of the pixels that were filled from their neighbours.")
      .def_property_readonly(
          "reliable_share", [](const MatchResult& self) { return self.shares().reliable; },
          "float: expected share of disparities within 1 px of the true ones; below 0.45 the match "
          "warns.")
      .def("__repr__", &MatchResult::text)
      .def("preview", &MatchResult::preview,
           "The map in false colours over the range searched: uint8, HxWx3, RGB.")
      .def("depth", with_options(&MatchResult::depth), py::arg("calibration") = py::none(),
           ("Depths in metres: float32, HxW; NaN: unknown, or beyond max_depth.\n\n" + camera +
            "Raises Error for a calibration without a scale.")
               .c_str())
      .def("depth_resolution", with_options(&MatchResult::depth_resolution),
           py::arg("calibration") = py::none(),
           ("Distance from each depth to the next one that can be told from it: float32, HxW, in "
            "metres,\nor in the calibration's unit where its length is not known.\n\n"
            "disparity_resolution: difference of disparities that can be told apart, in pixels; "
            "default\n0.1, or 1 with subpixel=\"none\".\n" +
            camera)
               .c_str())
      .def("cloud", with_options(&MatchResult::cloud), py::arg("calibration") = py::none(),
           ("The pixels as points in metres, with their colours: a PointCloud.\n\n" + points)
               .c_str())
      .def("mesh", with_options(&MatchResult::mesh), py::arg("calibration") = py::none(),
           ("The points as a surface of triangles, cut where the disparity jumps: a Mesh.\n\n" +
            points)
               .c_str());
}

}  // namespace vantage::python
