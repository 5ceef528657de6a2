#include "python/matcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>

#include "engine/io/preview.h"
#include "engine/sequence/preview_range.h"
#include "python/calls.h"
#include "python/options.h"

namespace vantage::python {
namespace py = pybind11;

MatchSetup match_setup(py::dict keywords) {
  MatchSetup setup;
  setup.execution = &take_execution(keywords);
  apps::Settings settings("", "");
  apps::add_reference_setting(settings, setup.options);
  apps::add_match_settings(settings, setup.options);
  set_options(settings, keywords);
  return setup;
}

MatchResult::MatchResult(const PairMatcher& matcher, Execution& execution, PixelArray left,
                         PixelArray right, Wanted wanted)
    : execution_(execution), options_(matcher.options()), has_(wanted) {
  without_gil([&] {
    options_ = matcher.match(left.photograph(), right.photograph(), request(wanted), maps_);
    if (!wanted.right || !wanted.confidence) {
      checksums_ = {left.checksum(), right.checksum()};
    }
  });
  if (!wanted.right || !wanted.confidence) {
    arrays_.emplace(std::move(left), std::move(right));
  }
}

MatchResult::MatchResult(const PairMatcher& matcher, Execution& execution,
                         std::pair<Photograph, Photograph> images)
    : execution_(execution), options_(matcher.options()), images_(std::move(images)) {
  without_gil(
      [&] { options_ = matcher.match(images_->first, images_->second, request({}), maps_); });
}

MatchRequest MatchResult::request(Wanted wanted) const {
  const bool is_right = options_.reference == Side::kRight;
  return {.left = !is_right || wanted.right,
          .right = is_right || wanted.right,
          .confidence = wanted.confidence};
}

void MatchResult::compute_rest(Wanted wanted, const char* asked_for) {
  const PairMatcher matcher(options_, execution_);
  DisparityMaps rest;
  const Wanted all = {.right = wanted.right || has_.right,
                      .confidence = wanted.confidence || has_.confidence};
  without_gil([&] {
    if (images_) {
      matcher.match(images_->first, images_->second, request(all), rest);
      return;
    }
    const auto& [left, right] = *arrays_;
    if (std::pair(left.checksum(), right.checksum()) != checksums_) {
      throw Error(fmt::format(
          "the images have changed since compute(), expected the same for {0}; compute(left, "
          "right, {0}=True) computes it at once",
          asked_for));
    }
    matcher.match(left.photograph(), right.photograph(), request(all), rest);
  });
  // Another thread may have been faster meanwhile, and arrays then show its maps.
  if (wanted.right && !has_.right) {
    maps_.right = std::move(rest.right);
    has_.right = true;
  }
  if (wanted.confidence && !has_.confidence) {
    maps_.of(options_.reference).confidence = std::move(rest.of(options_.reference).confidence);
    has_.confidence = true;
  }
}

py::array_t<float> MatchResult::disparity(const py::object& self) const {
  return array_over(map().disparity_px, self);
}

py::object MatchResult::disparity_y(const py::object& self) const {
  return options_.disparities_y ? py::object(array_over(map().disparity_y_px, self)) : py::none();
}

py::array_t<float> MatchResult::right_disparity(const py::object& self) {
  if (!has_.right && options_.reference == Side::kLeft) {
    compute_rest({.right = true}, "right_disparity");
  }
  return array_over(maps_.right.disparity_px, self);
}

py::array_t<bool> MatchResult::unmatched() const { return array_of(map().unmatched.view()); }

py::array_t<bool> MatchResult::right_unmatched() {
  if (!has_.right && options_.reference == Side::kLeft) {
    compute_rest({.right = true}, "right_disparity");
  }
  return array_of(std::as_const(maps_.right.unmatched).view());
}

py::array_t<float> MatchResult::confidence(const py::object& self) {
  if (!has_.confidence) {
    compute_rest({.confidence = true}, "confidence");
  }
  return array_over(map().confidence, self);
}

py::array MatchResult::preview() const {
  const PreviewRange range = preview_range_of(options_.disparities);
  return array_of({colour_preview(map().disparity_px.view(), range.min_px, range.max_px)},
                  ChannelOrder::kRgb);
}

namespace {

/// Matcher of the package.
class Matcher {
 public:
  explicit Matcher(const py::dict& keywords)
      : setup_(match_setup(keywords)), matcher_(setup_.options, *setup_.execution) {}

  [[nodiscard]] std::unique_ptr<MatchResult> compute(const py::object& left,
                                                     const py::object& right, bool bgr,
                                                     bool right_disparity, bool confidence) const {
    const ChannelOrder order = bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb;
    return std::make_unique<MatchResult>(
        matcher_, *setup_.execution, PixelArray(left, order, "left"),
        PixelArray(right, order, "right"),
        Wanted{.right = right_disparity, .confidence = confidence});
  }

  /// Option → value.
  [[nodiscard]] py::dict options() {
    apps::Settings settings("", "");
    apps::add_reference_setting(settings, setup_.options);
    apps::add_match_settings(settings, setup_.options);
    const apps::SettingValue values = settings.values();
    py::dict result;
    for (const auto& [name, value] : values.items()) {
      std::string keyword = name;
      std::replace(keyword.begin(), keyword.end(), '-', '_');
      result[keyword.c_str()] = to_python(value);
    }
    return result;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format(
        "<vantage.Matcher: {}, disparities {}>", setup_.options.chosen(),
        setup_.options.disparities_auto ? "auto" : apps::to_text(setup_.options.disparities));
  }
  [[nodiscard]] int threads() const { return setup_.execution->executor().thread_count(); }

 private:
  MatchSetup setup_;
  PairMatcher matcher_;
};

/// A getter whose arrays keep the result alive.
template <typename Get>
auto with_owner(const Get& get) {
  return
      [get](const py::object& self) { return std::invoke(get, self.cast<MatchResult&>(), self); };
}

}  // namespace

void bind_matcher(py::module_& module) {
  py::class_<MatchResult>(module, "MatchResult")
      .def_property_readonly("disparity", with_owner(&MatchResult::disparity))
      .def_property_readonly("disparity_y", with_owner(&MatchResult::disparity_y))
      .def_property_readonly("right_disparity", with_owner(&MatchResult::right_disparity))
      .def_property_readonly("confidence", with_owner(&MatchResult::confidence))
      .def_property_readonly("unmatched", &MatchResult::unmatched)
      .def_property_readonly("right_unmatched", &MatchResult::right_unmatched)
      .def_property_readonly("disparities", &MatchResult::disparities)
      .def("preview", &MatchResult::preview);
  py::class_<Matcher>(module, "Matcher")
      .def(py::init<const py::dict&>())
      .def("compute", &Matcher::compute, py::arg("left"), py::arg("right"), py::arg("bgr"),
           py::arg("right_disparity"), py::arg("confidence"))
      .def("options", &Matcher::options)
      .def("__repr__", &Matcher::text)
      .def_property_readonly("threads", &Matcher::threads);
}

}  // namespace vantage::python
