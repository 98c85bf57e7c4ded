// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// One list of drawing commands, two back ends: SVG (svg.hpp) and PDF (pdf.hpp). What is drawn once looks the same in
/// both. Lengths in mm from the upper left corner, y downwards.
namespace versine::report {

struct Point {
  double x = 0.0, y = 0.0;
};

struct Box {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
  [[nodiscard]] double right() const { return x + width; }
  [[nodiscard]] double bottom() const { return y + height; }
};

enum class Dash { solid, dashed, dotted };
enum class Anchor { start, middle, end };

/// Colours are 0xRRGGBB.
struct Pen {
  std::uint32_t colour = 0x333333;
  double width = 0.2;  ///< mm
  Dash dash = Dash::solid;
};
struct Fill {
  std::uint32_t colour = 0;
  double opacity = 1.0;
};

/// A line, polyline or area. A NaN in a point lifts the pen.
struct Path {
  std::vector<Point> points;
  bool closed = false;
  std::optional<Pen> pen;
  std::optional<Fill> fill;
};

struct TextStyle {
  double size = 2.6;  ///< mm, of the font
  Anchor anchor = Anchor::start;
  bool bold = false;
  std::uint32_t colour = 0x1b1f24;
  bool upright = true;  ///< false: turned to run upwards
};
struct TextItem {
  Point at;  ///< on the baseline
  std::string text;
  TextStyle style;
};

/// Everything until the matching End is cut at the box.
struct Clip {
  Box box;
};
/// What everything until the matching End is, for screen readers, tests and links: an ARIA role, a label, an id.
struct Group {
  std::string role, label, id;
  std::optional<TextStyle> style = {};  ///< of most texts inside: said once, which halves the size of tables
};
struct End {};

using Item = std::variant<Path, TextItem, Clip, Group, End>;

struct Drawing {
  double width = 281.0, height = 193.0;  ///< mm; the default is A4 landscape within margins of 8 mm
  std::vector<Item> items;

  void line(Point a, Point b, Pen pen) { items.emplace_back(Path{{a, b}, false, pen, {}}); }
  void polyline(std::vector<Point> points, Pen pen) { items.emplace_back(Path{std::move(points), false, pen, {}}); }
  void area(std::vector<Point> points, Fill fill, std::optional<Pen> pen = {}) {
    items.emplace_back(Path{std::move(points), true, pen, fill});
  }
  void rectangle(const Box& b, std::optional<Fill> fill, std::optional<Pen> pen = {}) {
    items.emplace_back(
        Path{{{b.x, b.y}, {b.right(), b.y}, {b.right(), b.bottom()}, {b.x, b.bottom()}}, true, pen, fill});
  }
  void circle(Point centre, double radius, std::optional<Fill> fill, std::optional<Pen> pen = {});
  void text(Point at, std::string text, TextStyle style = {}) {
    items.emplace_back(TextItem{at, std::move(text), style});
  }
  void begin(Group group) { items.emplace_back(std::move(group)); }
  void begin(Clip clip) { items.emplace_back(clip); }
  void end() { items.emplace_back(End{}); }
};

/// Lifts the pen in a Path.
inline constexpr Point pen_up{std::numeric_limits<double>::quiet_NaN(), 0.0};

/// Width of a text in the reports' font (DejaVu Sans; other scripts estimated, CJK one em), mm.
[[nodiscard]] double text_width(const std::string& text, double size, bool bold = false);
/// Breaks a text at blanks (CJK: anywhere) into lines no wider than `width`; a longer word is broken inside.
[[nodiscard]] std::vector<std::string> wrapped(const std::string& text, double width, double size, bool bold = false);
/// The text, or as much of it as fits with an ellipsis.
[[nodiscard]] std::string fitted(const std::string& text, double width, double size, bool bold = false);

}  // namespace versine::report
