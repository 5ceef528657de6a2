#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Elements of an XML document, by name, in order of their begin.
struct XmlOutline {
  std::string error;  ///< empty for a well-formed document
  std::vector<std::string> elements;

  [[nodiscard]] int count(std::string_view name) const {
    int result = 0;
    for (const std::string& element : elements) {
      result += element == name ? 1 : 0;
    }
    return result;
  }
};

/// Reads the subset of XML that charts need: one root, elements with quoted attributes that are
/// given once, the five entities, a declaration, ASCII. Whatever else there is counts as an error.
class XmlReader {
 public:
  explicit XmlReader(std::string_view text) : text_(text) {}

  XmlOutline read() {
    take("<?xml");
    if (position_ > 0) {
      position_ = text_.find("?>") + 2;
    }
    blanks();
    element();
    blanks();
    if (outline_.error.empty() && position_ != text_.size()) {
      fail("text behind the root");
    }
    return outline_;
  }

 private:
  static constexpr unsigned char kMaxAscii = 126;

  void element() {
    if (!take("<")) {
      return fail("an element is missing");
    }
    const std::string tag = name();
    if (tag.empty()) {
      return fail("a name is missing");
    }
    outline_.elements.push_back(tag);
    std::vector<std::string> attributes;
    for (blanks(); ok() && peek() != '>' && peek() != '/'; blanks()) {
      const std::string attribute = name();
      for (const std::string& other : attributes) {
        if (other == attribute) {
          return fail("twice: " + attribute);
        }
      }
      attributes.push_back(attribute);
      if (attribute.empty() || !take("=\"")) {
        return fail("an attribute without a value in " + tag);
      }
      content('"');
      take("\"");
    }
    if (take("/>")) {
      return;
    }
    take(">");
    for (content('<'); ok() && !starts_with("</"); content('<')) {
      element();
    }
    if (!take("</" + tag + ">")) {
      fail(tag + " has no end");
    }
  }
  /// Characters up to `end`.
  void content(char end) {
    for (; ok() && peek() != end; ++position_) {
      if (peek() == '<' || peek() == '>' || static_cast<unsigned char>(peek()) > kMaxAscii) {
        return fail("a character that must be escaped");
      }
      if (peek() == '&' && !starts_with("&amp;") && !starts_with("&lt;") && !starts_with("&gt;") &&
          !starts_with("&quot;") && !starts_with("&apos;")) {
        return fail("a bare &");
      }
    }
  }
  std::string name() {
    std::string result;
    while (ok() && (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '-')) {
      result += text_[position_++];
    }
    return result;
  }
  void blanks() {
    while (position_ < text_.size() && std::isspace(static_cast<unsigned char>(peek())) != 0) {
      ++position_;
    }
  }
  [[nodiscard]] char peek() const { return text_[position_]; }
  [[nodiscard]] bool starts_with(std::string_view what) const {
    return text_.substr(position_).substr(0, what.size()) == what;
  }
  bool take(const std::string& what) {
    if (!starts_with(what)) {
      return false;
    }
    position_ += what.size();
    return true;
  }
  bool ok() {
    if (outline_.error.empty() && position_ >= text_.size()) {
      fail("the text ends early");
    }
    return outline_.error.empty();
  }
  void fail(const std::string& error) {
    if (outline_.error.empty()) {
      outline_.error = error + " at " + std::to_string(position_);
    }
  }

  std::string_view text_;
  std::size_t position_ = 0;
  XmlOutline outline_;
};

inline XmlOutline read_xml(std::string_view text) { return XmlReader(text).read(); }

}  // namespace vantage
