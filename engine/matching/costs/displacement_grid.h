#pragma once

#include "kernels/candidates.h"

namespace vantage {

/// The candidates of a search in two dimensions (5.5.3): all pairs of a horizontal and a vertical
/// disparity. They form one column of cells, so that steps which compare or normalise the
/// candidates of a pixel see all of them: first the candidates of the minimum vertical disparity,
/// then those of the next one, without gaps.
struct DisplacementGrid {
  kernels::CandidateGeometry along_rows;  ///< horizontal disparities
  int disparity_y_min = 0;
  int rows = 1;    ///< vertical disparities
  int height = 0;  ///< of both images

  [[nodiscard]] int count() const { return rows * along_rows.count; }
  /// Geometry of the columns of cells for stages: only width, count and lanes are meaningful.
  [[nodiscard]] kernels::CandidateGeometry columns() const {
    return {along_rows.width, 0, count(), along_rows.direction};
  }
  /// Neighbourhood of candidates. Empty if the disparities of only one direction vary: then
  /// consecutive candidates are neighbours.
  [[nodiscard]] kernels::CandidatePlane plane() const {
    return rows > 1 && along_rows.count > 1 ? kernels::CandidatePlane{along_rows.count, rows}
                                            : kernels::CandidatePlane{};
  }
  /// The row of the other image that row y is compared with.
  [[nodiscard]] int partner_row(int y, int row) const {
    return y + along_rows.direction * (disparity_y_min + row);
  }
  /// Vertical disparities for which the partner of row y lies in rows [margin, height − margin) of
  /// the other image.
  [[nodiscard]] kernels::CandidateRange rows_with_partner(int y, int margin = 0) const {
    // Same computation as for columns, with the height as width.
    return kernels::CandidateGeometry{height, disparity_y_min, rows, along_rows.direction}
        .with_partner(y, margin);
  }
};

}  // namespace vantage
