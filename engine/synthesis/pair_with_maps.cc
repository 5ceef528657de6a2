#include "engine/synthesis/pair_with_maps.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/rectification/rows/row_check.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/rectification/rows/row_remarks.h"

namespace vantage {

void follow_corrected_rows(const RowField& field, Execution& execution, PairWithMaps& pair) {
  if (pair.unrectified) {
    Photograph corrected;
    correct_photograph(pair.unrectified->right, field, pair.unrectified->rectifier, corrected,
                       execution);
    pair.unrectified->right = std::move(corrected);
  }
  bring_to_corrected_rows(field, pair.maps.right, execution);
}

std::optional<RowField> correct_pair(bool expects_negative, Execution& execution,
                                     PairWithMaps& pair, std::vector<Remark>& remarks) {
  const RowCheck check = check_rows(pair.left, pair.right, &execution);
  std::ranges::move(
      row_remarks(check, {.is_corrected = check.pays(), .expects_negative = expects_negative}),
      std::back_inserter(remarks));
  if (!check.pays()) {
    return std::nullopt;
  }
  const RowField& field = check.rows->field;
  Photograph corrected;
  correct_rows(pair.right, field, corrected, execution);
  pair.right = std::move(corrected);
  follow_corrected_rows(field, execution, pair);
  return field;
}

}  // namespace vantage
