#include "engine/combinations/rules.h"

// What does not go together in sequences, in lists of pairs, and in `vantage run`.

namespace vantage {
namespace {

constexpr CombinationScope kSequence = CombinationScope::kSequence;
constexpr CombinationScope kPairList = CombinationScope::kPairList;
constexpr CombinationScope kJob = CombinationScope::kJob;
constexpr CombinationScope kRun = CombinationScope::kRun;

constexpr Rule kSequenceRules[] = {
    {kSequence, "temporal-prior > 0", "search-size != full",
     "expected 0 with a reduced search-size (preset realtime)"},
    {kSequence, "reuse = frame", "baselines", "expected none with baselines"},
    {kSequence, "reuse = frame", "save posterior-mean | save posterior-variance",
     "expected none with moments of p(d)"},
    {kSequence, "search-range = shot | search-range = pair", "temporal-prior > 0 | reuse != none",
     "search-range is per shot or pair, expected film with temporal-prior or reuse, which pass "
     "disparities on"},
    {kSequence, "selection = symmetric", "baselines",
     "expected winner or scanline with baselines: a symmetric solution is of two images"},
    // Outputs.
    {kSequence, "save posterior-mean | save posterior-variance", "aggregate != bayes",
     "save has {name} with {chosen}, expected the aggregation bayes, which alone has p(d)"},
    {kSequence, "save posterior-mean | save posterior-variance", "search-size != full",
     "save has {name} with a reduced search-size (preset realtime), expected search-size full"},
    {kSequence, "save cyclopean | save cyclopean-occlusion", "selection != symmetric",
     "save has cyclopean or cyclopean-occlusion, expected them with selection symmetric only"},
    {kSequence, "save right-disparity | save right-unmatched", "reference = right",
     "save has {name} with reference right, expected disparity, which is the right map then"},
    // Photographs that are not rectified.
    {kSequence, "baselines", "unrectified",
     "baselines cannot be used with unrectified: a calibration is of two cameras"},
    {kSequence, "selection = symmetric", "unrectified",
     "selection symmetric cannot be used with unrectified: pixels of both photographs lie on "
     "different epipolar lines"},
    {kSequence, "save posterior-mean | save posterior-variance", "unrectified",
     "save posterior-mean and posterior-variance cannot be used with unrectified: candidates "
     "differ by fractions from pixel to pixel"},
    {kSequence, "save posterior-mean | save posterior-variance", "roi | scale < 1",
     "save has {name} with roi or scale, expected it of whole images only"},
    {kSequence, "roi | scale < 1", "unrectified",
     "{option} cannot be used with unrectified: epipolar lines are those of whole images"},
    {kSequence, "temporal-prior > 0", "unrectified",
     "temporal-prior cannot be used with unrectified: candidates differ by fractions from pixel to "
     "pixel"},
    {kSequence, "reuse != none", "unrectified",
     "reuse cannot be used with unrectified: tiles of rows are kept"},
    {kSequence,
     "save views | save holes | save sources | save stereo | save depth | save depth-resolution | "
     "save cloud | save mesh | save comfort",
     "unrectified = photographs",
     "save has {name} with unrectified, which belongs to rectified pixels, expected "
     "rectified-pixels too"},
};

constexpr Rule kRunRules[] = {
    // Views and films.
    {kJob, "stereo-views | stereo-packing", "unless save stereo",
     "no effect where --save has no stereo"},
    {kJob,
     "intensity-fit | warp | holes | soft-edges | gamma | gradient-limit | no-intensity-matching",
     "unless save views | save holes | save sources | save stereo",
     "no effect where --save has no views, holes, sources, stereo"},
    {kJob, "gamma | intensity-fit", "no-intensity-matching",
     "no effect with --no-intensity-matching"},
    {kJob, "temporal-threshold", "unless temporal-prior > 0 | reuse != none",
     "no effect without --temporal-prior and --reuse"},
    // Cameras.
    {kJob, "baselines | more", "unless left | resume",
     "--baselines has no effect without --left and --right"},
    {kJob, "search-size | window-levels", "baselines | more",
     "no effect with several images: all candidates are searched at full size"},
    {kJob, "tuning", "baselines | more", "no effect with several images: tuning is for pairs"},
    {kJob, "calibration", "baselines | more",
     "--calibration cannot be used with --baselines: it rectifies the images of two cameras only"},
    {kJob, "rectified-pixels", "unless unrectified", "no effect without --unrectified"},
    {kJob, "user rows = auto", "baselines",
     "rows auto cannot be used with baselines: only pairs are corrected"},
    {kJob, "rows", "unrectified", "no effect with --unrectified"},
    {kJob, "calibration", "unrectified",
     "--calibration and --unrectified are both given, expected one of them: both are of the "
     "cameras"},
    {kJob, "kept-outline > 0", "unless calibration | column calibration",
     "--kept-outline has no effect without --calibration"},
    {kJob, "kitti-cameras | lens", "unless calibration | unrectified | column calibration",
     "--{option} has no effect without --calibration"},
    {kJob, "user in-flight | user every | frames", "live",
     "--{option} cannot be used with --live: one frame is in flight, and the time decides which"},
    // A list of pairs whose columns say something of each pair.
    {kPairList, "kept-outline > 0", "unless calibration | column calibration",
     "--kept-outline has no effect without --calibration"},
    {kPairList, "kitti-cameras | lens", "unless calibration | unrectified | column calibration",
     "--{option} has no effect without --calibration"},
    {kPairList, "unrectified", "column calibration",
     "--unrectified cannot be used with a list of pairs with the column calibration: its file is "
     "of all pairs"},
    {kPairList, "view | save stereo", "column calibration",
     "--save views or stereo cannot be used with a list of pairs with the column calibration: a "
     "view is defined by one pair of cameras"},
    {kPairList, "temporal-prior > 0", "column min-disparity",
     "--temporal-prior cannot be used with a list of pairs with the column min-disparity: "
     "disparities are passed from frame to frame"},
    {kPairList, "reuse != none", "column min-disparity",
     "--reuse cannot be used with a list of pairs with the column min-disparity: disparities are "
     "passed from frame to frame"},
    {kPairList, "save depth-video = of the search", "column min-disparity",
     "--save depth-video without --depth-range MIN:MAX cannot be used with a list of pairs with "
     "the column min-disparity: its levels stand for one range"},
    {kPairList, "search-range = shot", "column min-disparity",
     "--search-range shot cannot be used with a list of pairs with the column min-disparity: the "
     "list has the ranges, expected --search-range film"},
    // Outputs.
    {kRun, "crf | no-sound", "unless video | save depth-video", "no effect without --video"},
    {kRun, "fps", "unless video | save depth-video | output = - | raw-video",
     "no effect without --video"},
    {kRun, "depth-range | depth-codec", "unless save depth-video",
     "no effect where --save has no depth-video"},
    {kRun, "format",
     "unless save disparity | save right-disparity | save confidence | save posterior-mean | "
     "save posterior-variance | save cyclopean | save depth-resolution",
     "no effect where --save has no disparity, right-disparity, confidence, posterior-mean, "
     "posterior-variance, cyclopean, depth-resolution"},
    {kRun, "reference",
     "unless save disparity | save confidence | save unmatched | save preview | "
     "save posterior-mean | save posterior-variance | save depth | save depth-resolution | "
     "save cloud | save mesh | save depth-video | save comfort",
     "no effect where --save has no disparity, confidence, unmatched, preview, posterior-mean, "
     "posterior-variance, depth, depth-resolution, cloud, mesh, depth-video, comfort"},
    {kRun, "depth-format", "unless save depth", "no effect where --save has no depth"},
    {kRun, "disparity-resolution", "unless save depth-resolution",
     "no effect where --save has no depth-resolution"},
    {kRun, "baseline | focal-length | principal-point | doffs | calibration-unit",
     "unless save depth | save depth-resolution | save cloud | save mesh",
     "no effect where --save has no depth, depth-resolution, cloud, mesh"},
    {kRun, "max-depth", "unless save depth | save cloud | save mesh",
     "no effect where --save has no depth, cloud, mesh"},
    {kRun,
     "cloud-step | cloud-min-confidence | cloud-confidence | cloud-filled | cloud-outlines | "
     "cloud-gradient-limit | poses",
     "unless save cloud | save mesh", "no effect where --save has no cloud, mesh"},
    {kRun, "preview-range", "unless save preview", "no effect where --save has no preview"},
    // Streams are there once.
    {kRun, "resume | force", "stream",
     "--{option} is given, but the input is a stream, which cannot be read again; --overwrite "
     "starts again"},
    {kRun, "shard", "stream",
     "--shard is given and the input is a stream, expected a file: a stream is read once"},
    {kRun, "search-range = shot | preview-range = shot | depth-range = shot | intensity-fit = shot",
     "stream",
     "--{option} is shot and the input is a stream, expected another value: it needs all frames of "
     "a shot "
     "before the first; store the stream in a file"},
    {kRun, "resume | force | shard", "live",
     "--{option} cannot be used with --live: what was dropped does not come again"},
    {kRun, "video | save depth-video", "live",
     "--{option} cannot be used with --live: a video of fewer frames would run too fast; pipe -o - "
     "to ffmpeg with -use_wallclock_as_timestamps 1"},
    {kRun, "raw-video", "unless stream", "no effect without a stream as input, such as --stereo -"},
    {kRun, "stream-format", "unless output = -", "no effect without --output -"},
    {kRun,
     "resume | overwrite | force | shard | video | crf | no-sound | depth-codec | "
     "format",
     "output = -", "no effect with --output -"},
    // The run.
    {kRun, "search-range = shot", "user disparities",
     "search-range is shot, expected film with a range in --disparities"},
    {kRun, "search-range = pair", "user disparities",
     "search-range is pair, expected film with a range in --disparities"},
    {kRun, "search-range = pair", "unless pairs",
     "search-range is pair, expected it with --pairs only: pairs of a sequence have one range"},
    {kRun, "user search-range = shot", "memory",
     "search-range is shot, expected film with --memory, which plans for one range"},
    {kRun, "search-range = shot", "memory",
     "--memory plans for one range of disparities, but each shot of a film is searched in its own; "
     "expected --search-range film too, or a range in --disparities"},
    {kRun, "tuning", "no-tuning", "no effect with --no-tuning"},
    {kRun, "tuning", "memory", "no effect with --memory, for which the cost model plans"},
    {kRun, "tuning | no-tuning", "unrectified",
     "no effect with --unrectified: tuning is for rectified pairs"},
    {kRun, "no-rectification-check | already-rectified", "unrectified",
     "no effect with --unrectified"},
    {kRun, "rows", "no-rectification-check", "no effect where rows are not looked at"},
    {kRun, "overwrite", "resume", "--overwrite and --resume are both given, expected one of them"},
    {kRun, "overwrite", "force", "--overwrite and --force are both given, expected one of them"},
    {kRun, "overwrite", "shard",
     "--overwrite with --shard would remove what other shards have done; remove the folder first, "
     "or use another one"},
};

}  // namespace

std::span<const Rule> sequence_rules() { return kSequenceRules; }
std::span<const Rule> run_rules() { return kRunRules; }

}  // namespace vantage
