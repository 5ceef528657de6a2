#include <algorithm>

#include "engine/image/grey_levels.h"
#include "engine/matching/costs/cost_planes.h"
#include "engine/matching/costs/image_gradient.h"
#include "engine/matching/costs/stage_cost.h"
#include "kernels/census/census.h"
#include "kernels/combined_cost/fixed_planes.h"
#include "kernels/evidence/evidence.h"
#include "kernels/pixel_cost/pixel_cost.h"

namespace vantage {
namespace {

/// Columns before and after the image.
struct Margins {
  int before = 0;
  int after = 0;
};

Margins margins_of(const kernels::CandidateGeometry& geometry) {
  // Lane i of column x is read at x + disparity_min + i, in the mirrored plane as in the plain one.
  // Kernels write whole vectors: up to a lane multiple past the last pixel that matters.
  return {std::max(kFilterMarginBefore, -geometry.disparity_min),
          std::max(kFilterMarginBehind,
                   geometry.disparity_min + geometry.lanes() + kernels::kLaneMultiple)};
}

template <typename T>
void resize(FeaturePlane<T>& plane, const CostImage::Planes& planes, Margins margins) {
  plane.plain.resize(planes.width, planes.height, margins.before, margins.after);
  if (planes.has_mirrored) {
    plane.mirrored.resize(planes.width, planes.height, margins.before, margins.after);
  }
}

void change_levels(const LevelChange& change, int width, float* levels) {
  if (change.is_none()) {
    return;
  }
  const auto gain = static_cast<float>(change.gain);
  const auto offset = static_cast<float>(change.offset);
  std::transform(levels, levels + width, levels,
                 [&](float level) { return gain * level + offset; });
}

void luma_row(const Photograph& photograph, const CostImage::Planes& planes, int y, float* levels) {
  grey_levels_row(photograph, y, levels);
  change_levels(planes.level_changes.luma, planes.width, levels);
}

/// The grey levels of one channel, or luma.
void level_row(const Photograph& photograph, const CostImage::Planes& planes, std::size_t channel,
               int y, float* levels) {
  if (planes.channels == 1) {
    luma_row(photograph, planes, y, levels);
    return;
  }
  channel_levels_row(photograph, static_cast<int>(channel), y, levels);
  change_levels(planes.level_changes.channels[channel], planes.width, levels);
}

/// Calls body(channel) for every channel.
template <typename Body>
void for_each_channel(const CostImage::Planes& planes, const Body& body) {
  for (int c = 0; c < planes.channels; ++c) {
    body(static_cast<std::size_t>(c));
  }
}

/// Calls body(channel, y) for every row of every channel, in parallel.
template <typename Body>
void for_each_row(const CostImage::Planes& planes, Execution& execution, const Body& body) {
  execution.for_each_band(planes.height, [&](int first_row, int end_row) {
    for_each_channel(planes, [&](std::size_t c) {
      for (int y = first_row; y < end_row; ++y) {
        body(c, y);
      }
    });
  });
}

void prepare_grey(const Photograph& photograph, Margins margins, Execution& execution,
                  CostImage::Planes& planes) {
  for_each_channel(planes, [&](std::size_t c) { resize(planes.features[c][0], planes, margins); });
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    FeaturePlane<float>& grey = planes.features[c][0];
    level_row(photograph, planes, c, y, grey.plain.row(y));
    grey.finish_row(planes.width, y, planes.has_mirrored);
  });
}

void prepare_sampling_bounds(Margins margins, Execution& execution, CostImage::Planes& planes) {
  for_each_channel(planes, [&](std::size_t c) {
    resize(planes.features[c][1], planes, margins);
    resize(planes.features[c][2], planes, margins);
  });
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    auto& [grey, least, most] = planes.features[c];
    kernels::sampling_bounds_row(grey.plain.row(y), planes.width, least.plain.row(y),
                                 most.plain.row(y));
    least.finish_row(planes.width, y, planes.has_mirrored);
    most.finish_row(planes.width, y, planes.has_mirrored);
  });
}

/// Grey levels that features are made of, but that are none themselves.
void prepare_levels(const Photograph& photograph, Execution& execution, CostImage::Planes& planes) {
  for_each_channel(planes, [&](std::size_t c) {
    planes.levels[c].resize(planes.width, planes.height, kFilterMarginBefore, kFilterMarginBehind);
  });
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    level_row(photograph, planes, c, y, planes.levels[c].row(y));
    planes.levels[c].fill_margins(y);
  });
}

void prepare_gradients(const MethodParameters& parameters, Margins margins, Execution& execution,
                       CostImage::Planes& planes) {
  const int width = planes.width;
  const int height = planes.height;
  for_each_channel(planes, [&](std::size_t c) {
    for (FeaturePlane<float>& plane : planes.features[c]) {
      resize(plane, planes, margins);
    }
    if (parameters.prefilter) {
      IntensityPlane<float>& smooth = planes.smooth_levels[c];
      smooth.resize(width, height, kFilterMarginBefore, kFilterMarginBehind);
      smooth_levels(planes.levels[c], width, height, execution, smooth);
    }
  });
  const auto alpha = static_cast<float>(parameters.alpha);
  const bool octagon = parameters.norm == GradientNorm::kOctagon;
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    const auto work = execution.scratch().lease(sizeof(float) * filter_work_floats(width));
    auto& [gx, gy, half_norm] = planes.features[c];
    gradient_row(parameters.prefilter ? planes.smooth_levels[c] : planes.levels[c], width, height,
                 y, parameters.gradient, reinterpret_cast<float*>(work.data()), gx.plain.row(y),
                 gy.plain.row(y));
    kernels::evidence_planes_row({gx.plain.row(y), gy.plain.row(y), half_norm.plain.row(y), width},
                                 alpha, octagon);
    for (FeaturePlane<float>& plane : planes.features[c]) {
      plane.finish_row(width, y, planes.has_mirrored);
    }
  });
}

using CodePlanes = std::array<FeaturePlane<std::uint32_t>, 2>;

void resize_codes(const CostImage::Planes& planes, Margins margins, CodePlanes& codes) {
  for (FeaturePlane<std::uint32_t>& half : codes) {
    resize(half, planes, margins);
  }
}

void code_row(const CostImage::Planes& planes, const IntensityPlane<float>& levels, int y,
              CodePlanes& codes) {
  kernels::CensusRows rows{};
  for (int v = -kernels::kCensusRadiusY; v <= kernels::kCensusRadiusY; ++v) {
    rows[static_cast<std::size_t>(v + kernels::kCensusRadiusY)] =
        levels.row(std::clamp(y + v, 0, planes.height - 1));
  }
  auto& [first_half, second_half] = codes;
  kernels::census_code_row(rows, planes.width, first_half.plain.row(y), second_half.plain.row(y));
  first_half.finish_row(planes.width, y, planes.has_mirrored);
  second_half.finish_row(planes.width, y, planes.has_mirrored);
}

void prepare_census(Margins margins, Execution& execution, CostImage::Planes& planes) {
  for_each_channel(planes, [&](std::size_t c) { resize_codes(planes, margins, planes.codes[c]); });
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    code_row(planes, planes.levels[c], y, planes.codes[c]);
  });
}

void prepare_fixed_levels(Margins margins, Execution& execution, CostImage::Planes& planes) {
  for_each_channel(planes, [&](std::size_t c) {
    for (FeaturePlane<std::uint16_t>& plane : planes.fixed_levels[c]) {
      resize(plane, planes, margins);
    }
  });
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    auto& [level, least, most] = planes.fixed_levels[c];
    kernels::fixed_levels_row(planes.levels[c].row(y), planes.width,
                              {level.plain.row(y), least.plain.row(y), most.plain.row(y)});
    for (FeaturePlane<std::uint16_t>& plane : planes.fixed_levels[c]) {
      plane.finish_row(planes.width, y, planes.has_mirrored);
    }
  });
}

void fixed_gradient_row(const CostImage::Planes& planes, const IntensityPlane<float>& levels, int y,
                        std::array<FeaturePlane<std::uint16_t>, 2>& gradients) {
  auto& [gx, gy] = gradients;
  kernels::fixed_gradient_row(levels.row(std::max(0, y - 1)), levels.row(y),
                              levels.row(std::min(planes.height - 1, y + 1)), planes.width,
                              gx.plain.row(y), gy.plain.row(y));
  gx.finish_row(planes.width, y, planes.has_mirrored);
  gy.finish_row(planes.width, y, planes.has_mirrored);
}

/// Grey levels of the channels, codes and gradients of luma.
void prepare_combined(const Photograph& photograph, const MethodParameters& parameters,
                      Margins margins, Execution& execution, CostImage::Planes& planes) {
  prepare_fixed_levels(margins, execution, planes);
  const bool has_census = parameters.sigma_census > 0;
  const bool has_gradient = parameters.sigma_gradient > 0;
  if (planes.channels > 1 && (has_census || has_gradient)) {
    planes.luma.resize(planes.width, planes.height, kFilterMarginBefore, kFilterMarginBehind);
    execution.for_each_band(planes.height, [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        luma_row(photograph, planes, y, planes.luma.row(y));
        planes.luma.fill_margins(y);
      }
    });
  }
  const IntensityPlane<float>& luma = planes.channels > 1 ? planes.luma : planes.levels[0];
  if (has_census) {
    resize_codes(planes, margins, planes.codes[0]);
  }
  for (FeaturePlane<std::uint16_t>& plane : planes.fixed_gradients) {
    if (has_gradient) {
      resize(plane, planes, margins);
    }
  }
  execution.for_each_band(planes.height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      if (has_census) {
        code_row(planes, luma, y, planes.codes[0]);
      }
      if (has_gradient) {
        fixed_gradient_row(planes, luma, y, planes.fixed_gradients);
      }
    }
  });
}

void prepare_ray_census(int thresholds, Margins margins, Execution& execution,
                        CostImage::Planes& planes) {
  const int bytes = kernels::ray_census_bytes(thresholds);
  for_each_channel(planes, [&](std::size_t c) {
    for (int p = 0; p < bytes; ++p) {
      resize(planes.ray_codes[c][static_cast<std::size_t>(p)], planes, margins);
    }
  });
  for_each_row(planes, execution, [&](std::size_t c, int y) {
    kernels::RayCensusRows rows{};
    for (int v = -kernels::kRayCensusRadius; v <= kernels::kRayCensusRadius; ++v) {
      rows[static_cast<std::size_t>(v + kernels::kRayCensusRadius)] =
          planes.levels[c].row(std::clamp(y + v, 0, planes.height - 1));
    }
    kernels::RayCensusCodes codes{};
    for (int p = 0; p < bytes; ++p) {
      const auto k = static_cast<std::size_t>(p);
      codes[k] = planes.ray_codes[c][k].plain.row(y);
    }
    kernels::ray_census_code_row(rows, planes.width, thresholds, codes);
    for (int p = 0; p < bytes; ++p) {
      planes.ray_codes[c][static_cast<std::size_t>(p)].finish_row(planes.width, y,
                                                                  planes.has_mirrored);
    }
  });
}

}  // namespace

CostImage::CostImage() : planes_(std::make_unique<Planes>()) {}
CostImage::CostImage(CostImage&&) noexcept = default;
CostImage& CostImage::operator=(CostImage&&) noexcept = default;
CostImage::~CostImage() = default;

void CostImage::prepare(const Photograph& photograph, const MethodParameters& parameters,
                        const kernels::CandidateGeometry& geometry, CostImageUse use,
                        Execution& execution) {
  Planes& planes = *planes_;
  planes.width = photograph.width();
  planes.height = photograph.height();
  planes.channels = parameters.colour == ColourUse::kChannels && photograph.channels() >= 3 ? 3 : 1;
  planes.has_mirrored = use.as_partner_of_left;
  planes.level_changes = use.level_changes;
  const Margins margins = margins_of(geometry);
  switch (parameters.cost) {
    case MatchCost::kSquared:
    case MatchCost::kAbsolute:
    case MatchCost::kTruncated:
    case MatchCost::kContaminated:
      prepare_grey(photograph, margins, execution, planes);
      break;
    case MatchCost::kBirchfieldTomasi:
      prepare_grey(photograph, margins, execution, planes);
      prepare_sampling_bounds(margins, execution, planes);
      break;
    case MatchCost::kGradient:
      prepare_levels(photograph, execution, planes);
      prepare_gradients(parameters, margins, execution, planes);
      break;
    case MatchCost::kCensus:
      prepare_levels(photograph, execution, planes);
      prepare_census(margins, execution, planes);
      break;
    case MatchCost::kRayCensus:
      prepare_levels(photograph, execution, planes);
      prepare_ray_census(parameters.census_thresholds, margins, execution, planes);
      break;
    case MatchCost::kCombined:
      prepare_levels(photograph, execution, planes);
      prepare_combined(photograph, parameters, margins, execution, planes);
      break;
  }
}

std::size_t CostImage::held_bytes() const {
  std::size_t bytes = 0;
  const auto add = [&bytes](const auto& planes) {
    for (const auto& plane : planes) {
      bytes += plane.plain.held_bytes() + plane.mirrored.held_bytes();
    }
  };
  for (std::size_t c = 0; c < planes_->features.size(); ++c) {
    add(planes_->features[c]);
    add(planes_->codes[c]);
    add(planes_->ray_codes[c]);
    add(planes_->fixed_levels[c]);
  }
  add(planes_->fixed_gradients);
  for (std::size_t c = 0; c < planes_->levels.size(); ++c) {
    bytes += planes_->levels[c].held_bytes() + planes_->smooth_levels[c].held_bytes();
  }
  return bytes + planes_->luma.held_bytes();
}

}  // namespace vantage
