// One page that needs nothing but itself: no script, no link out, pictures in it.
#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "benchmarks/report/plot.h"
#include "benchmarks/report/report.h"

namespace enc::bench {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Encounter: benchmark report</title>
<style>
:root { color-scheme: light }
body { margin: 0 auto; padding: 1rem; max-width: 84rem; background: #fff; color: #1a1a1a;
  font: 16px/1.5 system-ui, sans-serif }
h1, h2, h3 { line-height: 1.2; margin: 1.8em 0 .5em }
h1 { margin-top: .5em }
h2 { border-bottom: 1px solid #ccc; padding-bottom: .2em }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1rem; margin: 0 }
dt { color: #555 }
dd { margin: 0; overflow-wrap: anywhere }
nav a { margin-right: 1rem }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 34rem), 1fr)); gap: 1.5rem }
.one { max-width: 60rem; margin-bottom: 1rem }
figure { margin: 0; border: 1px solid #ddd; border-radius: 6px; padding: .5rem }
figure svg, figure img { display: block; width: 100%; height: auto }
figcaption { padding: .5rem; font-size: .9rem }
.wide { overflow-x: auto }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums }
th, td { padding: .25rem .6rem; text-align: left; vertical-align: top; border-bottom: 1px solid #e5e5e5 }
th { background: #f4f4f4; white-space: nowrap }
td.n { text-align: right; white-space: nowrap }
td:first-child { overflow-wrap: anywhere; min-width: 9rem }
tr.no td { background: #fdecea }
.missing { border-left: 4px solid #c00; padding: .5rem 1rem; background: #fdecea }
.note { font-size: .9rem; color: #444; max-width: 60rem }
@media screen and (max-width: 48rem) { .wide table, .wide tbody, .wide tr { display: block } .wide thead { display: none }
  .wide tr { border: 1px solid #ddd; border-radius: 6px; margin-bottom: .6rem; padding: .3rem .6rem }
  .wide td, .wide td.n { display: grid; grid-template-columns: 7rem 1fr; gap: .6rem; border: 0; padding: .1rem 0; text-align: left;
    white-space: normal; overflow-wrap: anywhere; min-width: 0 }
  .wide td::before { content: attr(data-column); color: #555 }
  .wide td:empty { display: none } }
@media (max-width: 40rem) { dl { grid-template-columns: 1fr } dd { margin-bottom: .4rem } body { padding: .6rem } }
@media print { html { font-size: 10pt } body { max-width: none; padding: 0; font-size: 10pt } .wide { overflow: visible } nav { display: none }
  table { font-size: 7pt } th { white-space: normal } tr, figure { break-inside: avoid } h2, h3 { break-after: avoid }
  .plots { grid-template-columns: 1fr 1fr } }
</style>
</head>
<body>
)";

std::string escaped(const std::string& text) {
  std::string out;
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
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

// Also of a range.
bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("+-0123456789.e ") == std::string::npos &&
         text.find_first_of("0123456789") != std::string::npos;
}

std::string html_table(const Table& t) {
  std::string text = "<div class=\"wide\"><table>\n<thead><tr>";
  for (const std::string& column : t.columns) text += "<th>" + escaped(column) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : t.rows) {
    const bool no = std::find(row.begin(), row.end(), "NO") != row.end();
    text += no ? "<tr class=\"no\">" : "<tr>";
    for (std::size_t i = 0; i < row.size();
         ++i)  // on a narrow screen each cell stands in a line, with its column's name
      text += fmt::format("<td{} data-column=\"{}\">{}</td>", is_number(row[i]) ? " class=\"n\"" : "",
                          i < t.columns.size() ? escaped(t.columns[i]) : "", escaped(row[i]));
    text += "</tr>\n";
  }
  text += "</tbody></table></div>\n";
  return text + (t.note.empty() ? "" : "<p class=\"note\">" + escaped(t.note) + "</p>\n");
}

std::string head(const Report& report) {
  std::string text = std::string(kHead) + "<h1>Encounter: benchmark report</h1>\n";
  if (!report.missing.empty()) {
    text += "<p class=\"missing\"><strong>Not complete.</strong> Missing:";
    for (const std::string& name : report.missing) text += " " + escaped(name);
    text += "</p>\n";
  }
  text += "<dl>\n";
  for (const Fact& fact : facts(report))
    text += "<dt>" + escaped(fact.name) + "</dt><dd>" + escaped(fact.value) + "</dd>\n";
  text += "</dl>\n<nav><p>";
  for (const BenchResult& r : report.results)
    text += fmt::format("<a href=\"#{0}\">{0}</a>", escaped(r.name));
  for (const Table& t : closing_tables(report))
    text += fmt::format("<a href=\"#{}\">{}</a>", escaped(t.id), escaped(t.title));
  return text + "</p></nav>\n";
}

std::string html_picture(const Report& report, const Plot& plot) {
  const auto svg = report.drawings.find(plot.id);
  if (svg == report.drawings.end()) return {};
  return fmt::format(
      "<figure id=\"plot.{}\">\n{}\n<figcaption><strong>{}.</strong> {}</figcaption>\n</figure>\n",
      escaped(plot.id), svg_for_page(svg->second, plot.id), escaped(plot.title), escaped(plot.caption));
}

// RFC 4648: the page is one file.
std::string base64(const std::string& bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kLetters[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

std::string html_image(const Picture& picture) {
  return fmt::format(
      "<figure id=\"picture.{}\">\n<img alt=\"{}\" src=\"data:image/png;base64,{}\">\n"
      "<figcaption><strong>{}.</strong> {}</figcaption>\n</figure>\n",
      escaped(picture.id), escaped(picture.title), base64(picture.png), escaped(picture.title),
      escaped(picture.caption));
}

std::string plots(const Report& report) {
  std::string text;
  for (const Plot* plot : ordered_plots(report)) text += html_picture(report, *plot);
  if (text.empty()) return {};
  return "<h2>Plots</h2>\n<p class=\"note\">Black, open circles or dashed: the paper. Colours: the twin. "
         "Crosses at the "
         "upper edge: failed.</p>\n<div class=\"plots\">\n" +
         text + "</div>\n";
}

}  // namespace

std::string report_html(const Report& report) {
  std::string text = head(report) + plots(report);
  text += "<h2>What was run</h2>\n" + html_table(overview_table(report));
  for (const BenchResult& result : report.results) {
    text +=
        fmt::format("<h2 id=\"{0}\">{0}</h2>\n{1}", escaped(result.name), html_table(figure_table(result)));
    for (const Table& t : result.tables)
      if (t.source.empty()) text += "<h3>" + escaped(t.title) + "</h3>\n" + html_table(t);
    for (const Picture& picture : result.pictures) text += html_image(picture);
  }
  for (const Table& t : closing_tables(report)) {
    text += fmt::format("<h2 id=\"{}\">{}</h2>\n", escaped(t.id), escaped(t.title));
    if (t.id == report.verdict.id)
      text += "<div class=\"one\">" + html_picture(report, report.verdict) + "</div>\n";
    text += html_table(t);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace enc::bench
