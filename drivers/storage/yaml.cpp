#include "drivers/storage/yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace drivers {
namespace {

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string name, const YamlLimits& limits) : name_(std::move(name)), limits_(limits) {}

  [[nodiscard]] YamlNode take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_leaf(leaf(mark, anchor)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse_anchor(mark); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = leaf(mark, anchor);
    node.kind = YamlNode::Kind::kScalar;
    node.text = value;
    node.quoted = tag == "!";
    add_leaf(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor, YamlNode::Kind::kList);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor, YamlNode::Kind::kMap);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  [[noreturn]] void refuse(int line, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", name_, line, what));
  }
  [[noreturn]] void refuse_anchor(const YAML::Mark& mark) const {
    refuse(mark.line + 1, "anchors and aliases (&name, *name) are refused; write the value out, or quote the text");
  }

  YamlNode leaf(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) refuse_anchor(mark);
    if (++n_nodes_ > limits_.max_nodes) refuse(mark.line + 1, fmt::format("more than {} values", limits_.max_nodes));
    YamlNode node;
    node.line = mark.line + 1;
    return node;
  }

  [[nodiscard]] bool expects_key() const {
    return !open_.empty() && open_.back().kind == YamlNode::Kind::kMap &&
           open_.back().keys.size() == open_.back().items.size();
  }

  void add_leaf(YamlNode node) {
    if (!expects_key()) return add_value(std::move(node));
    if (node.kind != YamlNode::Kind::kScalar) refuse(node.line, "a key is empty; write `key: value`");
    YamlNode& map = open_.back();
    const auto same = std::find(map.keys.begin(), map.keys.end(), node.text);
    if (same != map.keys.end()) {
      const int first_line = map.key_lines[static_cast<std::size_t>(same - map.keys.begin())];
      refuse(node.line,
             fmt::format("key `{}` is written twice (first in line {}); keep one", printable(node.text), first_line));
    }
    map.keys.push_back(std::move(node.text));
    map.key_lines.push_back(node.line);
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, YamlNode::Kind kind) {
    if (expects_key()) refuse(mark.line + 1, "a list or map stands where a key is expected; write `key: value`");
    if (open_.size() >= limits_.max_depth)
      refuse(mark.line + 1, fmt::format("nested deeper than {}", limits_.max_depth));
    YamlNode node = leaf(mark, anchor);
    node.kind = kind;
    open_.push_back(std::move(node));
  }

  void close() {
    YamlNode node = std::move(open_.back());
    open_.pop_back();
    add_value(std::move(node));
  }

  void add_value(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    YamlNode& parent = open_.back();
    // The parser places a missing value at the next token, which may be lines below its key.
    if (node.kind == YamlNode::Kind::kNull && !parent.key_lines.empty()) node.line = parent.key_lines.back();
    parent.items.push_back(std::move(node));
  }

  std::string name_;
  YamlLimits limits_;
  YamlNode root_;
  std::vector<YamlNode> open_;  // the containers around the current event, outermost first
  std::size_t n_nodes_ = 0;
};

void require_no_tab_indentation(const std::string& text, const std::string& name) {
  int line = 1;
  bool leading = true;
  for (const char c : text) {
    if (c == '\t' && leading) throw FileError(fmt::format("{}:{}: a tab indents the line; use spaces", name, line));
    leading = c == '\n' || (leading && c == ' ');
    if (c == '\n') ++line;
  }
}

}  // namespace

const YamlNode* YamlNode::find(const std::string& key) const noexcept {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

YamlNode parse_yaml(const std::string& text, const std::string& name, const YamlLimits& limits) {
  if (text.size() > limits.max_bytes) {
    throw FileError(fmt::format("{}: is larger than {} KiB; is this the right file?", name, limits.max_bytes / 1024));
  }
  require_text(text, name);
  require_no_tab_indentation(text, name);
  TreeBuilder builder(name, limits);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) throw FileError(name + ": is empty");
    YamlNode root = builder.take();
    TreeBuilder second(name, limits);
    if (parser.HandleNextDocument(second))
      throw FileError(name + ": holds more than one document; remove the second `---`");
    return root;
  } catch (const YAML::Exception& error) {
    throw FileError(fmt::format("{}:{}: not valid YAML: {}; check indentation, colons and brackets", name,
                                std::max(error.mark.line + 1, 1), error.msg));
  }
}

YamlNode read_yaml_file(const std::string& path, const YamlLimits& limits) {
  return parse_yaml(read_text_file(path, limits.max_bytes), path, limits);
}

}  // namespace drivers
