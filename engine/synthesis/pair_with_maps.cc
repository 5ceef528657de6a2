#include "engine/synthesis/pair_with_maps.h"

#include <utility>

#include "engine/rectification/rows/row_correction.h"

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

}  // namespace vantage
