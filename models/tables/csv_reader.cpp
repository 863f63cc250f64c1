#include "models/tables/csv_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"

namespace enc::models {

CsvReader::CsvReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

bool CsvReader::next_line(std::string_view& line) {
  line = {};
  if (text_.empty()) return false;
  const std::size_t end = std::min(text_.find('\n'), text_.size());
  line = text_.substr(0, end);
  text_.remove_prefix(std::min(end + 1, text_.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++line_;
  return true;
}

void CsvReader::split(std::string_view line) {
  cells_.clear();
  for (std::size_t at = 0;;) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    std::string_view text = line.substr(at, comma - at);
    std::size_t place = at + 1;
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1), ++place;
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    cells_.push_back({text, place});
    if (comma == line.size()) return;
    at = comma + 1;
  }
}

std::size_t CsvReader::find(std::string_view column, bool needed) const {
  const auto is = [&](const Cell& cell) { return cell.text == column; };
  const auto found = std::find_if(cells_.begin(), cells_.end(), is);
  if (found == cells_.end()) {
    if (!needed) return cells_.size();
    if (cells_.size() == 1 && cells_[0].text.find(';') != std::string_view::npos)
      fail_line("the cells are parted by ';'; expected commas, and points in the numbers; export it so");
    std::vector<std::string> names;
    names.reserve(cells_.size());
    for (const Cell& cell : cells_) names.emplace_back(cell.text);
    const std::string near = nearest_name(column, names);
    const auto factor = factor_between(near, column);
    std::string advice = "name the columns in the first line";
    if (!near.empty()) advice = fmt::format("rename {}", quoted(near));
    if (factor && *factor != 1.0)
      advice = fmt::format("multiply {} by {:.6g} and call it '{}'", quoted(near), *factor, column);
    fail_line(fmt::format("there is no column '{}'; expected a header with {}; {}", column, wanted_, advice));
  }
  if (std::find_if(found + 1, cells_.end(), is) != cells_.end())
    fail_line(fmt::format("there are two columns '{}'; expected one; rename the other", column));
  return static_cast<std::size_t>(found - cells_.begin());
}

void CsvReader::header(const std::vector<std::string_view>& needed,
                       const std::vector<std::string_view>& optional) {
  std::string_view line;
  while (next_line(line) && (line.empty() || line.front() == '#')) {
    while (!line.empty() && (line.front() == '#' || line.front() == ' ')) line.remove_prefix(1);
    remark_ += (remark_.empty() || line.empty() ? "" : " ") + std::string(line);
  }
  split(line);
  wanted_ = fmt::format("{}", fmt::join(needed, ", "));
  for (const std::string_view name : needed) at_.push_back(find(name, true));
  for (const std::string_view name : optional) at_.push_back(find(name, false));
  names_ = needed;
  names_.insert(names_.end(), optional.begin(), optional.end());
  columns_ = cells_.size();
}

bool CsvReader::next() {
  std::string_view line;
  do
    if (!next_line(line)) return false;
  while (line.empty());
  split(line);
  if (cells_.size() != columns_)
    fail_at(line_, cells_.back().place,
            fmt::format("this row has {} columns; expected {} as in the header; correct or remove it",
                        cells_.size(), columns_));
  return true;
}

std::string_view CsvReader::text(std::size_t column) const {
  return has(column) ? cells_[at_[column]].text : std::string_view{};
}

double CsvReader::number(std::size_t column) const {
  const std::string_view text = this->text(column);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, bad] = std::from_chars(text.data(), end, value);
  if (bad != std::errc() || stop != end || !std::isfinite(value))
    fail(column, fmt::format("'{}' is {}; expected a finite number such as 1.25; correct or remove the row",
                             names_[column], quoted(std::string(text))));
  return value;
}

void CsvReader::fail(std::size_t column, const std::string& what) const {
  fail_at(line_, cells_[at_[column]].place, what);
}
void CsvReader::fail_line(const std::string& what) const { fail_at(line_, 1, what); }
void CsvReader::fail_line(std::size_t line, const std::string& what) const { fail_at(line, 1, what); }
void CsvReader::fail_at(std::size_t line, std::size_t place, const std::string& what) const {
  throw Error(fmt::format("{}:{}:{}: {}", name_, std::max<std::size_t>(line, 1), place, what));
}

std::string_view csv_header(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (!line.empty() && line.front() != '#' && line != "\r") return line;
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return text;
}

std::string csv_text(const std::string& path, const std::string& kind, const std::string& wanted) {
  constexpr std::size_t kLongest = 1U << 30U;         // bytes
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // some programs write it before UTF-8
  std::string why, text = read_file(path, kLongest, why);
  if (!why.empty())
    throw Error(
        fmt::format("{}:1:1: cannot read this {}: {}; expected {}; check the name", path, kind, why, wanted));
  if (text.starts_with(kMark)) text.erase(0, kMark.size());
  return text;
}

}  // namespace enc::models
