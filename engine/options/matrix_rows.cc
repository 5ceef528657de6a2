#include "engine/options/matrix_rows.h"

namespace vantage {

SettingValue rows_of(const Eigen::Matrix3d& matrix) {
  SettingValue rows = SettingValue::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2)});
  }
  return rows;
}

}  // namespace vantage
