#include "benchmarks/commands/committed_results.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace enc::bench {
namespace {

constexpr const char* kFile = "figures.csv";
constexpr double kDigits = 1e-3;  // the rounding of a value kept with four digits

// Within the span of the second run, which may be a single value.
bool within(double value, double single, double least, double most) {
  const double low = std::isfinite(least) ? least : single, high = std::isfinite(most) ? most : single;
  const double room = kDigits * std::max(std::abs(low), std::abs(high));
  return value >= low - room && value <= high + room;
}

double number_or_unset(const Reference& table, std::size_t row, std::string_view column) {
  return table.text(row, column).empty() ? kUnset : table.number(row, column);
}

}  // namespace

CommittedResults CommittedResults::load(const std::string& models) {
  if (!std::filesystem::exists(models + "/../benchmarks/reference/" + kFile)) return {};
  CommittedResults all;
  all.take(Reference::load(models, kFile));
  return all;
}

CommittedResults CommittedResults::parse(std::string_view text, const std::string& name) {
  CommittedResults all;
  all.take(Reference::parse(text, name));
  return all;
}

void CommittedResults::take(const Reference& table) {
  for (std::size_t row = 0; row < table.rows(); ++row)
    all_[table.text(row, "id")] = {number_or_unset(table, row, "value"), number_or_unset(table, row, "least"),
                                   number_or_unset(table, row, "most"), table.text(row, "commit"),
                                   !table.text(row, "low").empty() || !table.text(row, "high").empty()};
}

std::vector<std::string> CommittedResults::bounded(const std::string& benchmark) const {
  std::vector<std::string> ids;
  for (const auto& [id, figure] : all_)
    if (figure.bounded && id.starts_with(benchmark + ".")) ids.push_back(id);
  return ids;
}

const CommittedFigure* CommittedResults::find(const std::string& id) const {
  const auto at = all_.find(id);
  return at == all_.end() ? nullptr : &at->second;
}

bool CommittedResults::differs(const Figure& figure) const {
  const CommittedFigure* then = find(figure.id);
  if (then == nullptr || figure.cost || figure.absent) return false;
  if (std::isnan(figure.twin) || std::isnan(then->value))
    return std::isnan(figure.twin) != std::isnan(then->value);
  if (std::isfinite(figure.high) && std::abs(figure.twin - then->value) < 1e-6 * std::abs(figure.high))
    return false;  // rounding, far below what is asked
  return !within(figure.twin, then->value, then->least, then->most) &&
         !within(then->value, figure.twin, figure.least, figure.most);
}

}  // namespace enc::bench
