#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// What a text file says about one name.
struct CalibrationEntry {
  int rows = 0;  ///< 0: the file does not say
  int columns = 0;
  std::vector<double> values = {};  ///< row by row, all finite
  std::string problem = {};         ///< why there are no values, empty if there are
  std::string word = {};  ///< the first thing that is no number, at most 20 characters of it
};

/// By name; the first one counts where a name comes twice.
using CalibrationEntries = std::map<std::string, CalibrationEntry, std::less<>>;

// Each takes the whole text of a file. Entries that hold no numbers are kept with their problem, so
// that only those which are asked for have to make sense. Any text is accepted: what is not an
// entry is skipped.
//
// Why not cv::FileStorage, which writes such files (rectification_file)? It refuses files without
// its own "%YAML" line (ROS, KITTI), and a whole file for one entry that it cannot read. With
// version 4.6 a file of nested brackets or tags overflows the stack, and rows and cols that are
// wrong allocate their product. Its errors name OpenCV's source lines, not the file.

/// `name: values` from the beginning of a line to the next name there, so YAML (sequences, and
/// matrices with rows, cols and data as OpenCV writes them) as well as KITTI's text files.
CalibrationEntries yaml_entries(std::string_view text);

/// <name>values</name> below the outermost element; matrices as OpenCV writes them.
CalibrationEntries xml_entries(std::string_view text);

/// `name=values` line by line, as Middlebury writes them.
CalibrationEntries assignment_entries(std::string_view text);

/// Numbers separated by blanks, commas, semicolons and brackets.
CalibrationEntry numbers_of(std::string_view text);

}  // namespace vantage
