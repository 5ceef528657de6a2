#include "engine/sequence/pairs/frame_pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <numeric>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "engine/error.h"
#include "engine/order_statistics.h"
#include "engine/sequence/pairs/frame_keys.h"
#include "engine/sequence/pairs/frame_numbering.h"

namespace vantage {
namespace {

constexpr double kHalfFrame = 0.5;
constexpr double kRounding = 1e-3;  ///< of times, in frames
constexpr std::size_t kListed = 4;

/// Frames of the left camera and of another one that belong together, in the order of the left one.
using Partners = std::vector<std::pair<int, int>>;

/// What was found of two cameras; no partners: nothing.
struct Found {
  Partners partners = {};
  std::vector<double> numbers = {};  ///< of the names of both cameras, if they count
  std::vector<std::string> notes = {};
};

bool is_film(const FrameSource& source) { return !source.video_file().empty(); }

std::vector<double> steps_of(std::vector<double> values) {
  std::ranges::sort(values);
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[i - 1]) {
      steps.push_back(values[i] - values[i - 1]);
    }
  }
  return steps;
}

/// From frame to frame: the usual one of times, the smallest of numbers; infinite for one frame.
double step_of(const std::vector<double>& values, bool are_times) {
  std::vector<double> steps = steps_of(values);
  return steps.empty() ? std::numeric_limits<double>::infinity()
         : are_times   ? upper_median(steps)
                       : std::ranges::min(steps);
}

std::vector<int> sorted_places(const std::vector<double>& values) {
  std::vector<int> places(values.size());
  std::iota(places.begin(), places.end(), 0);
  std::ranges::stable_sort(places, {}, [&](int i) { return values[static_cast<std::size_t>(i)]; });
  return places;
}

/// Every value of the left camera with the nearest one of the right camera, if that is at most
/// `max_apart` from it, and no other is nearer to that.
Partners nearest(const std::vector<double>& left, const std::vector<double>& right, double shift,
                 double max_apart) {
  const std::vector<int> lefts = sorted_places(left);
  const std::vector<int> rights = sorted_places(right);
  const auto apart = [&](std::size_t l, std::size_t r) {
    return l < lefts.size() && r < rights.size()
               ? std::abs(right[static_cast<std::size_t>(rights[r])] - shift -
                          left[static_cast<std::size_t>(lefts[l])])
               : std::numeric_limits<double>::infinity();
  };
  const double rounding = kRounding * max_apart;
  Partners partners;
  for (std::size_t l = 0, r = 0; l < lefts.size() && r < rights.size();) {
    const double here = apart(l, r);
    const bool left_is_before = left[static_cast<std::size_t>(lefts[l])] <
                                right[static_cast<std::size_t>(rights[r])] - shift;
    const bool next_is_nearer =
        left_is_before ? apart(l + 1, r) < here - rounding : apart(l, r + 1) < here - rounding;
    if (here <= max_apart + rounding && !next_is_nearer) {
      partners.emplace_back(lefts[l++], rights[r++]);
    } else {
      (left_is_before ? l : r) += 1;
    }
  }
  std::ranges::sort(partners);
  return partners;
}

/// How much more the right one's values are than those of the left one.
double shift_of(const std::vector<double>& left, const std::vector<double>& right, int offset,
                bool are_times) {
  const std::vector<double>& counted = offset > 0 ? right : left;
  return offset == 0 ? 0
                     : std::ranges::min(right) - std::ranges::min(left) +
                           offset * step_of(counted, are_times);
}

Found by_numbers(const std::vector<double>& left, const std::vector<double>& right, int offset,
                 bool are_times) {
  const double step = std::min(step_of(left, are_times), step_of(right, are_times));
  const double max_apart = !are_times || !std::isfinite(step) ? 0 : kHalfFrame * step;
  return {.partners = nearest(left, right, shift_of(left, right, offset, are_times), max_apart)};
}

Partners equal_texts(const std::vector<std::string>& left, const std::vector<std::string>& right) {
  std::unordered_map<std::string_view, int> place;
  for (std::size_t i = 0; i < right.size(); ++i) {
    place.emplace(right[i], static_cast<int>(i));
  }
  Partners partners;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (const auto partner = place.find(left[i]); partner != place.end()) {
      partners.emplace_back(static_cast<int>(i), partner->second);
    }
  }
  return partners;
}

Found by_names(const FrameSource& left, const FrameSource& right, int offset, bool times_only) {
  const auto left_files = left.files();
  const auto right_files = right.files();
  const auto read = [&](NameReading reading, bool as_times) {
    const FrameKeys l = frame_keys(left_files, reading);
    const FrameKeys r = frame_keys(right_files, reading);
    const bool are_times = times_only || (l.are_times && r.are_times);
    if (!l.numbers.empty() && !r.numbers.empty() && (are_times || !as_times)) {
      Found found = by_numbers(l.numbers, r.numbers, offset, are_times);
      if (!are_times && offset == 0) {
        std::ranges::copy(l.numbers, std::back_inserter(found.numbers));
        std::ranges::copy(r.numbers, std::back_inserter(found.numbers));
      }
      return found;
    }
    return as_times || offset != 0 ? Found() : Found{.partners = equal_texts(l.texts, r.texts)};
  };
  // Of time stamps with a name before them, some may be equal by chance.
  Found found = read(NameReading::kDifference, true);
  for (const NameReading reading : kNameReadings) {
    if (found.partners.empty()) {
      found = read(reading, times_only);
    }
  }
  return found;
}

/// Of a film that knows its FrameSource::start(), when its frames are shown.
std::vector<double> times_s(const FrameSource& film, double start_s) {
  const std::optional<FrameTimes> times = film.frame_times();
  const double length_s = 1 / film.frame_rate()->per_second();
  std::vector<double> found;
  for (int i = 0; i < film.frame_count(); ++i) {
    found.push_back(start_s + (times ? times->seconds(i) : i * length_s));
  }
  return found;
}

Found by_times_of_films(const FrameSource& left, const FrameSource& right, int offset) {
  const FilmStart left_start = *left.start();
  const FilmStart right_start = *right.start();
  const bool have_one_clock = left_start.has_clock == right_start.has_clock;
  const std::vector<double> l = times_s(left, have_one_clock ? left_start.seconds : 0);
  const std::vector<double> r = times_s(right, have_one_clock ? right_start.seconds : 0);
  Found found = by_numbers(l, r, offset, true);
  const double later_s = r.front() - l.front();
  const double frame_s = std::min(step_of(l, true), step_of(r, true));
  const bool are_late = std::isfinite(frame_s) && std::abs(later_s) > 0.1 * frame_s;
  if (!found.partners.empty() && (are_late || left.frame_rate() != right.frame_rate())) {
    found.notes.push_back(fmt::format(
        "the right film starts {:.3f} s {} the left one and has {} frames a second, the left one "
        "{}: frames are paired by {}",
        std::abs(later_s), later_s < 0 ? "before" : "after", to_string(*right.frame_rate()),
        to_string(*left.frame_rate()),
        offset == 0 ? "the time at which they are shown" : "the offset and the rates"));
  }
  return found;
}

/// "left/3.png, left/7.png and 5 others".
std::string list_of(const FrameSource& source, const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < std::min(frames.size(), kListed); ++i) {
    text += (i == 0 ? "" : ", ") + source.describe(frames[i]);
  }
  return frames.size() <= kListed ? text
                                  : text + fmt::format(" and {} others", frames.size() - kListed);
}

std::string name_of_camera(std::size_t camera) {
  return camera == 0 ? "left" : camera == 1 ? "right" : fmt::format("camera {}", camera + 1);
}

/// Frames that are in no pair, without those at its ends that an offset leaves there.
std::vector<int> left_out_of(const FrameSource& source, std::vector<int> paired,
                             int offset_at_start, int offset_at_end) {
  std::ranges::sort(paired);
  std::vector<int> all(static_cast<std::size_t>(source.frame_count()));
  std::iota(all.begin(), all.end(), 0);
  std::vector<int> left_out;
  std::ranges::set_difference(all, paired, std::back_inserter(left_out));
  std::erase_if(left_out, [&](int frame) {
    return frame < std::min(offset_at_start, paired.front()) ||
           frame > std::max(source.frame_count() - 1 - offset_at_end, paired.back());
  });
  return left_out;
}

/// The pairs of the left camera with each other one, put together.
FramePairing together(const std::vector<const FrameSource*>& cameras, std::vector<Found> found,
                      int offset, PairBy by) {
  FramePairing pairing{.found = {.by = by}};
  pairing.frames.resize(cameras.size());
  std::vector<std::unordered_map<int, int>> partner_of(found.size());
  for (std::size_t k = 1; k < found.size(); ++k) {
    partner_of[k] = {found[k].partners.begin(), found[k].partners.end()};
  }
  for (const auto& [left, right] : found.front().partners) {
    const int frame = left;
    if (std::ranges::all_of(partner_of.begin() + 1, partner_of.end(),
                            [&](const auto& partners) { return partners.contains(frame); })) {
      pairing.frames[0].push_back(left);
      pairing.frames[1].push_back(right);
      for (std::size_t k = 1; k < found.size(); ++k) {
        pairing.frames[k + 1].push_back(partner_of[k].at(frame));
      }
    }
  }
  pairing.count = static_cast<int>(pairing.frames[0].size());
  if (pairing.count == 0) {
    throw Error("no frame has a partner in the sequences of all cameras");
  }
  for (Found& one : found) {
    std::ranges::move(one.notes, std::back_inserter(pairing.remarks));
  }
  std::string counts;
  std::string lists;
  int left_out_of_all = 0;
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const int at_start = k == 0 ? -offset : k == 1 ? offset : 0;
    const std::vector<int> left_out = left_out_of(
        *cameras[k], pairing.frames[k], std::max(0, at_start), k < 2 ? std::max(0, -at_start) : 0);
    const int count = static_cast<int>(left_out.size());
    pairing.found.left_out.push_back(count);
    left_out_of_all += count;
    if (count > 0) {
      counts += fmt::format("{}{} of the {}", counts.empty() ? "" : ", ", count, name_of_camera(k));
      lists += (lists.empty() ? "" : ", ") + list_of(*cameras[k], left_out);
    }
  }
  if (left_out_of_all > 0) {
    pairing.remarks.push_back(fmt::format("{} frame{} left out without a partner ({}): {}",
                                          left_out_of_all, left_out_of_all == 1 ? " is" : "s are",
                                          counts, lists));
  }
  if (!found.front().numbers.empty()) {
    const auto missing = numbers_missing_on_both(std::move(found.front().numbers));
    std::ranges::copy(missing, std::back_inserter(pairing.remarks));
  }
  return pairing;
}

std::string counted(const FrameSource& source) {
  const int frames = source.frame_count();
  return fmt::format(
      "{} {} ({})", frames, frames == 1 ? "frame" : "frames",
      frames == 1 ? source.describe(0) : source.describe(0) + " to " + source.describe(frames - 1));
}

[[noreturn]] void fail_to_pair(const FrameSource& left, const FrameSource& right,
                               std::string_view problem) {
  throw Error(
      fmt::format("{}: {} on the left, {} on the right; expected names or times that tell "
                  "which belong together, or `pair-by` order",
                  problem, counted(left), counted(right)));
}

/// What tells nothing of which frames belong together.
FramePairing in_order_if_sure(const std::vector<const FrameSource*>& cameras, int offset,
                              bool are_films) {
  const FrameSource& left = *cameras[0];
  const FrameSource& right = *cameras[1];
  FramePairing pairing = pair_in_order(cameras, offset);
  const std::string_view what = are_films ? "the films share no time" : "the names share nothing";
  if (!pairing.found.is_whole()) {
    fail_to_pair(left, right, fmt::format("{} and the numbers of frames differ", what));
  }
  if (numbers_shift({left, pairing.first[0], pairing.count},
                    {right, pairing.first[1], pairing.count})) {
    fail_to_pair(left, right, fmt::format("{} and other numbers are missing on each side", what));
  }
  if (pairing.count > 1) {
    pairing.remarks.push_back(fmt::format("{}: frames are paired in their order", what));
  }
  return pairing;
}

}  // namespace

FramePairing pair_frames(const std::vector<const FrameSource*>& cameras, int offset_frames,
                         std::optional<PairBy> by) {
  const auto films =
      std::ranges::count_if(cameras, [](const FrameSource* source) { return is_film(*source); });
  const bool all_films = films == std::ssize(cameras);
  const bool know_times = std::ranges::all_of(
      cameras, [](const FrameSource* source) { return source->start().has_value(); });
  if (by == PairBy::kName && films > 0) {
    throw UsageError("pair-by is name, but frames of films have none; expected time or order");
  }
  if (by == PairBy::kTime && films > 0 && !know_times) {
    throw Error("pair-by is time, but it is not known when each frame is shown; expected order");
  }
  const bool are_single_images = std::ranges::all_of(
      cameras, [](const FrameSource* source) { return source->frame_count() == 1; });
  if (by == PairBy::kOrder ||
      (!by && (films > 0 ? !all_films || !know_times : are_single_images))) {
    return pair_in_order(cameras, offset_frames);
  }
  std::vector<Found> found;
  for (std::size_t k = 1; k < cameras.size(); ++k) {
    const int offset = k == 1 ? offset_frames : 0;
    found.push_back(all_films ? by_times_of_films(*cameras[0], *cameras[k], offset)
                              : by_names(*cameras[0], *cameras[k], offset, by == PairBy::kTime));
    if (found.back().partners.empty()) {
      if (by) {
        fail_to_pair(*cameras[0], *cameras[k],
                     by == PairBy::kTime ? "no frames are of one time" : "the names share nothing");
      }
      return in_order_if_sure(cameras, offset_frames, all_films);
    }
  }
  return together(cameras, std::move(found), offset_frames,
                  all_films ? PairBy::kTime : by.value_or(PairBy::kName));
}

}  // namespace vantage
