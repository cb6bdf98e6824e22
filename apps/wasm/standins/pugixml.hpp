#pragma once

// In place of pugixml: the part that io/klems.cpp asks for. Elements and the text in them; attributes, comments,
// declarations and entities other than XML's own five are skipped over.

#include <algorithm>
#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pugi {

inline constexpr int parse_default = 0, encoding_utf8 = 0;

struct xml_element {
  std::string name, text;  ///< the first text that is not blank
  std::vector<const xml_element*> children;
};

class xml_node {
 public:
  xml_node() = default;
  explicit xml_node(const xml_element* element) : element_(element) {}
  explicit operator bool() const { return element_ != nullptr; }
  bool operator!() const { return !element_; }
  bool operator==(const xml_node& other) const { return element_ == other.element_; }

  /// The first child of that name; none of none.
  xml_node child(std::string_view name) const {
    if (element_)
      for (const xml_element* e : element_->children)
        if (e->name == name) return xml_node(e);
    return {};
  }
  const char* child_value(std::string_view name) const {
    const xml_node found = child(name);
    return found ? found.element_->text.c_str() : "";
  }
  std::vector<xml_node> children(std::string_view name) const {
    std::vector<xml_node> found;
    if (element_)
      for (const xml_element* e : element_->children)
        if (e->name == name) found.emplace_back(e);
    return found;
  }

 private:
  const xml_element* element_ = nullptr;
};

struct xml_parse_result {
  const char* problem = nullptr;
  std::ptrdiff_t offset = 0;
  explicit operator bool() const { return !problem; }
  const char* description() const { return problem ? problem : "No error"; }
};

class xml_document {
 public:
  xml_parse_result load_buffer(const void* bytes, std::size_t size, int, int) {
    text_ = {static_cast<const char*>(bytes), size};
    at_ = 0;
    const char* problem = parse();
    return {problem, static_cast<std::ptrdiff_t>(at_)};
  }
  xml_node child(std::string_view name) const { return xml_node(&root_).child(name); }

 private:
  bool skip_past(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == text_.npos ? text_.size() : found + end.size();
    return found != text_.npos;
  }
  bool starts(std::string_view what) const { return text_.substr(at_, what.size()) == what; }

  static std::string decoded(std::string_view raw) {
    static constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
    std::string result;
    for (std::size_t i = 0; i < raw.size();) {
      bool found = false;
      if (raw[i] == '&')
        for (const auto& [name, c] : kEntities)
          if (raw.substr(i, name.size()) == name) {
            result += c;
            i += name.size();
            found = true;
            break;
          }
      if (!found) result += raw[i++];
    }
    return result;
  }
  void add_text(xml_element& element, std::string text) const {
    if (element.text.empty() && text.find_first_not_of(" \t\r\n") != text.npos)
      element.text = std::move(text);
  }

  // From '<' of a tag to past its '>'; what is wrong, if anything is.
  const char* tag(std::vector<xml_element*>& open) {
    const bool closing = starts("</");
    at_ += closing ? 2 : 1;
    const std::size_t end_of_name = text_.find_first_of(" \t\r\n/>", at_);
    if (end_of_name == text_.npos || end_of_name == at_) return "Error parsing start element tag";
    const std::string_view name = text_.substr(at_, end_of_name - at_);
    // attributes; '>' in quotes does not end the tag
    char quote = 0;
    std::size_t end = end_of_name;
    for (; end < text_.size() && (quote || text_[end] != '>'); ++end) {
      const char c = text_[end];
      if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? 0 : c;
      if (!quote && c == '<') break;
    }
    if (end == text_.size() || text_[end] != '>') return "Error parsing element attribute";
    if (closing) {
      if (open.size() < 2 || open.back()->name != name) return "Start-end tags mismatch";
      open.pop_back();
    } else {
      xml_element& element = elements_.emplace_back();
      element.name = name;
      open.back()->children.push_back(&element);
      if (text_[end - 1] != '/') open.push_back(&element);
    }
    at_ = end + 1;
    return nullptr;
  }

  const char* parse() {
    std::vector<xml_element*> open{&root_};
    while (at_ < text_.size()) {
      if (starts("<!--")) {
        if (!skip_past("-->")) return "Error parsing comment";
      } else if (starts("<![CDATA[")) {
        const std::size_t begin = at_ + 9;
        if (!skip_past("]]>")) return "Error parsing CDATA section";
        add_text(*open.back(), std::string(text_.substr(begin, at_ - 3 - begin)));
      } else if (starts("<?")) {
        if (!skip_past("?>")) return "Error parsing document declaration/processing instruction";
      } else if (starts("<!")) {
        if (!skip_past(">")) return "Error parsing document type declaration";
      } else if (text_[at_] == '<') {
        if (const char* problem = tag(open)) return problem;
      } else {
        const std::size_t end = std::min(text_.find('<', at_), text_.size());
        add_text(*open.back(), decoded(text_.substr(at_, end - at_)));
        at_ = end;
      }
    }
    if (open.size() > 1) return "Start-end tags mismatch";
    return root_.children.empty() ? "No document element found" : nullptr;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  xml_element root_;
  std::deque<xml_element> elements_;  // whose addresses stay
};

}  // namespace pugi
