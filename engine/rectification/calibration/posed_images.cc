#include "engine/rectification/calibration/posed_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/files/text_lines.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr long long kMaxSide = 1000000;
constexpr long long kMaxNumber = std::numeric_limits<long long>::max();

struct LensName {
  std::string_view name;
  std::size_t parameters;  ///< of the file
  bool has_one_focal_length;
  LensKind kind = LensKind::kStandard;
};

constexpr std::array kLensModels = {LensName{"SIMPLE_PINHOLE", 3, true},
                                    LensName{"PINHOLE", 4, false},
                                    LensName{"SIMPLE_RADIAL", 4, true},
                                    LensName{"RADIAL", 5, true},
                                    LensName{"OPENCV", 8, false},
                                    LensName{"FULL_OPENCV", 12, false},
                                    LensName{"OPENCV_FISHEYE", 8, false, LensKind::kFisheye},
                                    LensName{"SIMPLE_RADIAL_FISHEYE", 4, true, LensKind::kFisheye},
                                    LensName{"RADIAL_FISHEYE", 5, true, LensKind::kFisheye}};

const LensName& lens_model(std::string_view name, const TextLines& lines) {
  const auto* found =
      std::ranges::find_if(kLensModels, [&](const LensName& lens) { return lens.name == name; });
  if (found == kLensModels.end()) {
    lines.fail(fmt::format(
        "the camera model is '{}', expected SIMPLE_PINHOLE, PINHOLE, "
        "SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV, OPENCV_FISHEYE, SIMPLE_RADIAL_FISHEYE "
        "or RADIAL_FISHEYE",
        quotable(name)));
  }
  return *found;
}

Camera camera_of(const LensName& lens, std::vector<double> values) {
  if (lens.has_one_focal_length) {
    values.insert(values.begin(), values.front());
  }
  Camera camera;
  camera.lens = lens.kind;
  camera.matrix(0, 0) = values[0];
  camera.matrix(1, 1) = values[1];
  camera.matrix(0, 2) = values[2] - 0.5;
  camera.matrix(1, 2) = values[3] - 0.5;
  camera.distortion.assign(values.begin() + 4, values.end());
  if (!camera.distortion.empty() && camera.distortion.size() < 4) {
    camera.distortion.resize(4);  // radial only
  }
  return camera;
}

/// The rest of a line after so many words, without blanks around it: a name may hold blanks.
std::string_view rest_after(std::string_view line, std::string_view last_word) {
  constexpr std::string_view kAroundNames = " \t\r";
  std::string_view rest = line;
  rest.remove_prefix(static_cast<std::size_t>(last_word.data() + last_word.size() - line.data()));
  const std::size_t first = rest.find_first_not_of(kAroundNames);
  if (first == std::string_view::npos) {
    return {};
  }
  return rest.substr(first, rest.find_last_not_of(kAroundNames) - first + 1);
}

/// Lines of points may be missing in files made by hand.
bool is_line_of_points(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  return words.size() % 3 == 0 && std::ranges::all_of(words, [](std::string_view word) {
           return finite_number(word).has_value();
         });
}

PosedImage image_of(std::string_view line, const TextLines& lines,
                    const std::map<long long, SizedCamera>& cameras) {
  constexpr std::size_t kWordsBeforeName = 9;
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() <= kWordsBeforeName) {
    lines.fail(fmt::format("holds {} values, expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME",
                           words.size()));
  }
  (void)lines.whole_number(words[0], "IMAGE_ID", 0, kMaxNumber);
  std::array<double, 7> numbers{};
  constexpr std::array kNames = {"QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = lines.number(words[i + 1], kNames[i]);
  }
  const auto rotation = rotation_of_quaternion({numbers[0], numbers[1], numbers[2], numbers[3]});
  if (!rotation) {
    lines.fail("the quaternion QW QX QY QZ does not have length 1");
  }
  const long long number = lines.whole_number(words[8], "CAMERA_ID", 0, kMaxNumber);
  const auto camera = cameras.find(number);
  if (camera == cameras.end()) {
    lines.fail(fmt::format("CAMERA_ID is {}, expected a camera of cameras.txt", number));
  }
  return {.name = std::string(rest_after(line, words[8])),
          .camera = camera->second,
          .pose = {.rotation = *rotation, .translation = {numbers[4], numbers[5], numbers[6]}}};
}

}  // namespace

std::map<long long, SizedCamera> parse_colmap_cameras(std::string_view text,
                                                      const std::string& file) {
  TextLines lines(text, file);
  std::map<long long, SizedCamera> cameras;
  while (const auto line = lines.next_with_words()) {
    const std::vector<std::string_view> words = words_of(*line);
    if (words.size() < 4) {
      lines.fail(fmt::format("holds {} values, expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS",
                             words.size()));
    }
    const long long number = lines.whole_number(words[0], "CAMERA_ID", 0, kMaxNumber);
    const LensName& lens = lens_model(words[1], lines);
    SizedCamera camera;
    camera.size.width_px = static_cast<int>(lines.whole_number(words[2], "WIDTH", 1, kMaxSide));
    camera.size.height_px = static_cast<int>(lines.whole_number(words[3], "HEIGHT", 1, kMaxSide));
    if (words.size() != 4 + lens.parameters) {
      lines.fail(fmt::format("{} has {} parameters, expected {}", lens.name, words.size() - 4,
                             lens.parameters));
    }
    std::vector<double> values;
    for (std::size_t i = 4; i < words.size(); ++i) {
      values.push_back(lines.number(words[i], fmt::format("parameter {}", i - 3)));
    }
    camera.camera = camera_of(lens, std::move(values));
    try {
      camera.camera.validate(fmt::format("camera {}", number));
    } catch (const Error& error) {
      lines.fail(error.what());
    }
    if (!cameras.emplace(number, std::move(camera)).second) {
      lines.fail(fmt::format("camera {} is given twice", number));
    }
  }
  return cameras;
}

std::vector<PosedImage> parse_colmap_images(std::string_view text, const std::string& file,
                                            const std::map<long long, SizedCamera>& cameras) {
  TextLines lines(text, file);
  std::vector<PosedImage> images;
  while (const auto line = lines.next_with_words()) {
    images.push_back(image_of(*line, lines, cameras));
    const auto points = lines.next();
    if (points && !is_line_of_points(*points)) {
      lines.put_back();
    }
  }
  std::ranges::sort(images, {}, &PosedImage::name);
  const auto twice = std::ranges::adjacent_find(images, {}, &PosedImage::name);
  if (twice != images.end()) {
    throw Error(fmt::format("{}: image '{}' is given twice", file, quotable(twice->name)));
  }
  return images;
}

std::vector<PosedImage> read_colmap_model(const fs::path& folder) {
  const fs::path cameras = folder / "cameras.txt";
  const fs::path images = folder / "images.txt";
  if (!is_there(cameras) && is_there(folder / "cameras.bin")) {
    throw Error(
        fmt::format("{}: holds a binary COLMAP model, expected cameras.txt and images.txt; "
                    "'colmap model_converter --output_type TXT' writes them",
                    folder.string()));
  }
  std::vector<PosedImage> model =
      parse_colmap_images(read_file_text(images), images.string(),
                          parse_colmap_cameras(read_file_text(cameras), cameras.string()));
  if (model.empty()) {
    throw Error(fmt::format("{}: holds no images", images.string()));
  }
  return model;
}

}  // namespace vantage
