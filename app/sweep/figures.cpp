#include "app/sweep/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/run/run_report.h"
#include "core/base/frames.h"
#include "models/order_statistics.h"
#include "models/schema/wording.h"
#include "models/tables/number_text.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;
using Values = std::vector<double>;

struct ListStatistic {
  const char* word;
  double (*of)(const Values&);
};
double sum_of(const Values& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
constexpr std::array<ListStatistic, 5> kStatistics{
    {{"mean", [](const Values& v) { return v.empty() ? kUnset : sum_of(v) / static_cast<double>(v.size()); }},
     {"min", [](const Values& v) { return models::percentile(v, 0.0); }},
     {"max", [](const Values& v) { return models::percentile(v, 1.0); }},
     {"sum", sum_of},
     {"count", [](const Values& v) { return static_cast<double>(v.size()); }}}};

const ListStatistic* statistic_of(std::string_view word) {
  const auto at =
      std::find_if(kStatistics.begin(), kStatistics.end(), [&](const auto& one) { return word == one.word; });
  return at == kStatistics.end() ? nullptr : &*at;
}

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

// Follows a path, and collects the numbers at its end.
class PathWalk {
 public:
  explicit PathWalk(UnknownWord* misspelt) : misspelt_(misspelt) {}

  void walk(const Json& json, std::string_view path) {
    const std::size_t point = path.find('.');
    const std::string_view word = path.substr(0, point);
    const std::string_view rest = point == path.npos ? std::string_view() : path.substr(point + 1);
    if (json.is_array()) {
      walk_list(json, path, word, rest);
    } else if (json.is_object() && !path.empty() && json.contains(std::string(word))) {
      walk(json[std::string(word)], rest);
    } else if (!json.is_object() && path.empty()) {
      add(json);
    } else if (misspelt_ != nullptr && misspelt_->names.empty()) {
      *misspelt_ = {std::string(word),
                    json.is_object() ? models::advice(word, keys_of(json)) : "nothing is behind a number"};
    }
  }
  [[nodiscard]] double value(const ListStatistic* statistic) const {
    if (statistic == nullptr && !list_) return values_.empty() ? kUnset : values_.front();
    return (statistic != nullptr ? *statistic : kStatistics.front()).of(values_);
  }

 private:
  void walk_list(const Json& json, std::string_view path, std::string_view word, std::string_view rest) {
    if (const auto index = models::number_in<std::size_t>(word)) {
      if (*index < json.size()) walk(json[*index], rest);
      return;
    }
    list_ = true;
    for (const Json& one : json) {
      if (path.empty())
        values_.push_back(1.0);  // "presses.count"
      else
        walk(one, path);
    }
  }
  void add(const Json& json) {
    const double value = json.is_boolean()  ? static_cast<double>(json.get<bool>())
                         : json.is_number() ? json.get<double>()
                                            : kUnset;
    if (std::isfinite(value)) values_.push_back(value);
  }

  UnknownWord* misspelt_;
  Values values_;
  bool list_ = false;
};

}  // namespace

Json figures_json(const RunReport& r) {
  Json json{{"contacts", r.result.contacts},     {"simulated_s", r.result.simulated},
            {"times_held", r.result.times_held}, {"mode_changes", r.result.mode_changes},
            {"unsolved_steps", r.unsolved},      {"limits_crossed", r.crossed.size()}};
  for (int i = 0; i < kModes; ++i)
    json["modes_s"][std::string(mode_name(static_cast<Mode>(i)))] =
        r.result.mode_time.at(static_cast<std::size_t>(i));
  json.update(measured_json(r));
  return json;
}

double figure_at(const Json& json, const std::string& path, UnknownWord* misspelt) {
  const std::size_t point = path.rfind('.');
  const ListStatistic* statistic =
      point == std::string::npos ? nullptr : statistic_of(std::string_view(path).substr(point + 1));
  PathWalk found(misspelt);
  found.walk(json, std::string_view(path).substr(0, statistic != nullptr ? point : path.npos));
  return found.value(statistic);
}

}  // namespace enc::app
