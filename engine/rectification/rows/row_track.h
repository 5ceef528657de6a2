#pragma once

#include <optional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rows/row_check.h"

namespace vantage {

/// How the rows of a sequence's pairs differ, over time.
struct RowTrack {
  struct Key {
    int pair = 0;  ///< of the source, counted from 0
    RowField field;
  };
  /// In the order of time: fields between two keys are interpolated, before the first and after the
  /// last they are those. Empty: rows are left as they are.
  std::vector<Key> keys;

  /// Needs keys.
  [[nodiscard]] RowField at(int pair) const;
};

/// What some pairs of a sequence say of the rows of all.
struct SequenceRows {
  RowTrack track;                   ///< empty where nothing is to be corrected
  std::optional<RowEstimate> rows;  ///< of the points of all these pairs; none where they disagree
  int pairs = 0;                    ///< that say something
};

/// Collects these pairs. Points of all pairs give one field. Where the pairs' own fields differ
/// from it by more than kMinCorrection_px (RMS) and three of their standard deviations, in a
/// quarter of the pairs or more, the rig drifts, and each pair is a key. Thread rule: one thread.
class SequenceRowSurvey {
 public:
  /// Adds a rectified pair, in the order of time. Corrects `right` by what the pair itself says, if
  /// that pays, so that its range can be found. Pairs of another size than the first are ignored.
  void add(int pair, const Photograph& left, Photograph& right, Execution& execution);
  [[nodiscard]] SequenceRows result() const;

 private:
  struct Sample {
    int pair = 0;
    RowEstimate rows;
  };
  std::vector<Sample> samples_;
  std::vector<PointMatch> points_;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace vantage
