#include "benchmarks/questionnaire/opinion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"

namespace enc::bench::questionnaire {
namespace {

std::string tenth(double x) { return std::isfinite(x) ? fmt::format("{:.1f}", x) : ""; }

}  // namespace

std::vector<ItemReference> items_of(const Form& form, const std::string& models) {
  std::vector<ItemReference> items;
  std::optional<Reference> means, groups;
  if (!form.reference.empty()) means = Reference::load(models, form.reference);
  if (!form.groups_reference.empty()) groups = Reference::load(models, form.groups_reference);
  for (const Item& item : form.items) {
    ItemReference one{item.name, item.text, kUnset, {}, {}};
    if (means) one.paper = means->number(means->row({{"item", item.name}}), "mean");
    one.with_experience.assign(form.experience.size(), kUnset);
    for (std::size_t row = 0; groups && row < groups->rows(); ++row)
      for (std::size_t e = 0; e < form.experience.size(); ++e)
        if (groups->text(row, "item") == item.name &&
            groups->text(row, "experience") == form.experience[e].name)
          one.with_experience[e] = groups->number(row, "mean");
    std::istringstream ids(item.figures);
    for (std::string id; ids >> id;) one.figures.push_back(id);
    items.push_back(std::move(one));
  }
  return items;
}

Table proxy_table(const std::vector<ItemReference>& items, const std::vector<FigureVerdict>& all) {
  Table table{
      "questionnaire",
      "Beside the questionnaire (Fig 14)",
      {"item", "asked", "paper's mean (1 .. 7)", "figure", "twin", "unit", "verdict"},
      {},
      "The questionnaire is not simulated: these figures measure what an item asks about, they do not answer "
      "it. `encounter questionnaire` asks people. Items that nothing here measures are left out."};
  for (const ItemReference& item : items)
    for (const std::string& id : item.figures) {
      const auto j =
          std::find_if(all.begin(), all.end(), [&](const FigureVerdict& one) { return one.figure.id == id; });
      if (j == all.end()) continue;
      table.rows.push_back({item.name, item.text, fmt::format("{:.1f}", item.paper), id,
                            fmt::format("{:.3g}", j->figure.twin), j->figure.unit, felt_name(j->felt)});
    }
  return table;
}

Opinion opinion_of(const Form& form, const std::vector<Answer>& rows, std::size_t item) {
  Opinion o;
  o.counts.assign(form.steps.size(), 0);
  int sum = 0;
  for (const Answer& a : rows) {
    const int points = a.points[item];
    ++o.counts[static_cast<std::size_t>(points - 1)];
    sum += points;
    o.least = o.least == 0 ? points : std::min(o.least, points);
    o.most = std::max(o.most, points);
  }
  if (!rows.empty()) o.mean = static_cast<double>(sum) / static_cast<double>(rows.size());
  return o;
}

double global_mean(const std::vector<Answer>& rows) {
  double sum = 0.0;
  double count = 0.0;
  for (const Answer& a : rows)
    for (const int points : a.points) {
      sum += points;
      count += 1.0;
    }
  return count > 0.0 ? sum / count : kUnset;
}

std::vector<Answer> with_experience(const std::vector<Answer>& rows, std::size_t experience, bool yes) {
  std::vector<Answer> some;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(some),
               [&](const Answer& a) { return (a.experience[experience] != 0) == yes; });
  return some;
}

Table opinion_table(const Form& form, const std::vector<ItemReference>& items,
                    const std::vector<Answer>& rows) {
  Table table{"answers",
              fmt::format("{}: {} {}", form.title, rows.size(), rows.size() == 1 ? "person" : "people"),
              {"item", "asked", "mean", "range"},
              {},
              "Points: 1, " + form.steps.front().text + ", to " + std::to_string(form.highest()) + ", " +
                  form.steps.back().text + "."};
  for (const Wording& step : form.steps) table.columns.push_back(step.name);
  table.columns.emplace_back("paper's mean");
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Opinion o = opinion_of(form, rows, i);
    std::vector<std::string> row{items[i].name, items[i].text, tenth(o.mean),
                                 o.most == 0 ? "" : fmt::format("{}-{}", o.least, o.most)};
    for (const std::size_t n : o.counts) row.push_back(std::to_string(n));
    row.push_back(tenth(items[i].paper));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table experience_table(const Form& form, const std::vector<ItemReference>& items,
                       const std::vector<Answer>& rows) {
  Table table{"answers_experience", "Means with and without experience", {"item"}};
  std::vector<std::vector<Answer>> groups;
  for (std::size_t e = 0; e < form.experience.size(); ++e)
    for (const bool yes : {true, false}) {
      groups.push_back(with_experience(rows, e, yes));
      table.columns.push_back(
          fmt::format("{}{} ({})", yes ? "" : "no ", form.experience[e].name, groups.back().size()));
    }
  std::vector<std::size_t> stated;  // experiences of which the study states a mean
  for (std::size_t e = 0; e < form.experience.size(); ++e)
    if (std::any_of(items.begin(), items.end(),
                    [&](const ItemReference& item) { return std::isfinite(item.with_experience[e]); })) {
      stated.push_back(e);
      table.columns.push_back("paper, " + form.experience[e].name);
    }
  for (std::size_t i = 0; i < form.items.size(); ++i) {
    std::vector<std::string> row{form.items[i].name};
    for (const std::vector<Answer>& group : groups) row.push_back(tenth(opinion_of(form, group, i).mean));
    for (const std::size_t e : stated) row.push_back(tenth(items[i].with_experience[e]));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Plot opinion_plot(const Form& form, const std::vector<ItemReference>& items,
                  const std::vector<Answer>& rows) {
  Plot plot{"answers",
            form.title,
            fmt::format("points, 1 to {}", form.highest()),
            "",
            false,
            false,
            {},
            fmt::format("Means of {} people for each item, bars: their range; the paper's means beside.",
                        rows.size())};
  // The axis shows the whole scale, whatever the answers.
  Series range{"range", {1.0, static_cast<double>(form.highest())}, {kUnset, kUnset}};
  Series mean{.name = fmt::format("mean of {}", rows.size()), .mark = Mark::points};
  Series paper{.name = "paper", .mark = Mark::points, .paper = true};
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Opinion o = opinion_of(form, rows, i);
    const auto y = static_cast<double>(i);
    plot.y_names.push_back(items[i].name + ". " + items[i].text);
    for (const double x : {static_cast<double>(o.least), static_cast<double>(o.most), kUnset}) {
      range.x.push_back(x);
      range.y.push_back(y);
    }
    mean.x.push_back(o.mean);
    mean.y.push_back(y);
    paper.x.push_back(items[i].paper);
    paper.y.push_back(y);
  }
  plot.series = {std::move(range), std::move(mean), std::move(paper)};
  return plot;
}

}  // namespace enc::bench::questionnaire
