// Pairs of a sequence, matched one after the other.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/pair_source_settings.h"
#include "engine/sequence/sequence_range.h"
#include "engine/vantage.h"
#include "python/calls.h"
#include "python/matcher.h"
#include "python/options.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

/// The pairs of an input, rectified, with the range of all of them. Thread rule: one thread at a
/// time.
class Sequence {
 public:
  Sequence(const std::optional<StereoCalibration>& calibration, double kept_outline,
           py::dict keywords) {
    setup_.execution = &take_execution(keywords);
    PairSourceOptions input;
    apps::Settings settings("", "");
    apps::add_pair_source_settings(settings, input);
    apps::add_reference_setting(settings, setup_.options);
    apps::add_match_settings(settings, setup_.options);
    set_options(settings, keywords);
    setup_.options.validate();
    input.validate();
    const RectificationOptions rectification{kept_outline};
    rectification.validate();
    if (setup_.options.disparities_y) {
      throw UsageError("disparities-y cannot be used with sequences: rows only");
    }
    without_gil([&] { open(input, calibration, rectification); });
    matcher_ = std::make_unique<PairMatcher>(setup_.options, *setup_.execution);
  }

  [[nodiscard]] int count() const { return pairs_->pair_count(); }
  void skip_to(int index) { pairs_->skip_to(index); }

  /// (index, name, left, right, result) of the next pair; None at the end.
  py::object next() {
    std::pair<Photograph, Photograph> images;
    FramePair pair;
    const bool is_there = without_gil([&] {
      if (!pairs_->fetch(pair)) {
        return false;
      }
      pairs_->decode(pair);
      rectify(pair);
      return true;
    });
    if (!is_there) {
      return py::none();
    }
    images = {copy_of(pair.left), copy_of(pair.right)};
    auto result = std::make_unique<MatchResult>(
        *matcher_, *setup_.execution, MatchedImages(std::move(pair.left), std::move(pair.right)),
        Wanted());
    return py::make_tuple(pair.index, pairs_->describe(pair.index),
                          array_of(std::move(images.first), ChannelOrder::kRgb),
                          array_of(std::move(images.second), ChannelOrder::kRgb),
                          py::cast(std::move(result)));
  }

 private:
  static Photograph copy_of(const Photograph& photograph) {
    return std::visit([](const auto& image) { return Photograph{image.copy()}; },
                      photograph.pixels);
  }

  void open(const PairSourceOptions& input, const std::optional<StereoCalibration>& calibration,
            const RectificationOptions& rectification) {
    pairs_ = open_pair_source(input);
    if (pairs_->pair_count() == 0) {
      throw Error("the sequence has no pair of frames");
    }
    if (calibration) {
      FramePair first;
      pairs_->fetch(first);
      pairs_->decode(first);
      pairs_->skip_to(0);
      rectifier_.emplace(*calibration, first.left.width(), first.left.height(), rectification);
    }
    if (setup_.options.disparities_auto) {
      setup_.options.disparities = require_disparity_range(find_sequence_range(
          *pairs_, [&](FramePair& pair) { rectify(pair); }, *setup_.execution));
      setup_.options.disparities_auto = false;
      setup_.options.validate();
    }
  }

  void rectify(FramePair& pair) const {
    if (!rectifier_ || !rectifier_->needs_rectification()) {
      return;
    }
    for (const Side side : {Side::kLeft, Side::kRight}) {
      Photograph& image = side == Side::kLeft ? pair.left : pair.right;
      Photograph rectified;
      rectifier_->apply(image, side, rectified, *setup_.execution);
      image = std::move(rectified);
    }
  }

  MatchSetup setup_;
  std::unique_ptr<PairSource> pairs_;
  std::optional<Rectifier> rectifier_;
  std::unique_ptr<PairMatcher> matcher_;
};

}  // namespace

void bind_sequence(py::module_& module) {
  py::class_<Sequence>(module, "Sequence")
      .def(py::init<const std::optional<StereoCalibration>&, double, py::dict>())
      .def("next", &Sequence::next)
      .def("skip_to", &Sequence::skip_to)
      .def("__len__", &Sequence::count);
}

}  // namespace vantage::python
