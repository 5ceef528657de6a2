#include "engine/scene_graph/scene_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "engine/image/photograph.h"
#include "engine/rectification/rows/row_check.h"

namespace vantage {
namespace {

/// Neighbours from left to right: the vertices of one row of cameras.
using CameraRow = std::vector<int>;

std::vector<CameraRow> camera_rows(std::span<const SceneEdge> edges) {
  std::map<int, int> next;
  std::set<int> has_left;
  for (const SceneEdge& edge : edges) {
    // Two images share a right neighbour where rows of cameras are hardly apart: the first has it.
    if (!edge.is_vertical && edge.slope == 0 && has_left.insert(edge.second).second) {
      next.emplace(edge.first, edge.second);
    }
  }
  std::vector<CameraRow> rows;
  for (const auto& [first, second] : next) {
    if (!has_left.contains(first)) {
      rows.push_back({first});
      for (auto link = next.find(first); link != next.end(); link = next.find(link->second)) {
        rows.back().push_back(link->second);
      }
    }
  }
  return rows;
}

/// Looks at the images of one row of cameras.
class CameraRowCheck {
 public:
  CameraRowCheck(StoredScene& scene, std::span<const std::filesystem::path> files,
                 Execution& execution)
      : scene_(scene), files_(files), execution_(execution) {}

  /// How the rows of `image` differ from those of `neighbour`, if it pays to correct them.
  [[nodiscard]] std::optional<RowEstimate> compare(int neighbour, int image) const {
    const RowCheck check = check_rows(read(neighbour), read(image), &execution_);
    return check.pays() ? check.rows : std::nullopt;
  }

  /// The place in `row` of the image whose rows differ least from those of all; none where no two
  /// neighbours differ.
  [[nodiscard]] std::optional<std::size_t> reference_of(const CameraRow& row) const {
    std::vector<RowField::Terms> from_first(1, RowField::Terms{});
    bool differ = false;
    for (std::size_t k = 1; k < row.size(); ++k) {
      from_first.push_back(from_first.back());
      if (const auto rows = compare(row[k - 1], row[k])) {
        differ = true;
        for (std::size_t i = 0; i < from_first[k].size(); ++i) {
          from_first[k][i] += rows->field.coefficients_px()[i];
        }
      }
    }
    std::vector<double> differences;
    for (const RowField::Terms& one : from_first) {
      differences.push_back(0);
      for (RowField::Terms other : from_first) {
        std::ranges::transform(other, one, other.begin(), std::minus<>());
        differences.back() += RowField(scene_.width_px, scene_.height_px, other).rms_px();
      }
    }
    return differ ? std::optional<std::size_t>(std::ranges::min_element(differences) -
                                               differences.begin())
                  : std::nullopt;
  }

  void correct(int image, int neighbour, std::vector<CorrectedImage>& corrected) const {
    if (const auto rows = compare(neighbour, image)) {
      scene_.images[static_cast<std::size_t>(image)].rows = rows->field;
      corrected.push_back(
          {.vertex = image, .rows = *rows, .remark = remark_on(image, neighbour, *rows)});
    }
  }

 private:
  [[nodiscard]] const std::filesystem::path& file_of(int vertex) const {
    return files_[static_cast<std::size_t>(vertex)];
  }
  [[nodiscard]] Photograph read(int vertex) const {
    return scene_.read_image(file_of(vertex), vertex, execution_);
  }
  [[nodiscard]] Remark remark_on(int image, int neighbour, const RowEstimate& rows) const {
    constexpr std::string_view kOfPair = "right image";  // which may be the left one here
    return {.kind = Remark::Kind::kNote,
            .subject = "rows",
            .text = fmt::format("rows: {}{} beside {}; corrected, points agree to {:.2f} px",
                                file_of(image).filename().string(),
                                row_text(rows).substr(kOfPair.size()),
                                file_of(neighbour).filename().string(), rows.residual_px)};
  }

  StoredScene& scene_;
  std::span<const std::filesystem::path> files_;
  Execution& execution_;
};

}  // namespace

std::vector<CorrectedImage> correct_scene_rows(StoredScene& scene, std::span<const SceneEdge> edges,
                                               std::span<const std::filesystem::path> files,
                                               Execution& execution) {
  std::vector<CorrectedImage> corrected;
  const CameraRowCheck check(scene, files, execution);
  for (const CameraRow& row : camera_rows(edges)) {
    const std::optional<std::size_t> reference = check.reference_of(row);
    if (!reference) {
      continue;
    }
    for (std::size_t k = *reference; k-- > 0;) {
      check.correct(row[k], row[k + 1], corrected);
    }
    for (std::size_t k = *reference + 1; k < row.size(); ++k) {
      check.correct(row[k], row[k - 1], corrected);
    }
  }
  return corrected;
}

}  // namespace vantage
