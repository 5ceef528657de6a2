#pragma once

#include <string>
#include <vector>

namespace vantage::apps {

/// Rows of cells, set in columns as wide as what they hold: the first to the left, the others to
/// the right. A title goes ahead of it, and every line is indented below that.
class TextTable {
 public:
  TextTable(std::string title, std::vector<std::string> heads);

  /// As many cells as there are heads.
  void add(std::vector<std::string> cells);
  [[nodiscard]] bool empty() const { return rows_.size() < 2; }
  /// Ends in a newline.
  [[nodiscard]] std::string text() const;

 private:
  std::string title_;
  std::vector<std::vector<std::string>> rows_;  // the first are the heads
};

}  // namespace vantage::apps
