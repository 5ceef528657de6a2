#include <limits>

#include "engine/combinations/rules.h"

// What does not go together in a method, in the options of a match, and in `vantage match`.

namespace vantage {
namespace {

constexpr CombinationScope kMethod = CombinationScope::kMethod;
constexpr CombinationScope kMatch = CombinationScope::kMatch;
constexpr CombinationScope kReuse = CombinationScope::kReuse;
constexpr double kNoPenalty = std::numeric_limits<double>::infinity();

constexpr std::string_view kNeedsOfReducedSearch =
    "search-size is not full, expected full: a reduced search-size needs a search along rows, "
    "aggregation bayes, levels above 1, prior-smoothing maximum, a prior other than quadratic, "
    "selection winner, candidate-step 1, and cost census-rays with one threshold and colour luma";

constexpr Rule kMatchRules[] = {
    // Candidates of fine levels are pruned.
    {kMethod, "candidate-blocks > 0", "levels = 1",
     "expected 0 with a single level: candidates are chosen by the winners of a coarser level", 0},
    {kMethod, "candidate-blocks > 0", "aggregate != bayes",
     "expected 0 unless aggregation is bayes: for energies, candidates that were not searched have "
     "no value that is neutral to their neighbours",
     0},
    {kMethod, "candidate-blocks > 0", "cost = gradient",
     "expected 0 with the cost gradient: its likelihoods compare a candidate with the best of all",
     0},
    {kMethod, "candidate-blocks > 0", "prior-smoothing = sum",
     "expected 0 with prior-smoothing sum: pruning needs prior-smoothing maximum", 0},
    {kMethod, "candidate-blocks > 0", "prior = quadratic",
     "expected 0 with prior quadratic: it is unbounded, so unsearched candidates have no finite "
     "cost",
     0},
    {kMethod, "candidate-blocks > 0", "selection != winner",
     "expected 0 with selection {with}: a path along a row needs the costs of all candidates", 0},
    // Fine levels search windows of candidates.
    {kMethod, "final-iterations = 0", "search-size != full",
     "expected at least 1 with a reduced search-size, whose full-size candidates need them"},
    {kMethod, "window-levels > 0", kObstaclesOfWindows,
     "expected 0; a search in windows needs aggregation bayes, levels above 1, prior-smoothing "
     "maximum, a prior other than quadratic, selection winner, candidate-step 1 and cost "
     "census-rays of luma",
     0},
    {kMethod, "window-levels > 0", "final-iterations = 0",
     "final-iterations is 0, expected at least 1 with window-levels above 0", 0},
    {kMatch, "window-levels > 0", "user candidate-blocks | user pruned-levels", "", 0},
    {kMethod, "certainty = margin", "cost = gradient",
     "certainty margin divides by the sum of a pixel's costs, which for the cost gradient have "
     "both signs; expected certainty entropy"},

    {kMatch, "method", "preset",
     "method and preset are both set, expected one of them: a preset has a method"},
    // Components of displacements: whole pixels, each alone.
    {kMatch, "candidate-step < 1", "disparities-y",
     "expected 1 with disparities-y: displacements are of whole pixels"},
    {kMatch, "candidate-blocks > 0", "disparities-y",
     "expected 0 with disparities-y: blocks are of candidates along rows", 0},
    {kMatch, "selection != winner", "disparities-y",
     "expected winner with disparities-y: paths are along rows"},
    {kMatch, "window-levels > 0", "disparities-y",
     "expected 0 with disparities-y: windows are of candidates along rows", 0},
    {kMatch, "slant-penalty < inf", "disparities-y",
     "expected none with disparities-y: surfaces slant along one range only", kNoPenalty},
    {kMatch, "edge-snapping > 0", "disparities-y",
     "expected 0 with disparities-y: it moves discontinuities of horizontal disparities only"},
    {kMatch, "cross-check = on", "selection = symmetric",
     "expected none with selection symmetric: both maps are of one solution", 0},
    {kMatch, "candidate-step < 1", "selection = symmetric",
     "expected 1 with selection symmetric: it matches whole pixels"},
    // Images are searched in reduced size.
    {kMatch, "search-size != full", "disparities-y", kNeedsOfReducedSearch, 0},
    {kMatch, "search-size != full", kObstaclesOfReducedSearch, kNeedsOfReducedSearch, 0},
    {kMatch, "edge-snapping > 0", "search-size != full",
     "expected 0 with a reduced search-size: maps are enlarged along the image's edges instead"},
    // Refinement that nothing reads; see also raw_rules().
    {kMatch, "user cross-check PX", "cross-check = none",
     "a number of pixels for cross-check is set but has no effect with cross-check none"},
    {kMatch, "user uniform-contrast != 1",
     "fill = constant | fill = linear | fill = median | fill = planes | fill = surfaces | fill = "
     "none",
     "{option} is set but has no effect with a fill other than canonical and thin-plate"},
    {kMatch, "user surface-fit-step > 1", "surface-fit = 0",
     "{option} is set but has no effect with surface-fit 0"},

    {kReuse, "reuse = frame", "levels = 1 | aggregate != bayes",
     "expected none with a method without coarse levels of Bayesian diffusion"},
    {kReuse, "reuse = frame", "disparities-y", "expected none with disparities-y"},
    {kReuse, "reuse = frame", "selection != winner",
     "expected none with a selection other than winner"},
    {kReuse, "reuse = frame", "candidate-step < 1", "expected none with candidates between pixels"},
};

constexpr CombinationScope kMatchJob = CombinationScope::kMatchJob;

constexpr Rule kMatchJobRules[] = {
    // Photographs that are not rectified.
    {kMatchJob, "rectified-pixels", "unless unrectified", "no effect without --unrectified"},
    {kMatchJob, "tuning | no-tuning", "unrectified",
     "no effect with --unrectified: tuning is for rectified pairs"},
    {kMatchJob, "no-rectification-check | rows", "unrectified", "no effect with --unrectified"},
    // Rows of the right image.
    {kMatchJob, "rows", "no-rectification-check | disparities-y",
     "no effect where rows are not looked at"},
    {kMatchJob, "user rows = auto", "baselines | more",
     "--rows auto cannot be used with --baselines: only pairs are corrected"},
    {kMatchJob, "baselines | more", "unrectified",
     "--baselines cannot be used with --unrectified: a calibration is of two cameras"},
    {kMatchJob, "vertical", "unrectified",
     "--vertical cannot be used with --unrectified: the calibration says where the cameras are"},
    {kMatchJob, "disparities-y", "unrectified",
     "--disparities-y cannot be used with --unrectified: epipolar lines are known"},
    {kMatchJob, "selection = symmetric", "unrectified",
     "--selection symmetric cannot be used with --unrectified: pixels of both photographs lie on "
     "different epipolar lines"},
    {kMatchJob, "calibration | focal-length", "unrectified",
     "--{option} cannot be used with --unrectified: depths belong to rectified pixels, which "
     "--calibration alone makes"},
    {kMatchJob, "volume", "unrectified",
     "--volume cannot be used with --unrectified: candidates differ by fractions from pixel to "
     "pixel"},
    {kMatchJob, "roi | scale < 1", "unrectified",
     "--{option} cannot be used with --unrectified: epipolar lines are those of whole images"},
    {kMatchJob, "posterior-mean | posterior-variance", "unrectified",
     "--posterior-mean and --posterior-variance cannot be used with --unrectified: candidates "
     "differ by fractions from pixel to pixel"},
    // Several images of cameras on one line.
    {kMatchJob, "search-size | window-levels", "baselines | more",
     "no effect with several images: all candidates are searched at full size"},
    {kMatchJob, "tuning", "baselines | more", "no effect with several images: tuning is for pairs"},
    {kMatchJob, "reference = right", "baselines | more",
     "--reference right cannot be used with --baselines: the first image is the reference"},
    {kMatchJob, "output-right | unmatched-right", "baselines | more",
     "--{option} cannot be used with --baselines: only the first image has a map"},
    {kMatchJob, "disparities-y", "baselines | more",
     "--disparities-y cannot be used with --baselines: cameras on one line have no vertical "
     "disparities"},
    // Outputs.
    {kMatchJob, "output-right", "reference = right",
     "--output-right cannot be used with --reference right: --output belongs to the right map"},
    {kMatchJob, "unmatched-right", "reference = right",
     "--unmatched-right cannot be used with --reference right: --unmatched belongs to the right "
     "map"},
    {kMatchJob, "tuning", "no-tuning", "no effect with --no-tuning"},
    {kMatchJob, "disparity-resolution", "unless depth-resolution | report",
     "no effect without --depth-resolution and --report"},
    {kMatchJob, "kept-outline", "unless calibration", "no effect without --calibration"},
    {kMatchJob, "kitti-cameras | lens", "unless calibration | unrectified",
     "no effect without --calibration"},
    {kMatchJob, "volume-kind | volume-level | volume-rows", "unless volume",
     "no effect without --volume"},
    {kMatchJob, "posterior-variance | posterior-mean", "aggregate != bayes",
     "--{option} cannot be used with {chosen}: only the aggregation bayes has p(d)"},
    {kMatchJob, "posterior-variance | posterior-mean", "disparities-y",
     "--{option} cannot be used with --disparities-y: p is one of displacements"},
    {kMatchJob, "volume | posterior-variance | posterior-mean", "roi | scale < 1",
     "--{option} cannot be used with --roi and --scale: it is of whole images"},
    {kMatchJob, "cyclopean | cyclopean-occlusion", "selection != symmetric | baselines | more",
     "--{option} is given, expected it with --selection symmetric only"},
};

}  // namespace

std::span<const Rule> match_rules() { return kMatchRules; }
std::span<const Rule> match_job_rules() { return kMatchJobRules; }

}  // namespace vantage
