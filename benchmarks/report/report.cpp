#include "benchmarks/report/report.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/questionnaire/questionnaire.h"
#include "benchmarks/report/plot.h"
#include "sim/bodies/mujoco.h"
#include "trial/provenance/provenance.h"

namespace enc::bench {
namespace {

// One line each: a label and its value.
struct Fact {
  std::string name, value;
};

// Escapes text so that Markdown takes it literally.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      out += ' ';
      continue;
    }
    if (c == '<') {
      out += "&lt;";
      continue;
    }
    if (c == '|' || c == '*' || c == '`' || c == '\\' || c == '[' || c == ']') out += '\\';
    out += c;
  }
  return out;
}

std::string line(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + plain(cell) + " |";
  return text + "\n";
}

std::string markdown_table(const Table& t) {
  std::string text = line(t.columns) + "|";
  for (std::size_t i = 0; i < t.columns.size(); ++i) text += "---|";
  text += "\n";
  for (const auto& row : t.rows) text += line(row);
  return text + (t.note.empty() ? "" : "\n" + plain(t.note) + "\n");
}

std::string markdown_picture(const Report& report, const Plot& plot) {
  std::string text;
  if (report.drawings.contains(plot.id)) text = fmt::format("![{}]({}.svg)\n\n", plain(plot.title), plot.id);
  return text + fmt::format("{} ([data]({}.plot.csv))\n", plain(plot.caption), plot.id);
}

// A self-contained page: no script, no external link, pictures inside it.

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

// Accepts a range, too.
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

std::string cell(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : ""; }

// The measured value. Without a value, the column "holds" says whether one was expected.
std::string twin_cell(const Figure& f) {
  if (std::isnan(f.twin)) return "absent";
  return std::isfinite(f.twin) ? cell(f.twin) : "none";
}

// "0.2 .. 0.5", "at most 0.5", "at least 0.2"
std::string range(double low, double high) {
  if (std::isfinite(low) && std::isfinite(high)) return cell(low) + " .. " + cell(high);
  if (std::isfinite(high)) return "at most " + cell(high);
  return std::isfinite(low) ? "at least " + cell(low) : "";
}

std::size_t count(const BenchResult& result, bool (*is)(const Figure&)) {
  return static_cast<std::size_t>(std::count_if(result.figures.begin(), result.figures.end(), is));
}
bool bounded(const Figure& f) { return std::isfinite(f.low) || std::isfinite(f.high); }
bool failed(const Figure& f) { return !f.ok(); }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void drop_empty_columns(Table& table) {
  for (std::size_t c = table.columns.size(); c-- > 0;) {
    if (std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) { return !row[c].empty(); }))
      continue;
    const auto column = static_cast<std::ptrdiff_t>(c);
    table.columns.erase(table.columns.begin() + column);
    for (auto& row : table.rows) row.erase(row.begin() + column);
  }
}

std::string figures_line(const Report& report) {
  std::size_t figures = 0;
  std::size_t with_bounds = 0;
  std::vector<std::string> broken, missed;
  for (const BenchResult& result : report.results) {
    figures += result.figures.size();
    with_bounds += count(result, bounded);
    for (const Figure& f : result.figures) {
      if (!f.ok()) broken.push_back(f.id);
      if (misses(f)) missed.push_back(f.id);
    }
  }
  return fmt::format(
      "{}, {} of them with bounds; {}{}", figures, with_bounds,
      !broken.empty()          ? fmt::format("{} out of bounds: {}", broken.size(), joined(broken))
      : report.missing.empty() ? "all hold"
                               : "none out of bounds so far, but not all were measured",
      missed.empty() ? "" : fmt::format("; {} miss the paper: {}", missed.size(), joined(missed)));
}

// The part that both forms of the report share. Empty columns are left out.
Table overview_table(const Report& report) {
  Table table{
      "overview",
      "What was run",
      {"benchmark", "what", "scene", "figures", "bounded", "out of bounds", "simulated (s)", "run time (s)"}};
  double run_time = 0.0;
  for (const BenchResult& r : report.results) {
    const auto all = benchmarks();
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Benchmark& b) { return r.name == b.name; });
    run_time += r.run_time;
    table.rows.push_back({r.name, known == all.end() ? "" : known->what, r.scene,
                          std::to_string(r.figures.size()), std::to_string(count(r, bounded)),
                          std::to_string(count(r, failed)), fmt::format("{:.1f}", r.simulated),
                          fmt::format("{:.2f}", r.run_time)});
  }
  for (const std::string& name : report.missing)
    table.rows.push_back({name, "missing", "", "", "", "", "", ""});
  table.note = fmt::format("{:.1f} s in all.", run_time);
  return table;
}

Table contradiction_table(const std::vector<Contradiction>& contradictions) {
  Table table{"contradictions", "Where the paper contradicts itself", {"where", "printed", "found"}};
  for (const Contradiction& c : contradictions) table.rows.push_back({c.where, c.printed, c.found});
  table.note = "Computed from the printed numbers. None of these values is a target of any figure.";
  return table;
}

std::vector<Fact> facts(const Report& report) {
  std::vector<Fact> list{
      {"Made by", trial::program_words()},   {"Started", trial::time_text(report.started)},
      {"MuJoCo", sim::mujoco_version()},     {"Machine", trial::words_of(trial::this_machine())},
      {"Seed", std::to_string(report.seed)}, {"Command", report.command},
      {"Figures", figures_line(report)}};
  const std::string felt = verdict_line(judged(report.results, report.background.thresholds));
  if (!felt.empty()) list.push_back({"Felt or not", felt});
  if (!report.set.empty()) list.push_back({"With --set", joined(report.set)});
  if (!report.not_drawn.empty()) list.push_back({"Not drawn", report.not_drawn});
  if (!report.missing.empty()) list.push_back({"Missing", joined(report.missing)});
  return list;
}

// The tables after the benchmarks, in order. Empty tables are left out.
std::vector<Table> closing_tables(const Report& report) {
  const std::vector<FigureVerdict> all = judged(report.results, report.background.thresholds);
  std::vector<Table> tables{
      verdict_table(all), threshold_table(all),    questionnaire::proxy_table(report.background.items, all),
      role_table(report), predicted_table(report), contradiction_table(report.background.contradictions)};
  std::erase_if(tables, [](const Table& t) { return t.rows.empty(); });
  for (Table& t : tables) drop_empty_columns(t);
  return tables;
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

std::string report_markdown(const Report& report) {
  std::string text = "# Encounter: benchmark report\n\n";
  for (const Fact& fact : facts(report)) text += fmt::format("- **{}**: {}\n", fact.name, plain(fact.value));
  text += "\n" + markdown_table(overview_table(report));
  for (const Plot* plot : ordered_plots(report)) {
    text += fmt::format("\n## {}\n\n{}", plain(plot->title), markdown_picture(report, *plot));
  }
  for (const BenchResult& result : report.results) {
    text += fmt::format("\n## {}\n\n{}", plain(result.name), markdown_table(figure_table(result)));
    for (const Table& t : result.tables)
      if (t.source.empty()) text += fmt::format("\n### {}\n\n{}", plain(t.title), markdown_table(t));
    for (const Picture& p : result.pictures)
      text += fmt::format("\n![{0}]({1}.png)\n\n**{0}.** {2}\n", plain(p.title), p.id, plain(p.caption));
  }
  for (const Table& t : closing_tables(report)) {
    text += fmt::format("\n## {}\n\n", plain(t.title));
    if (t.id == report.verdict.id) text += markdown_picture(report, report.verdict) + "\n";
    text += markdown_table(t);
  }
  return text;
}

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

const char* role_name(Role role) {
  switch (role) {
    case Role::calibrated:
      return "calibrated";
    case Role::predicted:
      return "predicted";
    case Role::ours:
      break;
  }
  return "ours";
}

std::vector<const Plot*> ordered_plots(const Report& report) {
  std::vector<const Plot*> plots;
  for (const BenchResult& result : report.results)
    for (const Plot& plot : result.plots) plots.push_back(&plot);
  std::stable_partition(plots.begin(), plots.end(), [](const Plot* plot) {
    return std::any_of(plot->series.begin(), plot->series.end(), [](const Series& s) { return s.paper; });
  });
  return plots;
}

Table figure_table(const BenchResult& result) {
  Table table{result.name,
              "Figures of " + result.name,
              {"figure", "holds", "paper", "twin", "unit", "bounds", "difference", "difference (%)",
               "least .. most", "role", "note"}};
  for (const Figure& f : result.figures) {
    const double difference = f.twin - f.paper;
    const double percent = f.paper != 0.0 ? 100.0 * difference / std::abs(f.paper) : kUnset;
    const char* holds = f.absent ? "" : !f.ok() ? "NO" : misses(f) ? "yes, misses" : "yes";
    table.rows.push_back({f.id, holds, cell(f.paper), twin_cell(f), f.unit, range(f.low, f.high),
                          std::isfinite(difference) ? fmt::format("{:+.3g}", difference) : "",
                          std::isfinite(percent) ? fmt::format("{:+.1f}", percent) : "",
                          range(f.least, f.most), role_name(f.role), f.note});
  }
  table.note =
      fmt::format("Scene {}; {}{:.2f} s.{}", result.scene,
                  result.simulated > 0.0 ? fmt::format("{:.1f} s simulated in ", result.simulated) : "",
                  result.run_time, result.note.empty() ? "" : " " + result.note);
  drop_empty_columns(table);
  return table;
}

Table role_table(const Report& report) {
  Table table{"roles",
              "Calibrated and predicted",
              {"role", "figures", "hold", "beside the paper's, bounded", "miss it", "which"}};
  for (const Role role : {Role::calibrated, Role::predicted, Role::ours}) {
    std::size_t figures = 0, hold = 0, beside = 0, missed = 0;
    std::vector<std::string> ids;
    for (const BenchResult& result : report.results)
      for (const Figure& f : result.figures) {
        if (f.role != role) continue;
        ++figures;
        hold += f.ok() && !f.absent ? 1 : 0;
        beside += std::isfinite(f.paper) && bounded(f) ? 1 : 0;
        missed += misses(f) ? 1 : 0;
        if (role != Role::ours) ids.push_back(misses(f) ? f.id + " (misses)" : f.id);
      }
    table.rows.push_back({role_name(role), std::to_string(figures), std::to_string(hold),
                          std::to_string(beside), std::to_string(missed),
                          role == Role::ours ? "all others" : joined(ids)});
  }
  table.note =
      "Calibrated: the paper's value set a parameter, so that agreement is no merit. Predicted: it did not. "
      "Ours: the paper has no such value. Misses: the bounds exclude the paper's value.";
  return table;
}

Table predicted_table(const Report& report) {
  Table table{"predicted",
              "Predicted, bounded and the paper's",
              {"figure", "paper", "twin", "unit", "bounds", "misses by", "least .. most"}};
  std::size_t missed = 0;
  for (const BenchResult& result : report.results)
    for (const Figure& f : result.figures) {
      if (f.role != Role::predicted || !std::isfinite(f.paper) || !bounded(f)) continue;
      missed += misses(f) ? 1 : 0;
      table.rows.push_back({f.id, cell(f.paper), twin_cell(f), f.unit, range(f.low, f.high),
                            misses(f) ? fmt::format("{:+.3g}", miss_of(f)) : "", range(f.least, f.most)});
    }
  table.note = fmt::format(
      "{} figures, of which {} miss the paper: the paper has the value, it set no parameter of the twin, and "
      "the twin's value is bounded.",
      table.rows.size(), missed);
  return table;
}

Background load_background(const std::string& models) {
  return {contradictions(models), load_thresholds(models),
          questionnaire::items_of(questionnaire::load_form(models, "vhmr_2020"), models)};
}

void add_result(Report& report, BenchResult result) {
  std::erase(report.missing, result.name);
  const auto add = [&](const Plot& plot) {
    Drawing drawing = draw(plot);
    if (drawing.svg.empty())
      report.not_drawn = drawing.why_not;
    else
      report.drawings[plot.id] = std::move(drawing.svg);
  };
  for (const Plot& plot : result.plots) add(plot);
  report.results.push_back(std::move(result));
  report.verdict = verdict_plot(judged(report.results, report.background.thresholds));
  if (!report.verdict.y_names.empty()) add(report.verdict);
}

}  // namespace enc::bench
