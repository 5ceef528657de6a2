#include "python/matcher.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "engine/io/images/scene_mask.h"
#include "engine/options/pair_source_settings.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/options.h"

namespace vantage::python {
namespace py = pybind11;

namespace {

void add_setup_settings(Settings& settings, MatchSetup& setup) {
  add_reference_setting(settings, setup.options.reference);
  add_match_settings(settings, setup.options);
  add_white_level_setting(settings, setup.white_level);
  add_rows_setting(settings, setup.rows);
}

}  // namespace

MatchSetup match_setup(py::dict keywords) {
  MatchSetup setup;
  setup.execution = &take_execution(keywords);
  Settings settings;
  add_setup_settings(settings, setup);
  set_options(settings, keywords);
  return setup;
}

MatchedImages ImageArguments::images(std::optional<double> white_level) const {
  const ChannelOrder order = bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb;
  std::vector<PixelArray> arrays;
  arrays.emplace_back(left, order, "left");
  arrays.emplace_back(right, order, "right");
  for (std::size_t i = 0; i < more.size(); ++i) {
    arrays.emplace_back(more[i], order, fmt::format("more[{}]", i));
  }
  std::array<Mask, 2> masks;
  const bool is_none = py::isinstance<py::str>(mask) && mask.equal(py::str("none"));
  if (!mask.is_none() && !is_none) {
    masks[0] = black_pixels(Photograph{mask_from(mask, "mask")});
  }
  if (!mask_right.is_none()) {
    masks[1] = black_pixels(Photograph{mask_from(mask_right, "mask_right")});
  }
  const bool finds_borders = mask.is_none() && mask_right.is_none();
  return {std::move(arrays), baselines, std::move(masks), finds_borders, white_level};
}

Matcher::Matcher(const std::optional<StereoCalibration>& unrectified, bool on_rectified,
                 const py::dict& keywords)
    : setup_(match_setup(keywords)), matcher_(setup_.options, *setup_.execution, setup_.rows) {
  if (unrectified) {
    UnrectifiedMatcher::validate(setup_.options);
    unrectified_ =
        std::make_shared<const UnrectifiedPairs>(*unrectified, on_rectified, *setup_.execution);
  } else if (on_rectified) {
    throw UsageError("rectified-pixels has no effect without unrectified");
  }
  for (const char* const option : {"search_size", "window_levels"}) {
    if (keywords.contains(option) && !keywords[option].is_none()) {
      pair_option_ = option;
    }
  }
}

void Matcher::check(const ImageArguments& arguments) const {
  if (arguments.baselines.empty()) {
    return;
  }
  if (pair_option_) {
    throw UsageError(*pair_option_ +
                     " has no effect with several images: all candidates are searched at full "
                     "size");
  }
  if (setup_.options.reference == Side::kRight) {
    throw UsageError(
        "reference right cannot be used with baselines: the first image is the reference");
  }
  if (setup_.options.disparities_y) {
    throw UsageError(
        "disparities-y cannot be used with baselines: cameras on one line have no vertical "
        "disparities");
  }
}

void Matcher::check_unrectified(const ImageArguments& arguments, Wanted wanted) const {
  if (!unrectified_) {
    return;
  }
  if (!arguments.baselines.empty()) {
    throw UsageError("baselines cannot be used with unrectified: a calibration is of two cameras");
  }
  if (wanted.posterior) {
    throw UsageError(
        "posterior cannot be used with unrectified: candidates differ by fractions from pixel to "
        "pixel");
  }
}

std::unique_ptr<MatchResult> Matcher::compute(const ImageArguments& arguments,
                                              Wanted wanted) const {
  check(arguments);
  check_unrectified(arguments, wanted);
  auto result = std::make_unique<MatchResult>(matcher_, *setup_.execution,
                                              arguments.images(setup_.white_level), wanted,
                                              unrectified_, spare_);
  warnings_.warn(result->report().remarks);
  return result;
}

py::dict Matcher::options() {
  Settings settings;
  add_setup_settings(settings, setup_);
  py::dict result;
  for (const Setting& setting : settings.all()) {
    result[keyword_of(setting.name).c_str()] = to_python(setting.get());
  }
  return result;
}

std::string Matcher::text() const {
  return fmt::format(
      "<vantage.Matcher: {}, disparities {}>", setup_.options.chosen(),
      setup_.options.disparities_auto ? "auto" : to_text(setup_.options.disparities));
}

void bind_matcher(py::module_& module) {
  declare_options(module, "Matcher", ThreadOptions::kTaken, add_setup_settings);
  py::class_<Matcher>(module, "Matcher")
      .def(py::init<const std::optional<StereoCalibration>&, bool, const py::dict&>())
      .def("compute",
           [](const Matcher& self, const py::object& left, const py::object& right,
              const py::list& more, const std::vector<double>& baselines, bool bgr,
              const py::object& mask, const py::object& mask_right, bool other, bool confidence,
              bool posterior) {
             return self.compute({left, right, more, baselines, bgr, mask, mask_right},
                                 {other, confidence, posterior});
           })
      .def("volume",
           [](const Matcher& self, const py::object& left, const py::object& right,
              const py::list& more, const std::vector<double>& baselines, bool bgr,
              const py::dict& keywords) {
             return self.volume({left, right, more, baselines, bgr}, keywords);
           })
      .def("options", &Matcher::options)
      .def("__repr__", &Matcher::text)
      .def_property_readonly("threads", &Matcher::threads);
}

}  // namespace vantage::python
