#include "engine/view_geometry/colmap_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <system_error>

#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/file_bytes.h"
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
  constexpr std::string_view kBlanks = " \t\r";
  std::string_view rest = line;
  rest.remove_prefix(static_cast<std::size_t>(last_word.data() + last_word.size() - line.data()));
  const std::size_t first = rest.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return rest.substr(first, rest.find_last_not_of(kBlanks) - first + 1);
}

/// Lines of points may be missing in files made by hand.
bool is_line_of_points(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  return words.size() % 3 == 0 && std::ranges::all_of(words, [](std::string_view word) {
           return finite_number(word).has_value();
         });
}

ColmapImage image_of(std::string_view line, const TextLines& lines,
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

/// COLMAP's pixel centres are at halves.
constexpr double kHalf = 0.5;

std::string camera_line(const SizedCamera& sized) {
  const Camera& camera = sized.camera;
  const bool is_fisheye = camera.lens == LensKind::kFisheye;
  const std::size_t coefficients = camera.is_without_distortion()  ? 0
                                   : camera.distortion.size() <= 4 ? 4
                                                                   : 8;
  if (!camera.is_without_distortion() && camera.distortion.size() > 8) {
    throw Error(fmt::format("the lens has {} coefficients, expected at most 8 in a COLMAP model",
                            camera.distortion.size()));
  }
  std::string line = fmt::format("1 {} {} {}",
                                 coefficients == 0   ? "PINHOLE"
                                 : is_fisheye        ? "OPENCV_FISHEYE"
                                 : coefficients == 4 ? "OPENCV"
                                                     : "FULL_OPENCV",
                                 sized.size.width_px, sized.size.height_px);
  const Eigen::Matrix3d& k = camera.matrix;
  for (const double value : {k(0, 0), k(1, 1), k(0, 2) + kHalf, k(1, 2) + kHalf}) {
    line += fmt::format(" {}", value);
  }
  for (std::size_t i = 0; i < coefficients; ++i) {
    line += fmt::format(" {}", i < camera.distortion.size() ? camera.distortion[i] : 0.0);
  }
  return line + "\n";
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

std::vector<ColmapImage> parse_colmap_images(std::string_view text, const std::string& file,
                                             const std::map<long long, SizedCamera>& cameras) {
  TextLines lines(text, file);
  std::vector<ColmapImage> images;
  while (const auto line = lines.next_with_words()) {
    images.push_back(image_of(*line, lines, cameras));
    const auto points = lines.next();
    if (points && !is_line_of_points(*points)) {
      lines.put_back();
    }
  }
  std::ranges::sort(images, {}, &ColmapImage::name);
  const auto twice = std::ranges::adjacent_find(images, {}, &ColmapImage::name);
  if (twice != images.end()) {
    throw Error(fmt::format("{}: image '{}' is given twice", file, quotable(twice->name)));
  }
  return images;
}

std::vector<ColmapImage> read_colmap_model(const fs::path& folder) {
  const fs::path cameras = folder / "cameras.txt";
  const fs::path images = folder / "images.txt";
  std::error_code ignored;
  if (!fs::exists(cameras, ignored) && fs::exists(folder / "cameras.bin", ignored)) {
    throw Error(
        fmt::format("{}: holds a binary COLMAP model, expected cameras.txt and images.txt; "
                    "'colmap model_converter --output_type TXT' writes them",
                    folder.string()));
  }
  std::vector<ColmapImage> model =
      parse_colmap_images(read_file_text(images), images.string(),
                          parse_colmap_cameras(read_file_text(cameras), cameras.string()));
  if (model.empty()) {
    throw Error(fmt::format("{}: holds no images", images.string()));
  }
  return model;
}

void write_colmap_model(const std::filesystem::path& folder, const SizedCamera& camera,
                        std::span<const PosedImageName> images,
                        std::span<const PointTrack> points) {
  const LensModel lens(camera.camera);
  std::vector<std::string> seen(images.size());
  std::vector<int> counts(images.size());
  std::string point_lines = "# POINT3D_ID X Y Z R G B ERROR TRACK[] (IMAGE_ID POINT2D_IDX)\n";
  auto point_out = std::back_inserter(point_lines);
  long long number = 0;
  for (const PointTrack& point : points) {
    std::string track;
    for (const PointSighting& sighting : point.sightings) {
      const auto image = static_cast<std::size_t>(sighting.image);
      const auto pixel = lens.position_of(sighting.position_px / camera.camera.matrix(0, 0));
      if (!pixel) {
        continue;
      }
      seen[image] +=
          fmt::format("{:.3f} {:.3f} {} ", pixel->x() + kHalf, pixel->y() + kHalf, number + 1);
      track += fmt::format(" {} {}", image + 1, counts[image]++);
    }
    if (!track.empty()) {
      fmt::format_to(point_out, "{} {:.9g} {:.9g} {:.9g} 128 128 128 0{}\n", ++number,
                     point.point.x(), point.point.y(), point.point.z(), track);
    }
  }
  std::string image_lines =
      "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then X Y POINT3D_ID of its points\n";
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto& [name, pose] = images[i];
    if (name.find_first_of("\r\n") != std::string::npos) {
      throw Error(fmt::format("the name '{}' has a line break, expected none in a COLMAP model",
                              quotable(name)));
    }
    const Eigen::Quaterniond q(pose.rotation);
    const Eigen::Vector3d& t = pose.translation;
    image_lines += fmt::format("{} {} {} {} {} {} {} {} 1 {}\n{}\n", i + 1, q.w(), q.x(), q.y(),
                               q.z(), t.x(), t.y(), t.z(), name, seen[i]);
  }
  write_text_file(folder / "cameras.txt",
                  "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n" + camera_line(camera));
  write_text_file(folder / "images.txt", image_lines);
  write_text_file(folder / "points3D.txt", point_lines);
}

}  // namespace vantage
