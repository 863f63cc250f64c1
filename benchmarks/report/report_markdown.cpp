#include <algorithm>

#include <fmt/format.h>

#include "benchmarks/report/report.h"

namespace enc::bench {
namespace {

// Text that Markdown shall not take for anything else.
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

}  // namespace enc::bench
