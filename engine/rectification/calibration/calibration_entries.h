#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Values of one name in a text file.
struct CalibrationEntry {
  int rows = 0;  ///< 0: not given in the file
  int columns = 0;
  std::vector<double> values = {};  ///< row by row, all finite
  std::string problem = {};         ///< why there are no values, else empty
  std::string word = {};            ///< the first non-numeric word, at most 20 characters of it

  /// Nothing is written there, as in [].
  [[nodiscard]] bool is_empty() const { return problem == kNoNumbers; }
  static constexpr const char* kNoNumbers = "holds no numbers";
};

/// By name; of duplicate names the first one counts.
using CalibrationEntries = std::map<std::string, CalibrationEntry, std::less<>>;

// Each parses the whole text of a file. Entries without numbers are kept with their problem, so
// that only requested entries have to be valid. Any text is accepted: everything else is skipped.
//
// Why not cv::FileStorage, which writes such files (rectification_file)? It refuses files without
// its own "%YAML" line (ROS, KITTI), and a whole file for one entry that it cannot read. With
// version 4.6 a file of nested brackets or tags overflows the stack, and wrong rows and cols
// allocate their product. Its errors name OpenCV's source lines, not the file.

//
// Names of nested nodes are joined with dots, cam0.intrinsics; matrices are nodes with rows, cols
// and data, as OpenCV writes them.

/// `name: values`: YAML (sequences, maps by indentation) and KITTI's text files.
CalibrationEntries yaml_entries(std::string_view text);

/// <name>values</name> below the root element.
CalibrationEntries xml_entries(std::string_view text);

/// Throws Error where it is not JSON.
CalibrationEntries json_entries(std::string_view text);

/// Those of any of the three, as the text begins.
CalibrationEntries entries_of(std::string_view text);

/// `name=values` line by line, as Middlebury writes them.
CalibrationEntries assignment_entries(std::string_view text);

/// Numbers separated by blanks, commas, semicolons and brackets.
CalibrationEntry numbers_of(std::string_view text);

}  // namespace vantage
