#include "benchmarks/questionnaire/proxies.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"

namespace enc::bench::questionnaire {

std::vector<ItemReference> items_of(const Form& form, const std::string& models) {
  std::vector<ItemReference> items;
  std::optional<Reference> means;
  if (!form.reference.empty()) means = Reference::load(models, form.reference);
  for (const Item& item : form.items) {
    ItemReference one{item.name, item.text, kUnset, {}};
    if (means) one.paper = means->number(means->row({{"item", item.name}}), "mean");
    std::istringstream ids(item.figures);
    for (std::string id; ids >> id;) one.figures.push_back(id);
    items.push_back(std::move(one));
  }
  return items;
}

Table proxy_table(const std::vector<ItemReference>& items, const std::vector<Judged>& all) {
  Table table{
      "questionnaire",
      "Beside the questionnaire (Fig 14)",
      {"item", "asked", "paper's mean (1 .. 7)", "figure", "twin", "unit", "verdict"},
      {},
      "The questionnaire is not simulated: these figures measure what an item asks about, they do not "
      "answer it. `encounter questionnaire` asks people. Items that nothing here measures are left out."};
  for (const ItemReference& item : items)
    for (const std::string& id : item.figures) {
      const auto j =
          std::find_if(all.begin(), all.end(), [&](const Judged& one) { return one.figure.id == id; });
      if (j == all.end()) continue;
      table.rows.push_back({item.name, item.text, fmt::format("{:.1f}", item.paper), id,
                            fmt::format("{:.3g}", j->figure.twin), j->figure.unit, felt_name(j->felt)});
    }
  return table;
}

}  // namespace enc::bench::questionnaire
