#include "engine/sequence/sequence_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/io/disparity_io.h"

namespace vantage {
namespace {

constexpr int kMaxInFlight = 64;
constexpr double kMaxView = 16;

}  // namespace

bool SequenceOptions::saves(SequenceOutput output) const {
  return std::ranges::find(save, output) != save.end();
}

void SequenceOptions::validate() const {
  match.validate();
  synthesis.validate();
  if (match.disparities_y) {
    throw UsageError("disparities-y is set, expected none: sequences are of rectified pairs");
  }
  if (save.empty()) {
    throw UsageError("save is empty, expected at least one output");
  }
  if (saves(SequenceOutput::kViews) != !views_x.empty()) {
    throw UsageError(views_x.empty() ? "save has views but no view is given, expected --view XS"
                                     : "view is given but save has no views, expected both");
  }
  if (saves(SequenceOutput::kRightDisparity) && match.reference == Reference::kRight) {
    throw UsageError("save has right-disparity with reference right, where disparity is that map");
  }
  for (auto view = views_x.begin(); view != views_x.end(); ++view) {
    if (!(std::abs(*view) <= kMaxView)) {
      throw UsageError(fmt::format("view is {}, expected a number within ±{}", *view, kMaxView));
    }
    if (std::find(views_x.begin(), view, *view) != view) {
      throw UsageError(fmt::format("view {} is given twice", *view));
    }
  }
  if (!is_disparity_extension("map." + disparity_format)) {
    throw UsageError(
        fmt::format("format is '{}', expected pfm, png, tiff, exr or npy", disparity_format));
  }
  if (saves(SequenceOutput::kConfidence) && disparity_format == "png") {
    throw UsageError(
        "format is png, which holds no floats, but save has confidence; expected pfm, tiff, exr or "
        "npy");
  }
  if (in_flight && (*in_flight < 1 || *in_flight > kMaxInFlight)) {
    throw UsageError(
        fmt::format("in-flight is {}, expected a number from 1 to {}", *in_flight, kMaxInFlight));
  }
}

SequenceLayout::SequenceLayout(std::filesystem::path folder, const SequenceOptions& options)
    : folder_(std::move(folder)), save_(options.save), views_x_(options.views_x) {}

std::filesystem::path SequenceLayout::folder_of(SequenceOutput output, int view) const {
  switch (output) {
    case SequenceOutput::kDisparity:
      return folder_ / "disparity";
    case SequenceOutput::kRightDisparity:
      return folder_ / "right-disparity";
    case SequenceOutput::kConfidence:
      return folder_ / "confidence";
    case SequenceOutput::kUnmatched:
      return folder_ / "unmatched";
    case SequenceOutput::kPreview:
      return folder_ / "preview";
    case SequenceOutput::kViews:
      break;
  }
  return views_x_.size() == 1
             ? folder_ / "views"
             : folder_ / "views" / fmt::format("{}", views_x_[static_cast<std::size_t>(view)]);
}

std::vector<std::filesystem::path> SequenceLayout::folders() const {
  std::vector<std::filesystem::path> folders;
  for (const SequenceOutput output : save_) {
    const auto parts = output == SequenceOutput::kViews ? static_cast<int>(views_x_.size()) : 1;
    for (int part = 0; part < parts; ++part) {
      folders.push_back(folder_of(output, part));
    }
  }
  return folders;
}

std::filesystem::path SequenceLayout::file(SequenceOutput output, int frame,
                                           const std::string& extension, int view) const {
  return folder_of(output, view) / fmt::format("{:06}.{}", frame, extension);
}

}  // namespace vantage
