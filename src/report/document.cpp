// SPDX-License-Identifier: Apache-2.0
#include "versine/report/document.hpp"

#include <fmt/format.h>

#include "colours.hpp"
#include "versine/report/pdf.hpp"
#include "versine/report/svg.hpp"

namespace versine::report {

namespace {

constexpr double head = 11.0, foot = 10.5;  // mm
using colours::accent, colours::muted;

// The sheet on the screen, and A4 landscape on paper. Verdana has the widths of DejaVu Sans.
constexpr const char* style = R"(
:root{color-scheme:light}
body{margin:0;background:#e9edf1;color:#1b1f24;font:15px/1.45 "DejaVu Sans",Verdana,"Noto Sans CJK SC","Microsoft YaHei","PingFang SC",sans-serif}
nav{position:sticky;top:0;background:#fff;border-bottom:1px solid #d0d7de;padding:.5rem 1rem;display:flex;flex-wrap:wrap;gap:.25rem 1.1rem;align-items:baseline}
nav strong{margin-right:.6rem}
nav a{color:#0b5fa5;text-decoration:none}
nav a:hover,nav a:focus-visible{text-decoration:underline}
section{scroll-margin-top:3.5rem}
h2{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%);margin:0}
.sheet{margin:1rem auto;width:min(96vw,1500px);background:#fff;box-shadow:0 1px 5px #0003;padding:1.2%;box-sizing:border-box}
.sheet>svg{display:block;width:100%;height:auto;font-family:inherit;overflow:visible}
path{stroke-linejoin:round}
@page{size:A4 landscape;margin:8mm}
@media print{body{background:#fff}nav{display:none}.sheet{margin:0;width:281mm;height:193mm;padding:0;box-shadow:none;break-after:page;overflow:hidden}section:last-of-type .sheet:last-of-type{break-after:auto}}
)";

void draw_frame(Drawing& d, const Document& doc, const Section& section, const std::string& page_number) {
  const double bottom = d.height;
  d.text({0.0, 4.6}, fitted(doc.subject.empty() ? doc.title : doc.subject, 0.55 * d.width, 3.4, true),
         {.size = 3.4, .bold = true});
  d.text({d.width, 4.6}, section.title, {.size = 3.4, .anchor = Anchor::end, .bold = true, .colour = accent});
  d.line({0.0, 7.0}, {d.width, 7.0}, {accent, 0.5, Dash::solid});
  d.line({0.0, bottom - 8.2}, {d.width, bottom - 8.2}, {colours::rule, 0.2, Dash::solid});
  d.text({0.0, bottom - 4.8}, fitted(doc.footer, d.width, 2.15), {.size = 2.15, .colour = muted});
  d.text({0.0, bottom - 1.2}, fitted(doc.source, d.width - 40.0, 2.15), {.size = 2.15, .colour = muted});
  d.text({d.width, bottom - 1.2}, page_number, {.size = 2.4, .anchor = Anchor::end, .colour = muted});
}

}  // namespace

Box content_box(const Drawing& page) {
  return {0.0, head, page.width, page.height - head - foot};
}

void finish(Document& document, const Texts& texts) {
  std::size_t total = 0, number = 0;
  for (const Section& s : document.sections) total += s.pages.size();
  for (Section& s : document.sections) {
    for (Drawing& page : s.pages) {
      draw_frame(page, document, s, fmt::format(fmt::runtime(texts("page.number")), ++number, total));
    }
  }
}

std::string to_html(const Document& document, const Texts& texts) {
  const std::string title =
      escaped(document.subject.empty() ? document.title : document.subject + " \xE2\x80\x93 " + document.title);
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"{}\">\n<head><meta charset=\"utf-8\"/>"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\"/>"
      "<meta name=\"generator\" content=\"Versine\"/><title>{}</title>\n<style>{}</style></head>\n<body>\n"
      "<nav aria-label=\"{}\"><strong>{}</strong>",
      document.language, title, style, escaped(texts("page.contents")), title);
  for (const Section& s : document.sections) {
    html += fmt::format("<a href=\"#{}\">{}</a>", s.id, escaped(s.title));
  }
  html += "</nav>\n<main>\n";
  for (const Section& s : document.sections) {
    html += fmt::format("<section id=\"{0}\" aria-label=\"{1}\"><h2>{1}</h2>\n", s.id, escaped(s.title));
    for (const Drawing& page : s.pages) html += "<div class=\"sheet\">" + to_svg(page) + "</div>\n";
    html += "</section>\n";
  }
  return html + "</main>\n</body>\n</html>\n";
}

Expected<void> write_document_pdf(const std::filesystem::path& path, const Document& document) {
  std::vector<PdfPage> pages;
  for (const Section& s : document.sections) {
    for (std::size_t i = 0; i < s.pages.size(); ++i) pages.push_back({&s.pages[i], i == 0 ? s.title : std::string()});
  }
  return write_pdf(path, pages,
                   {.title = document.subject.empty() ? document.title : document.subject,
                    .subject = document.title,
                    .created = document.created});
}

}  // namespace versine::report
