// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "versine/app/config.hpp"

namespace versine::app {

namespace {

/// One key as text: what documentation, template and run.json need of it.
struct KeyText {
  std::string_view key;
  std::string type;
  std::string value;  ///< as TOML writes it, in the user's unit; empty: none
  nlohmann::json json;
  const KeySpec& spec;
};

std::string toml_text(const std::string& text) {
  return nlohmann::json(text).dump();
}

std::string shortest(double x) {
  const std::string text = fmt::format("{:.10g}", x);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

/// Turns every kind of value into a KeyText; the three writers differ only in what they do with it.
class TextVisitor : public ConfigVisitor {
 public:
  void value(std::string_view key, double& v, const KeySpec& spec) override {
    number(key, std::isfinite(v) ? std::optional<double>(v) : std::nullopt, spec);
  }
  void value(std::string_view key, std::optional<double>& v, const KeySpec& spec) override { number(key, v, spec); }
  void value(std::string_view key, int& v, const KeySpec& spec) override {
    text({key, "integer", std::to_string(v), v, spec});
  }
  void value(std::string_view key, bool& v, const KeySpec& spec) override {
    text({key, "boolean", v ? "true" : "false", v, spec});
  }
  void value(std::string_view key, std::string& v, const KeySpec& spec) override {
    text({key, "text", v.empty() ? "" : toml_text(v), v, spec});
  }
  void value(std::string_view key, InputPath& v, const KeySpec& spec) override {
    text({key, "path", v.empty() ? "" : toml_text(v.written), v.written, spec});
  }
  void value(std::string_view key, std::vector<double>& v, const KeySpec& spec) override {
    numbers(key, v, "list of numbers", spec);
  }
  void value(std::string_view key, Eigen::Vector3d& v, const KeySpec& spec) override {
    numbers(key, {v.x(), v.y(), v.z()}, "three numbers", spec);
  }
  void value(std::string_view key, std::optional<Eigen::Vector3d>& v, const KeySpec& spec) override {
    numbers(key, v ? std::vector<double>{v->x(), v->y(), v->z()} : std::vector<double>{}, "three numbers", spec);
  }
  void value(std::string_view key, std::vector<std::string>& v, const KeySpec& spec) override {
    text({key, "list of texts", v.empty() ? "" : nlohmann::json(v).dump(), v, spec});
  }
  void value(std::string_view key, std::vector<InputPath>& v, const KeySpec& spec) override {
    std::vector<std::string> written;
    for (const auto& path : v) written.push_back(path.written);
    text({key, "list of paths", v.empty() ? "" : nlohmann::json(written).dump(), written, spec});
  }
  void value(std::string_view key, std::map<std::string, std::string>& v, const KeySpec& spec) override {
    text({key, "table of texts", "", v, spec});
  }

 protected:
  virtual void text(const KeyText& key) = 0;
  void choose(std::string_view key, std::size_t& index, std::span<const std::string_view> words,
              const KeySpec& spec) override {
    std::vector<std::string> options;
    for (const auto word : words) options.push_back(toml_text(std::string(word)));
    text({key, fmt::format("one of {}", fmt::join(options, ", ")), options.at(index), std::string(words[index]), spec});
  }
  std::size_t count(std::string_view, std::size_t have) override { return have; }

 private:
  void number(std::string_view key, std::optional<double> v, const KeySpec& spec) {
    text({key, "number", v ? shortest(*v / spec.scale) : "", v ? nlohmann::json(*v / spec.scale) : nlohmann::json(),
          spec});
  }
  void numbers(std::string_view key, const std::vector<double>& v, std::string type, const KeySpec& spec) {
    std::vector<std::string> texts;
    nlohmann::json list = nlohmann::json::array();
    for (const double x : v) texts.push_back(shortest(x / spec.scale)), list.push_back(x / spec.scale);
    text({key, std::move(type), v.empty() ? "" : fmt::format("[{}]", fmt::join(texts, ", ")), list, spec});
  }
};

std::string range_text(const KeySpec& spec) {
  if (spec.positive && !std::isfinite(spec.max)) return "> 0";
  const bool low = std::isfinite(spec.min), high = std::isfinite(spec.max);
  if (low && high) return fmt::format("{} to {}", spec.min, spec.max);
  if (low) return fmt::format(">= {}", spec.min);
  if (high) return fmt::format("{}<= {}", spec.positive ? "> 0, " : "", spec.max);
  return "";
}

class DocumentationWriter final : public TextVisitor {
 public:
  explicit DocumentationWriter(std::string path) : path_(std::move(path)) {}
  void table(std::string_view key, std::string_view doc, const std::function<void(ConfigVisitor&)>& body,
             bool*) override {
    sub(key, fmt::format("[{}{}]", path_, key), doc, body);
  }
  [[nodiscard]] std::string str() const {
    const std::string head = "| key | type | default | range | meaning |\n| --- | --- | --- | --- | --- |\n";
    return (rows_.empty() ? "" : head + rows_ + "\n") + subs_;
  }

 protected:
  void text(const KeyText& key) override {
    std::string type = key.type;
    if (!key.spec.unit.empty()) type += fmt::format(", {}", key.spec.unit);
    rows_ += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.key, type,
                         key.spec.required ? "required" : (key.value.empty() ? "none" : "`" + key.value + "`"),
                         range_text(key.spec), key.spec.doc);
  }
  void items(std::string_view key, std::string_view doc, std::size_t,
             const std::function<void(ConfigVisitor&, std::size_t)>& body) override {
    sub(key, fmt::format("[[{}{}]]", path_, key), doc,
        [&](ConfigVisitor& v) { body(v, std::numeric_limits<std::size_t>::max()); });
  }

 private:
  void sub(std::string_view key, const std::string& title, std::string_view doc,
           const std::function<void(ConfigVisitor&)>& body) {
    DocumentationWriter writer(path_ + std::string(key) + ".");
    body(writer);
    subs_ += fmt::format("## `{}`\n\n{}\n\n{}", title, doc, writer.str());
  }
  std::string path_, rows_, subs_;
};

class TemplateWriter final : public TextVisitor {
 public:
  explicit TemplateWriter(std::string path) : path_(std::move(path)) {}
  void table(std::string_view key, std::string_view doc, const std::function<void(ConfigVisitor&)>& body,
             bool* present) override {
    sub(key, fmt::format("[{}{}]", path_, key), doc, body, present != nullptr);
  }
  [[nodiscard]] std::string str() const { return rows_ + subs_; }
  [[nodiscard]] bool has_required() const { return required_; }

 protected:
  void text(const KeyText& key) override {
    std::string note(key.spec.doc);
    const std::string range = range_text(key.spec);
    if (!key.spec.unit.empty() || !range.empty()) {
      note += fmt::format(" ({}{}{})", key.spec.unit, key.spec.unit.empty() || range.empty() ? "" : ", ", range);
    }
    if (key.type.starts_with("one of")) note += fmt::format(" {}", key.type);
    const std::string shown = !key.spec.example.empty() ? std::string(key.spec.example) : key.value;
    rows_ +=
        fmt::format("# {}\n{}{} = {}\n", note, key.spec.required ? "" : "# ", key.key, shown.empty() ? "..." : shown);
    required_ = required_ || key.spec.required;
  }
  void items(std::string_view key, std::string_view doc, std::size_t,
             const std::function<void(ConfigVisitor&, std::size_t)>& body) override {
    sub(
        key, fmt::format("[[{}{}]]", path_, key), doc,
        [&](ConfigVisitor& v) { body(v, std::numeric_limits<std::size_t>::max()); }, true);
  }

 private:
  void sub(std::string_view key, const std::string& title, std::string_view doc,
           const std::function<void(ConfigVisitor&)>& body, bool optional) {
    TemplateWriter writer(path_ + std::string(key) + ".");
    body(writer);
    std::string text = fmt::format("\n# {}\n{}\n{}", doc, title, writer.str());
    // A table that switches something on, and one that nobody needs but that has required keys: commented out whole.
    if (optional || (writer.has_required() && !path_.empty())) text = commented_out(text);
    subs_ += text;
  }
  std::string path_, rows_, subs_;
  bool required_ = false;
};

class JsonWriter final : public TextVisitor {
 public:
  void table(std::string_view key, std::string_view, const std::function<void(ConfigVisitor&)>& body, bool*) override {
    JsonWriter writer;
    body(writer);
    json[std::string(key)] = std::move(writer.json);
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::object();

 protected:
  void text(const KeyText& key) override { json[std::string(key.key)] = key.json; }
  void items(std::string_view key, std::string_view, std::size_t count,
             const std::function<void(ConfigVisitor&, std::size_t)>& body) override {
    auto list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < count; ++i) {
      JsonWriter writer;
      body(writer, i);
      list.push_back(std::move(writer.json));
    }
    json[std::string(key)] = std::move(list);
  }
};

}  // namespace

std::string commented_out(const std::string& text) {
  std::string out;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, to - from);
    out += (line.empty() || line.front() == '#' ? line : "# " + line) + "\n";
    from = to + 1;
  }
  return out;
}

std::string config_documentation(const Description& description) {
  DocumentationWriter writer("");
  description(writer);
  return writer.str();
}

std::string config_template(const Description& description) {
  TemplateWriter writer("");
  description(writer);
  return writer.str();
}

std::string config_json(const Description& description) {
  JsonWriter writer;
  description(writer);
  return writer.json.dump(2);
}

}  // namespace versine::app
