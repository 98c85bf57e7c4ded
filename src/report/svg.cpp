// SPDX-License-Identifier: Apache-2.0
#include "versine/report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace versine::report {

namespace {

constexpr double per_mm = 20.0;  // units of the viewBox

long unit(double mm) {
  return std::lround(mm * per_mm);
}

class Writer {
 public:
  explicit Writer(fmt::memory_buffer& out) : out_(out) {}

  void operator()(const Path& p) {
    close_run();
    if (p.points.empty()) return;
    print("<path d=\"");
    points(p);
    print("\"");
    if (p.fill) {
      print(" fill=\"#{:06x}\"", p.fill->colour);
      if (p.fill->opacity < 1.0) print(" fill-opacity=\"{:.2g}\"", p.fill->opacity);
    } else {
      print(" fill=\"none\"");
    }
    if (p.pen) {
      print(" stroke=\"#{:06x}\" stroke-width=\"{}\"", p.pen->colour, std::max(1L, unit(p.pen->width)));
      if (p.pen->dash == Dash::dashed) print(" stroke-dasharray=\"30 16\"");
      if (p.pen->dash == Dash::dotted) print(" stroke-dasharray=\"6 12\"");
    }
    print("/>");
  }

  void operator()(const TextItem& t) {
    // Neighbours of one style share a group, which says only what differs from the groups around it.
    if (!run_ || !same(*run_, t.style)) {
      close_run();
      if (bases_.empty() || !same(bases_.back(), t.style)) {
        print("<g");
        print_style(t.style, bases_.empty() ? nullptr : &bases_.back());
        print(">");
        run_ = t.style;
      }
    }
    if (t.style.upright) {
      print("<text x=\"{}\" y=\"{}\"", unit(t.at.x), unit(t.at.y));
    } else {
      print("<text transform=\"translate({} {}) rotate(-90)\"", unit(t.at.x), unit(t.at.y));
    }
    if (in_row_) print(" role=\"cell\"");
    print(">{}</text>", escaped(t.text));
  }

  void operator()(const Clip& c) {
    close_run();
    // A nested picture cuts at its edges without needing a name.
    print("<svg x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\">", unit(c.box.x),
          unit(c.box.y), unit(c.box.width), unit(c.box.height));
    ends_.push_back({"</svg>"});
  }

  void operator()(const Group& g) {
    close_run();
    print("<g");
    if (!g.id.empty()) print(" id=\"{}\"", escaped(g.id));
    if (!g.role.empty()) print(" role=\"{}\"", g.role);
    if (!g.label.empty()) print(" aria-label=\"{}\"", escaped(g.label));
    if (g.style) {
      print_style(*g.style, nullptr);
      bases_.push_back(*g.style);
    }
    print(">");
    ends_.push_back({"</g>", g.role == "row", g.style.has_value()});
    in_row_ |= g.role == "row";
  }

  void operator()(const End&) {
    close_run();
    if (ends_.empty()) return;
    print("{}", ends_.back().tag);
    if (ends_.back().row) in_row_ = false;
    if (ends_.back().styled) bases_.pop_back();
    ends_.pop_back();
  }

  void finish() {
    close_run();
    while (!ends_.empty()) (*this)(End{});
  }

 private:
  template <class... T>
  void print(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<T>(values)...);
  }

  static bool same(const TextStyle& a, const TextStyle& b) {
    return a.size == b.size && a.anchor == b.anchor && a.bold == b.bold && a.colour == b.colour &&
           a.upright == b.upright;
  }

  void print_style(const TextStyle& s, const TextStyle* base) {
    if (base == nullptr || base->size != s.size) print(" font-size=\"{}\"", unit(s.size));
    if (base == nullptr || base->colour != s.colour) print(" fill=\"#{:06x}\"", s.colour);
    if (base == nullptr ? s.anchor != Anchor::start : s.anchor != base->anchor) {
      constexpr const char* anchors[] = {"start", "middle", "end"};
      print(" text-anchor=\"{}\"", anchors[static_cast<int>(s.anchor)]);
    }
    if (s.bold != (base != nullptr && base->bold)) print(" font-weight=\"{}\"", s.bold ? "bold" : "normal");
  }

  void close_run() {
    if (run_) print("</g>");
    run_.reset();
  }

  void points(const Path& p) {
    bool down = false;
    long x = 0, y = 0;
    for (const Point& q : p.points) {
      if (!std::isfinite(q.x) || !std::isfinite(q.y)) {
        down = false;
        continue;
      }
      const long qx = unit(q.x), qy = unit(q.y);
      if (down) {
        const long dx = qx - x, dy = qy - y;
        if (dx == 0 && dy == 0) continue;
        print("{}{}{}", dx < 0 || first_ ? "" : " ", dx, dy < 0 ? "" : " ");
        print("{}", dy);
        first_ = false;
      } else {
        print("M{} {}l", qx, qy);
        first_ = true;
      }
      x = qx;
      y = qy;
      down = true;
    }
    if (first_ && down) print("0 0");
    if (p.closed) print("z");
  }

  fmt::memory_buffer& out_;
  struct Close {
    const char* tag;
    bool row = false, styled = false;
  };
  std::vector<Close> ends_;
  std::optional<TextStyle> run_;
  std::vector<TextStyle> bases_;
  bool in_row_ = false, first_ = false;
};

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

std::string to_svg(const Drawing& drawing, bool standalone) {
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"",
                 unit(drawing.width), unit(drawing.height));
  if (standalone) {
    fmt::format_to(std::back_inserter(out),
                   " width=\"{}mm\" height=\"{}mm\" font-family=\"DejaVu Sans,Verdana,sans-serif\">"
                   "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>",
                   drawing.width, drawing.height);
  } else {
    fmt::format_to(std::back_inserter(out), ">");
  }
  Writer writer(out);
  for (const Item& item : drawing.items) std::visit(writer, item);
  writer.finish();
  fmt::format_to(std::back_inserter(out), "</svg>\n");
  return fmt::to_string(out);
}

}  // namespace versine::report
