#pragma once

#include <filesystem>
#include <vector>

#include "engine/evaluation/book_experiments.h"

namespace vantage::apps {

// Each writes what its experiment found to `folder`, which exists. Throw Error.

/// noise.csv; noise-mean-absolute.svg, noise-rms.svg, noise-bad.svg: one chart per pair, one curve
/// per algorithm (Figs. 6.16, 6.17).
void write_noise_files(const std::filesystem::path& folder, const std::vector<ExperimentRun>& runs);

/// iterations.csv; iterations.svg: errors against iterations; iterations-maps.png: the disparity
/// maps, one row per algorithm (Fig. 6.10).
void write_iteration_files(const std::filesystem::path& folder,
                           const std::vector<ExperimentRun>& runs);

/// support.csv; support.svg: sections of the membrane's impulse response after some iterations and
/// of the inverse Fourier transform of (6.12); support-shape.svg: the latter as a surface (Fig.
/// 6.9). Returns the largest difference between the two after the most iterations.
double write_support_files(const std::filesystem::path& folder);

}  // namespace vantage::apps
