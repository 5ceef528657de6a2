#pragma once

#include "tests/apps/run_fixture.h"

namespace vantage {

/// Manifests of the frames of RunTest, and what `vantage batch` makes of them.
class BatchTest : public RunTest {
 protected:
  /// Columns output, left and right of `count` frames, from the first on.
  [[nodiscard]] std::string lines_of_pairs(int count) const;
  void write_manifest(const std::string& text) const { write_file(manifest_, text); }
  /// `batch MANIFEST -o OUT`
  [[nodiscard]] Words batch_words(const Words& more) const;
  [[nodiscard]] ProcessResult batch(const Words& more = {}, const Words& environment = {}) const {
    return run_vantage(batch_words(more), environment);
  }
  /// The lines of items.jsonl.
  [[nodiscard]] std::vector<nlohmann::json> item_lines() const;
  /// Everything but the batch's own files.
  [[nodiscard]] FolderContent results() const;

  std::string manifest_ = folder_ / "manifest.csv";
  std::string out_ = folder_ / "out";
};

}  // namespace vantage
