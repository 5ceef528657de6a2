#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "engine/refinement/refinement_options.h"

namespace vantage {

/// Help text of the option of a field of MethodParameters or RefinementOptions.
struct OptionText {
  std::string_view option;
  /// Number: "PX", or "PX|on" with a word that stands for a value; bool: the words for true and
  /// false. Enumerations use their own names.
  std::string_view value_name;
  std::string_view help;
  std::string_view automatic = "{}";  ///< what `auto` stands for; {}: the default of the struct
  double word_value = 0;              ///< value of a number's word
};

inline constexpr std::array kOptionTexts = {
    OptionText{"cost", "", "Measure of how different two pixels are"},
    OptionText{"colour", "",
               "Compare colour images by luma, or by the mean of the costs of their channels"},
    OptionText{"truncation", "T",
               "With cost truncated: maximum difference in grey levels, above 0"},
    OptionText{"sigma-measurement", "S",
               "With cost contaminated, aggregation bayes or certainty entropy: standard deviation "
               "of the noise, above 0, in the unit of the cost (grey levels; with census costs, "
               "differing neighbours)",
               "{}; with cost gradient and certainty entropy a quarter of the gradient filter's "
               "response to a slope of one grey level per pixel"},
    OptionText{"epsilon-measurement", "E",
               "With cost contaminated or aggregation bayes: share of outliers, above "
               "0 and below 1"},
    OptionText{"census-thresholds", "N",
               "With cost census-rays: number of thresholds that each neighbour is compared with: "
               "1 (the centre pixel) or 3 (also 1.25 grey levels below and above: slower, better "
               "where texture is as weak as noise)"},
    OptionText{"alpha", "A",
               "With cost gradient: weight of the difference of the gradients, at least 0"},
    OptionText{"gradient-components", "",
               "With cost gradient: compare gradients, or only their components along rows, which "
               "no edge along the rows misleads"},
    OptionText{"norm", "", "With cost gradient and gradient-components xy: norm of the gradients"},
    OptionText{"gradient", "",
               "With cost gradient: derivative filter; its gain scales --confidence-threshold"},
    OptionText{"prefilter", "gaussian|none",
               "With cost gradient: smooth the images first with a Gaussian of 0.5 px"},
    OptionText{"aggregate", "", "How costs are aggregated over neighbouring pixels"},
    OptionText{"window", "PX", "With box: side of the square window, odd, 1 to 181"},
    OptionText{"border", "",
               "With box: clip windows at the image border, or use whole windows only"},
    OptionText{"aggregation-sigma", "PX",
               "With gaussian or box-cascade: standard deviation, 0.5 to 16"},
    OptionText{
        "iterations", "N",
        "With diffusion, membrane, local-stopping or bayes: number of iterations, 0 to 10000"},
    OptionText{"levels", "N",
               "Number of pyramid levels of the coarse-to-fine search, 1 (full size only) to 10; "
               "each level halves width and height and has its own iterations"},
    OptionText{
        "search-size", "",
        "With bayes, several levels, prior-smoothing maximum and cost census-rays with one "
        "threshold: search all disparities in images of half or a quarter of the size, then "
        "8 to 16 around what was found; auto: full size for up to 16 disparities, half for up to "
        "128, else quarter"},
    OptionText{"candidate-blocks", "K",
               "With bayes, several levels and prior-smoothing maximum: search only K blocks of 16 "
               "disparities, 1 to 8, around what the coarser level found; 0: search all"},
    OptionText{"pruned-levels", "N",
               "Number of finest levels on which --candidate-blocks limits the search, 1 to 10"},
    OptionText{
        "window-levels", "N",
        "With bayes, several levels, prior-smoothing maximum and cost census-rays: 1: the "
        "finest level searches 8 to 16 disparities around what the coarser level found, in place "
        "of --candidate-blocks; 0, or images of several cameras: it does not"},
    OptionText{"final-iterations", "N",
               "With several levels: number of iterations on the finest one, 0 to 10000",
               "as --iterations"},
    OptionText{"lambda", "L",
               "With diffusion, membrane or local-stopping: step size, above 0 and below 0.25; "
               "membrane: at most 1/(4 + beta)"},
    OptionText{"beta", "B", "With membrane: pull towards the initial costs, at least 0"},
    OptionText{"certainty", "",
               "With local-stopping: measure of certainty that must not decrease: the winner's "
               "margin or the negative entropy"},
    OptionText{"mu", "M", "With bayes: weight of the neighbours, above 0, at most 1"},
    OptionText{
        "prior", "",
        "With bayes: what is expected of the disparities of neighbours: to be similar, or of "
        "another surface (contaminated-gaussian); to be equal, or of another surface "
        "(impulse: for surfaces that face the cameras); to be similar everywhere (quadratic: "
        "no depth edges; slower, without --window-levels, --candidate-blocks and "
        "--search-size)"},
    OptionText{
        "sigma-prior", "S",
        "With bayes and a prior other than impulse: standard deviation of the disparity difference "
        "of neighbours in pixels, above 0"},
    OptionText{
        "epsilon-prior", "E",
        "With bayes and a prior other than quadratic: probability that a neighbour is on another "
        "surface, above 0 and below 1; larger: disparity jumps cost less"},
    OptionText{"prior-growth", "G",
               "With bayes and several levels: factor by which --sigma-prior grows with each "
               "coarser level, 1 to 4"},
    OptionText{"prior-smoothing", "",
               "With bayes: combine the probabilities of a neighbour's disparities by their sum "
               "(sum-product, the book's) or their maximum (max-product, several times faster, the "
               "presets')"},
    OptionText{"level-weight", "W",
               "With bayes and several levels: costs of a coarse pixel are W times the sum of the "
               "four it covers, above 0, at most 1; smaller: coarse levels decide less"},
    OptionText{"slant-penalty",
               "C|none",
               "With bayes and several levels: surfaces may slant within a coarse pixel; what a "
               "difference of one pixel of disparity costs there, as -ln p, at least 0: less for "
               "repetitive texture on slanted surfaces; none: coarse pixels face the cameras",
               {},
               std::numeric_limits<double>::infinity()},
    OptionText{"edge-weight", "W",
               "With bayes and the diffusions: weight of neighbours across strong intensity "
               "edges, 0 to 1; 1: edges do not matter"},
    OptionText{"edge-contrast", "C",
               "With bayes and the diffusions: intensity difference in grey levels over which the "
               "weight falls to --edge-weight, above 0"},
    OptionText{"edge-diffusion", "N",
               "With bayes and the diffusions: number of steps by which intensities are diffused "
               "along with the support, one per iteration, before edges are looked for: small "
               "differences fade, strong edges stay (Perona and Malik), 0 to 1000"},
    OptionText{
        "selection", "",
        "Selection of disparities from the aggregated costs. winner: the best one of each "
        "pixel; scanline: those of each row together, by dynamic programming; symmetric: those "
        "of a row of both images together, pixels matched one to one or not at all"},
    OptionText{"jump-limit", "C|none",
               "With selection scanline: maximum cost of a change of disparity between neighbours "
               "in a row, in the unit of the aggregated costs, at least 0; none: no maximum",
               "by cost: {}", std::numeric_limits<double>::infinity()},
    OptionText{"jump-penalty", "C",
               "With selection scanline: cost of a change per pixel of disparity, at least 0",
               "a quarter of --jump-limit: {}"},
    OptionText{"candidate-step", "PX",
               "Distance of neighbouring candidates: 1, 0.5 or 0.25 pixels of disparity; between "
               "pixels the other image is interpolated (time and memory grow accordingly)"},
    OptionText{"occlusion-penalty", "C",
               "With selection symmetric: cost of a pixel without a match, in the unit of the "
               "aggregated costs, above 0",
               "by cost: {}"},
    OptionText{"subpixel", "",
               "Sub-pixel disparities by a parabola through the costs, or those of the candidates"},
    OptionText{
        "edge-snapping", "PX|on",
        "Move disparity edges to intensity edges up to PX columns away, 0 (off) to 16; on: 4", "{}",
        4},
    OptionText{"cross-check", "PX|none",
               "Pixels whose left and right disparities differ by PX or more count as unmatched, "
               "at least 1; none: no check",
               "number of candidates / 15, at least 1"},
    OptionText{"confidence-threshold", "X|none",
               "Pixels whose confidence (see --confidence of match) is X or less count as "
               "unmatched; none: no threshold",
               "0 with cost gradient, else none", kNoConfidenceThreshold},
    OptionText{"speckle-size", "PX", "Matched regions of fewer than PX pixels count as unmatched"},
    OptionText{"surface-fit", "PX|on",
               "Smooth matched pixels by planes fitted to the matched pixels up to PX away, 0 "
               "(off) to 16; on: 10",
               "{}", 10},
    OptionText{
        "surface-fit-step", "PX",
        "With surface fit: 1: a plane for each pixel; 2: for each block of 2x2 pixels, which "
        "is faster"},
    OptionText{"fill", "",
               "Value of unmatched pixels. constant: disparity of the background beside them; "
               "linear: interpolated where both sides nearly agree, else constant; median: median "
               "of similar pixels around; planes: as median, and the band at the border that the "
               "other image never shows by planes; surfaces: as planes, and what the other image "
               "does not show by the surfaces around, where these agree; canonical: regions "
               "without texture interpolated between their ends, other pixels as median; "
               "thin-plate: the same, continuing slopes; none: unknown"},
    OptionText{
        "uniform-contrast", "C",
        "With fill canonical and thin-plate: a region has no texture if neighbouring columns "
        "differ by at most C grey levels on average, at least 0"},
};

/// First option and title of each group of a method's options.
inline constexpr std::array<std::pair<std::string_view, const char*>, 3> kOptionGroups = {
    {{"cost", "Matching: cost"},
     {"aggregate", "Matching: aggregation"},
     {"selection", "Matching: selection"}}};

}  // namespace vantage
