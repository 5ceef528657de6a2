#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <new>
#include <string>
#include <utility>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/image/stereo_packing.h"
#include "engine/image/white_level.h"
#include "engine/io/images/black_border.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/library/handles.h"
#include "engine/library/pictures.h"
#include "engine/library/vantage_c.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/synthesis/view_renderer.h"

namespace vantage {
namespace {

std::string& last_error() {
  thread_local std::string text;
  return text;
}

/// Runs `body`; what it throws becomes a status and a text.
template <typename Body>
vantage_status guarded(const Body& body) noexcept {
  try {
    try {
      body();
      return VANTAGE_OK;
    } catch (const UsageError& error) {
      last_error() = error.what();
      return VANTAGE_USAGE;
    } catch (const std::bad_alloc& error) {
      last_error() = error.what();
      return VANTAGE_NO_MEMORY;
    } catch (const std::exception& error) {
      last_error() = printable(error.what());
      return VANTAGE_ERROR;
    }
  } catch (...) {  // no memory for the text
    last_error().clear();
    return VANTAGE_NO_MEMORY;
  }
}

void require(const void* pointer, const char* name) {
  if (pointer == nullptr) {
    throw UsageError(fmt::format("{} is NULL, expected an address", name));
  }
}

void match_pair(const vantage_matcher& matcher, vantage_pair& result) {
  const MatcherOptions& options = matcher.options;
  Execution& execution = *matcher.execution;
  PairWithMaps& pair = result.pair;
  require_equal_shapes(pair.left, pair.right);
  Photograph* const both[] = {&pair.left, &pair.right};
  result.remarks = scale_to_white_level(both, options.white_level);
  leave_out(pair.left, black_border(pair.left));
  leave_out(pair.right, black_border(pair.right));
  if (options.rows == RowMode::kAuto && !options.match.disparities_y) {
    result.rows =
        correct_pair(expects_negative_disparities(options.match), execution, pair, result.remarks);
  }
  MatchReport report;
  matcher.matcher->match(pair.left, pair.right, {}, pair.maps, &report);
  std::ranges::move(report.remarks, std::back_inserter(result.remarks));
}

const DisparityMaps& probabilities_of(const vantage_pair& pair) {
  std::call_once(pair.has_probabilities, [&] {
    const scheduler::SharedThreads::Call call(pair.execution->threads());
    DisparityMaps maps;
    pair.matcher->match(pair.pair.left, pair.pair.right, {.probability = true}, maps);
    pair.probabilities.left.confidence = std::move(maps.left.confidence);
    pair.probabilities.right.confidence = std::move(maps.right.confidence);
  });
  return pair.probabilities;
}

void require_side(vantage_side side) {
  if (side != VANTAGE_LEFT && side != VANTAGE_RIGHT) {
    throw UsageError(fmt::format("side is {}, expected 0 or 1", static_cast<int>(side)));
  }
}

/// Writes the values of one image's map in the pixels of the image that the caller gave.
void write_values(const vantage_pair& pair, const DisparityMaps& maps, vantage_side side,
                  Image<float> MatchedMap::*values, const vantage_picture* picture) {
  const MatchedMap& map = side == VANTAGE_LEFT ? maps.left : maps.right;
  if (side == VANTAGE_LEFT || !pair.rows) {
    write_map(map.*values, picture);
    return;
  }
  MatchedMap moved;
  moved.*values = (map.*values).copy();
  bring_to_given_rows(*pair.rows, moved, *pair.execution);
  write_map(moved.*values, picture);
}

}  // namespace
}  // namespace vantage

using namespace vantage;  // NOLINT(google-build-using-namespace): whose calls these functions are

const char* vantage_version(void) { return VANTAGE_VERSION; }

const char* vantage_last_error(void) { return last_error().c_str(); }

vantage_status vantage_matcher_create(const char* const* options, size_t count,
                                      vantage_matcher** matcher) {
  return guarded([&] {
    require(matcher, "matcher");
    std::vector<std::string_view> texts;
    for (std::size_t i = 0; i < count; ++i) {
      require(options, "options");
      require(options[i], "an option");
      texts.emplace_back(options[i]);
    }
    leave_opencv_to_host();
    const MatcherOptions parsed(texts);
    auto execution = std::make_shared<Execution>(parsed.execution);
    *matcher = new vantage_matcher{
        parsed, execution,
        std::make_shared<const PairMatcher>(parsed.match, *execution, RowMode::kAsIs)};
  });
}

void vantage_matcher_destroy(vantage_matcher* matcher) { delete matcher; }

vantage_status vantage_match(const vantage_matcher* matcher, const vantage_image* left,
                             const vantage_image* right, vantage_pair** pair) {
  return guarded([&] {
    require(matcher, "matcher");
    require(pair, "pair");
    auto result = std::make_unique<vantage_pair>();
    result->execution = matcher->execution;
    result->matcher = matcher->matcher;
    result->synthesis = matcher->options.synthesis;
    result->pair.left = photograph_of(left, "left");
    result->pair.right = photograph_of(right, "right");
    const scheduler::SharedThreads::Call call(matcher->execution->threads());
    match_pair(*matcher, *result);
    *pair = result.release();
  });
}

void vantage_pair_destroy(vantage_pair* pair) { delete pair; }

vantage_status vantage_pair_disparity(const vantage_pair* pair, vantage_side side,
                                      const vantage_picture* map) {
  return guarded([&] {
    require(pair, "pair");
    require_side(side);
    write_values(*pair, pair->pair.maps, side, &MatchedMap::disparity_px, map);
  });
}

vantage_status vantage_pair_confidence(const vantage_pair* pair, vantage_side side,
                                       const vantage_picture* map) {
  return guarded([&] {
    require(pair, "pair");
    require_side(side);
    write_values(*pair, probabilities_of(*pair), side, &MatchedMap::confidence, map);
  });
}

vantage_status vantage_pair_view(const vantage_pair* pair, double x, double y,
                                 const vantage_picture* view) {
  return guarded([&] {
    require(pair, "pair");
    const BaselinePosition position{x, y};
    const scheduler::SharedThreads::Call call(pair->execution->threads());
    const ViewRenderer renderer(pair->pair, pair->synthesis, std::nullopt, *pair->execution);
    renderer.check({position});
    RenderedView rendered;
    renderer.render(position, rendered);
    write_photograph(rendered.picture(false), view);
  });
}

const char* vantage_pair_remark(const vantage_pair* pair, size_t index, int* is_warning) {
  if (pair == nullptr || index >= pair->remarks.size()) {
    return nullptr;
  }
  const Remark& remark = pair->remarks[index];
  if (is_warning != nullptr) {
    *is_warning = remark.is_warning() ? 1 : 0;
  }
  return remark.text.c_str();
}
