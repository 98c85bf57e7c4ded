// SPDX-License-Identifier: Apache-2.0
#include "versine/report/table.hpp"

#include <algorithm>

#include "colours.hpp"

namespace versine::report {

namespace {

constexpr double full_size = 2.45, gap = 6.0;  // mm
using colours::muted, colours::rule;
constexpr std::uint32_t head_fill = 0xf3f5f8;

struct Layout {
  std::vector<double> left, width;
  std::size_t head_lines = 1;
  double size = full_size, leading = 3.5, padding = 1.2;  ///< mm; smaller in tables that are too wide

  void shrink(double factor) {
    size *= factor;
    leading *= factor;
    padding *= factor;
  }
};

/// Columns as wide as their content, those that wrap take what is left. What is too wide is printed smaller: no number
/// is ever cut.
Layout lay_out(const Table& t, double total) {
  const std::size_t n = t.columns.size();
  Layout out;
  out.width.assign(n, 0.0);
  double fixed = 0.0, shares = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& c = t.columns[k];
    double w = c.minimum;
    // A head may break, but not inside a word.
    for (const std::string& line : wrapped(c.title, 16.0, out.size, true)) {
      w = std::max(w, text_width(line, out.size, true));
    }
    for (const auto& row : t.rows) {
      if (k < row.size() && !c.wrap) w = std::max(w, text_width(row[k].text, out.size, row[k].bold));
    }
    out.width[k] = w + 2.0 * out.padding;
    (c.wrap ? shares : fixed) += c.wrap ? c.share : out.width[k];
  }
  const double room = shares > 0.0 ? std::max(total - fixed, 0.1 * total) : 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    if (t.columns[k].wrap) out.width[k] = room * t.columns[k].share / shares;
  }
  const double natural = fixed + room;
  const double stretch = natural > total ? total / natural : std::min(total / natural, shares > 0.0 ? 1.0 : 1.35);
  if (stretch < 1.0) out.shrink(stretch);
  double x = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    out.width[k] *= stretch;
    out.left.push_back(x);
    x += out.width[k];
    const double inside = out.width[k] - 2.0 * out.padding + 0.01;
    out.head_lines = std::max(out.head_lines, wrapped(t.columns[k].title, inside, out.size, true).size());
  }
  return out;
}

Point anchor(const Box& cell, Anchor align, double padding, double baseline) {
  const double x = align == Anchor::start ? cell.x + padding
                   : align == Anchor::end ? cell.right() - padding
                                          : cell.x + 0.5 * cell.width;
  return {x, baseline};
}

double draw_head(const Table& t, const Layout& l, Drawing& d, double x, double y) {
  const double height = 1.4 + l.leading * static_cast<double>(l.head_lines);
  const double width = l.left.back() + l.width.back();
  d.rectangle({x, y, width, height}, Fill{head_fill});
  d.begin(Group{"row", {}, {}});
  for (std::size_t k = 0; k < t.columns.size(); ++k) {
    const Box cell{x + l.left[k], y, l.width[k], height};
    const auto lines = wrapped(t.columns[k].title, cell.width - 2.0 * l.padding + 0.01, l.size, true);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const double from_below = static_cast<double>(lines.size() - 1 - i) * l.leading;
      d.text(anchor(cell, t.columns[k].align, l.padding, y + height - 1.3 - from_below), lines[i],
             {.size = l.size, .anchor = t.columns[k].align, .bold = true, .colour = 0x24292f});
    }
  }
  d.end();
  d.line({x, y + height}, {x + width, y + height}, {colours::muted, 0.25, Dash::solid});
  return y + height;
}

struct Row {
  std::vector<std::vector<std::string>> lines;
  double height = 0.0, text_height = 0.0;
};

Row measure(const Table& t, const Layout& l, const std::vector<Cell>& cells) {
  Row row;
  std::size_t most = 1;
  for (std::size_t k = 0; k < cells.size() && k < l.width.size(); ++k) {
    const double room = l.width[k] - 2.0 * l.padding + 0.01;
    if (t.columns[k].wrap) {
      row.lines.push_back(wrapped(cells[k].text, room, l.size, cells[k].bold));
    } else {
      row.lines.push_back({fitted(cells[k].text, room, l.size, cells[k].bold)});
    }
    most = std::max(most, row.lines.back().size());
  }
  row.text_height = 1.05 + l.leading * static_cast<double>(most);
  row.height = std::max(t.row_height, row.text_height);
  return row;
}

void draw_row(const Table& t, const Layout& l, const Row& row, const std::vector<Cell>& cells, Drawing& d, double x,
              double y) {
  const double top = y + 0.5 * (row.height - row.text_height);
  d.begin(Group{"row", {}, {}});
  for (std::size_t k = 0; k < row.lines.size(); ++k) {
    const Box cell{x + l.left[k], y, l.width[k], row.height};
    for (std::size_t i = 0; i < row.lines[k].size(); ++i) {
      d.text(anchor(cell, t.columns[k].align, l.padding, top + l.leading * static_cast<double>(i + 1) - 0.35),
             row.lines[k][i],
             {.size = l.size, .anchor = t.columns[k].align, .bold = cells[k].bold, .colour = cells[k].colour});
    }
  }
  d.end();
}

double draw_title(const Table& t, Drawing& d, const Box& box) {
  double y = box.y;
  if (!t.title.empty()) {
    d.text({box.x, y + 4.0}, t.title, {.size = 3.6, .bold = true});
    y += 6.2;
  }
  for (const std::string& note : t.notes) {
    for (const std::string& line : wrapped(note, box.width, full_size)) {
      d.text({box.x, y + 2.6}, line, {.size = full_size, .colour = muted});
      y += 3.5;
    }
  }
  return y + (t.notes.empty() ? 0.0 : 1.5);
}

}  // namespace

double draw_table(const Table& t, Drawing*& page, Box box, const std::function<Box(Drawing*&)>& next) {
  double top = draw_title(t, *page, box);
  if (t.rows.empty() || t.columns.empty()) {
    page->text({box.x, top + 3.5}, t.empty, {.size = 2.8, .colour = muted});
    return top + 6.0;
  }
  const int blocks = std::max(1, t.blocks);
  const Layout layout = lay_out(t, (box.width - gap * (blocks - 1)) / blocks);
  const double pitch = (box.width + gap) / blocks;
  int block = 0;
  double lowest = top;
  std::vector<Point> rules;  // between rows, drawn at once
  const auto close = [&] {
    page->polyline(std::move(rules), {rule, 0.1, Dash::solid});
    rules.clear();
    page->end();
  };
  page->begin(Group{"table", t.title, {}, TextStyle{.size = layout.size, .anchor = Anchor::end}});
  double y = draw_head(t, layout, *page, box.x, top);
  for (const auto& cells : t.rows) {
    const Row row = measure(t, layout, cells);
    if (y + row.height > box.bottom()) {
      if (++block == blocks) {
        close();
        box = next(page);
        page->begin(Group{"table", t.title, {}, TextStyle{.size = layout.size, .anchor = Anchor::end}});
        top = box.y;
        block = 0;
        lowest = top;
      }
      y = draw_head(t, layout, *page, box.x + block * pitch, top);
    }
    draw_row(t, layout, row, cells, *page, box.x + block * pitch, y);
    y += row.height;
    const double left = box.x + block * pitch;
    rules.insert(rules.end(), {{left, y}, {left + layout.left.back() + layout.width.back(), y}, pen_up});
    lowest = std::max(lowest, y);
  }
  close();
  return lowest;
}

}  // namespace versine::report
