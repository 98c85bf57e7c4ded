// SPDX-License-Identifier: Apache-2.0
#include "versine/report/pdf.hpp"

#include <cairo-pdf.h>
#include <cairo.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <memory>

namespace versine::report {

namespace {

constexpr double points_per_mm = 72.0 / 25.4;

struct Release {
  void operator()(cairo_surface_t* p) const { cairo_surface_destroy(p); }
  void operator()(cairo_t* p) const { cairo_destroy(p); }
  void operator()(PangoLayout* p) const { g_object_unref(p); }
  void operator()(PangoFontDescription* p) const { pango_font_description_free(p); }
};
template <class T>
using Owned = std::unique_ptr<T, Release>;

class Painter {
 public:
  explicit Painter(cairo_t* cr) : cr_(cr), layout_(pango_cairo_create_layout(cr)), font_(pango_font_description_new()) {
    pango_font_description_set_family(font_.get(), "DejaVu Sans,Noto Sans CJK SC,sans-serif");
    // Text is laid out at a hundred times its size: Pango rounds advances to whole units of the device.
    pango_cairo_context_set_resolution(pango_layout_get_context(layout_.get()), 72.0);
  }

  void operator()(const Path& p) {
    trace(p);
    if (p.fill) {
      colour(p.fill->colour, p.fill->opacity);
      p.pen ? cairo_fill_preserve(cr_) : cairo_fill(cr_);
    }
    if (p.pen) {
      colour(p.pen->colour, 1.0);
      cairo_set_line_width(cr_, p.pen->width);
      constexpr double dashes[] = {1.5, 0.8}, dots[] = {0.3, 0.6};
      if (p.pen->dash == Dash::solid) cairo_set_dash(cr_, nullptr, 0, 0);
      if (p.pen->dash == Dash::dashed) cairo_set_dash(cr_, dashes, 2, 0);
      if (p.pen->dash == Dash::dotted) cairo_set_dash(cr_, dots, 2, 0);
      cairo_stroke(cr_);
    }
  }

  void operator()(const TextItem& t) {
    if (t.text.empty()) return;
    constexpr double magnified = 100.0;  // Pango rounds the advances of small fonts
    if (t.style.size != size_ || t.style.bold != bold_) {
      size_ = t.style.size;
      bold_ = t.style.bold;
      pango_font_description_set_absolute_size(font_.get(), size_ * magnified * PANGO_SCALE);
      pango_font_description_set_weight(font_.get(), bold_ ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
      pango_layout_set_font_description(layout_.get(), font_.get());
    }
    pango_layout_set_text(layout_.get(), t.text.c_str(), static_cast<int>(t.text.size()));
    PangoLayoutLine* line = pango_layout_get_line_readonly(layout_.get(), 0);
    double shift = 0.0;
    if (t.style.anchor != Anchor::start) {
      PangoRectangle extent;
      pango_layout_line_get_extents(line, nullptr, &extent);
      shift = extent.width / double(PANGO_SCALE) / magnified * (t.style.anchor == Anchor::end ? 1.0 : 0.5);
    }
    cairo_save(cr_);
    colour(t.style.colour, 1.0);
    cairo_translate(cr_, t.at.x, t.at.y);
    if (!t.style.upright) cairo_rotate(cr_, -std::acos(-1.0) / 2.0);
    cairo_translate(cr_, -shift, 0.0);
    cairo_scale(cr_, 1.0 / magnified, 1.0 / magnified);
    cairo_move_to(cr_, 0.0, 0.0);
    pango_cairo_show_layout_line(cr_, line);
    cairo_restore(cr_);
    cairo_new_path(cr_);  // showing text leaves a current point
  }

  void operator()(const Clip& c) {
    cairo_save(cr_);
    cairo_rectangle(cr_, c.box.x, c.box.y, c.box.width, c.box.height);
    cairo_clip(cr_);
    ++depth_;
  }
  void operator()(const Group&) {
    cairo_save(cr_);
    ++depth_;
  }
  void operator()(const End&) {
    if (depth_ == 0) return;
    cairo_restore(cr_);
    --depth_;
  }
  void finish() {
    while (depth_ > 0) (*this)(End{});
  }

 private:
  void colour(std::uint32_t rgb, double opacity) {
    cairo_set_source_rgba(cr_, ((rgb >> 16) & 255) / 255.0, ((rgb >> 8) & 255) / 255.0, (rgb & 255) / 255.0, opacity);
  }
  void trace(const Path& p) {
    cairo_new_path(cr_);
    bool down = false;
    for (const Point& q : p.points) {
      if (!std::isfinite(q.x) || !std::isfinite(q.y)) {
        down = false;
        continue;
      }
      down ? cairo_line_to(cr_, q.x, q.y) : cairo_move_to(cr_, q.x, q.y);
      down = true;
    }
    if (p.closed) cairo_close_path(cr_);
  }

  cairo_t* cr_;
  Owned<PangoLayout> layout_;
  Owned<PangoFontDescription> font_;
  double size_ = 0.0;
  bool bold_ = false;
  int depth_ = 0;
};

}  // namespace

Expected<void> write_pdf(const std::filesystem::path& path, const std::vector<PdfPage>& pages, const PdfInfo& info) {
  if (pages.empty()) return fail({.file = path.string(), .found = "a document without pages"});
  constexpr double width = 297.0, height = 210.0;  // A4 landscape, mm
  const Owned<cairo_surface_t> surface(
      cairo_pdf_surface_create(path.string().c_str(), width * points_per_mm, height * points_per_mm));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, info.title.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_SUBJECT, info.subject.c_str());
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATOR, "Versine");
  if (!info.created.empty()) {
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, info.created.c_str());
  }
  {
    const Owned<cairo_t> cr(cairo_create(surface.get()));
    cairo_set_line_join(cr.get(), CAIRO_LINE_JOIN_ROUND);
    Painter painter(cr.get());
    int number = 0;
    for (const PdfPage& page : pages) {
      ++number;
      if (!page.bookmark.empty()) {
        const std::string target = "page=" + std::to_string(number);
        cairo_pdf_surface_add_outline(surface.get(), CAIRO_PDF_OUTLINE_ROOT, page.bookmark.c_str(), target.c_str(),
                                      cairo_pdf_outline_flags_t{});
      }
      cairo_save(cr.get());
      cairo_scale(cr.get(), points_per_mm, points_per_mm);
      cairo_translate(cr.get(), 0.5 * (width - page.drawing->width), 0.5 * (height - page.drawing->height));
      for (const Item& item : page.drawing->items) std::visit(painter, item);
      painter.finish();
      cairo_restore(cr.get());
      cairo_show_page(cr.get());
    }
  }
  cairo_surface_finish(surface.get());
  if (const cairo_status_t status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS) {
    return fail({.file = path.string(),
                 .found = cairo_status_to_string(status),
                 .expected = "a writable place with free space",
                 .advice = "check permissions and free space"});
  }
  return {};
}

}  // namespace versine::report
