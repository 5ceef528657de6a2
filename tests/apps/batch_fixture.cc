#include "tests/apps/batch_fixture.h"

#include <sstream>

namespace vantage {

std::string BatchTest::lines_of_pairs(int count) const {
  std::string lines = "output,left,right,disparities\n";
  for (int frame = 0; frame < count; ++frame) {
    lines += "pair-" + std::to_string(frame) + ",left/" + frame_file(frame) + ",right/" +
             frame_file(frame) + "," + (frame % 2 == 0 ? "0:9" : "") + "\n";
  }
  return lines;
}

Words BatchTest::batch_words(const Words& more) const {
  return joined({"batch", manifest_, "-o", out_}, more);
}

std::vector<nlohmann::json> BatchTest::item_lines() const {
  std::istringstream text(read_file(out_ + "/items.jsonl"));
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(text, line);) {
    lines.push_back(nlohmann::json::parse(line));
  }
  return lines;
}

FolderContent BatchTest::results() const {
  FolderContent content;
  for (const std::string& name : files_below(out_)) {
    if (name.find(".vantage") == std::string::npos && name != "items.jsonl") {
      content[name] = read_file(out_ + "/" + name);
    }
  }
  return content;
}

}  // namespace vantage
