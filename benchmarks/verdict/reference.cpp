#include "benchmarks/verdict/reference.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::bench {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

Reference Reference::load(const std::string& models, const std::string& name) {
  const std::string path = models + "/../benchmarks/reference/" + name;
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw Error(path + ": cannot be read; expected the paper's values; restore the file");
  return parse(text.str(), name);
}

Reference Reference::parse(std::string_view text, const std::string& name) {
  Reference table;
  table.name_ = name;
  std::istringstream in{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    if (line.front() == '#') {
      table.source_ += (table.source_.empty() ? "" : " ") + line.substr(line.find_first_not_of("# "));
      continue;
    }
    std::vector<std::string> cells = split(line);
    if (table.columns_.empty()) {
      table.columns_ = std::move(cells);
      continue;
    }
    if (cells.size() != table.columns_.size())
      throw Error(fmt::format("{}:{}:1: {} cells; expected {} as in the header; write one for each column",
                              name, number, cells.size(), table.columns_.size()));
    table.cells_.push_back(std::move(cells));
  }
  if (table.cells_.empty()) throw Error(name + ":1:1: no rows; expected a header and rows; add them");
  return table;
}

const std::string& Reference::text(std::size_t row, std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) throw Error(fmt::format("{}: no column '{}'", name_, column));
  return cells_.at(row).at(static_cast<std::size_t>(found - columns_.begin()));
}

double Reference::number(std::size_t row, std::string_view column) const {
  const std::string& cell = text(row, column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    throw Error(
        fmt::format("{}: column '{}' of row {} is '{}'; expected a number", name_, column, row + 1, cell));
  return value;
}

std::size_t Reference::row(const std::vector<CellMatch>& where) const {
  for (std::size_t i = 0; i < rows(); ++i)
    if (std::all_of(where.begin(), where.end(),
                    [&](const CellMatch& w) { return text(i, w.column) == w.is; }))
      return i;
  throw Error(fmt::format("{}: no row with {} '{}'", name_, where.front().column, where.front().is));
}

}  // namespace enc::bench
