// SPDX-License-Identifier: Apache-2.0
#include "versine/report/drawing.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace versine::report {

namespace {

// Advance widths of ASCII 32 to 126 in DejaVu Sans, thousandths of an em (from the font's table hmtx).
constexpr std::array<std::uint16_t, 95> advances{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};
constexpr double bold_factor = 1.104;  // mean of the bold font's advances over these

struct Character {
  std::size_t bytes = 1;
  double advance = 0.6;  ///< em
  bool ideograph = false;
};

Character character_at(const std::string& s, std::size_t i) {
  const auto c = static_cast<unsigned char>(s[i]);
  if (c < 0x80) return {1, c >= 32 && c < 127 ? advances[c - 32] / 1000.0 : 0.0, false};
  if (c < 0xE0) return {2, 0.63, false};
  if (c < 0xF0) return {3, c >= 0xE3 ? 1.0 : 0.75, c >= 0xE3};  // from U+3000: CJK
  return {4, 1.0, true};
}

}  // namespace

void Drawing::circle(Point c, double r, std::optional<Fill> fill, std::optional<Pen> pen) {
  constexpr int corners = 16;
  Path path{.closed = true, .pen = pen, .fill = fill};
  for (int k = 0; k < corners; ++k) {
    const double a = 2.0 * std::numbers::pi * k / corners;
    path.points.push_back({c.x + r * std::cos(a), c.y + r * std::sin(a)});
  }
  items.emplace_back(std::move(path));
}

double text_width(const std::string& text, double size, bool bold) {
  double em = 0.0;
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    em += c.advance;
    i += c.bytes;
  }
  return em * size * (bold ? bold_factor : 1.0);
}

std::vector<std::string> wrapped(const std::string& text, double width, double size, bool bold) {
  const double em = width / size / (bold ? bold_factor : 1.0);
  std::vector<std::string> lines;
  std::string line;
  double used = 0.0, used_at_blank = 0.0;
  std::size_t blank = std::string::npos;  // in `line`: where it may be broken
  for (std::size_t i = 0; i < text.size();) {
    const Character c = character_at(text, i);
    const std::string bytes = text.substr(i, c.bytes);
    i += c.bytes;
    if (bytes == "\n") {
      lines.push_back(std::move(line));
      line.clear();
      used = 0.0;
      blank = std::string::npos;
      continue;
    }
    if (used + c.advance > em && !line.empty() && bytes != " ") {
      if (c.ideograph || blank == std::string::npos) {
        lines.push_back(std::move(line));
        line.clear();
        used = 0.0;
      } else {
        lines.push_back(line.substr(0, blank));
        line.erase(0, blank + 1);
        used -= used_at_blank;
      }
      blank = std::string::npos;
    }
    if (bytes == " ") {
      blank = line.size();
      used_at_blank = used + c.advance;
    }
    line += bytes;
    used += c.advance;
  }
  if (!line.empty() || lines.empty()) lines.push_back(std::move(line));
  return lines;
}

std::string fitted(const std::string& text, double width, double size, bool bold) {
  if (text_width(text, size, bold) <= width) return text;
  const double room = width - text_width(".", size, bold) * 3.0;
  double used = 0.0;
  std::size_t i = 0;
  while (i < text.size()) {
    const Character c = character_at(text, i);
    used += c.advance * size * (bold ? bold_factor : 1.0);
    if (used > room) break;
    i += c.bytes;
  }
  return text.substr(0, i) + "\xE2\x80\xA6";
}

}  // namespace versine::report
