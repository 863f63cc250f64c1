// What answers say: mean, range and counts of each item, as [VHMR Fig 14] shows them, with the published
// means beside; and what the twin measures of what people were asked. No answer is simulated: a figure stands
// beside an item, never in its place.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/questionnaire/questionnaire.h"
#include "benchmarks/verdict/verdict.h"

namespace enc::bench::questionnaire {

struct ItemReference {
  std::string name, text;
  double paper = kUnset;             // mean of the paper's participants, on its scale
  std::vector<std::string> figures;  // ids
};
// With the means of the study that the form names, if it names one.
[[nodiscard]] std::vector<ItemReference> items_of(const Form& form, const std::string& models);

// Without rows where none of the figures was judged.
[[nodiscard]] Table proxy_table(const std::vector<ItemReference>& items, const std::vector<Judged>& all);

struct Opinion {
  double mean = kUnset;
  int least = 0, most = 0;          // of the points; 0: nobody answered
  std::vector<std::size_t> counts;  // of each step
};
// Of one item.
[[nodiscard]] Opinion opinion_of(const Form& form, const std::vector<Answer>& rows, std::size_t item);
[[nodiscard]] double global_mean(const std::vector<Answer>& rows);
// Those who answered yes, or no, to having used `experience` before.
[[nodiscard]] std::vector<Answer> with_experience(const std::vector<Answer>& rows, std::size_t experience,
                                                  bool yes);

[[nodiscard]] Table opinion_table(const Form& form, const std::vector<ItemReference>& items,
                                  const std::vector<Answer>& rows);
// Means of people with and without each experience.
[[nodiscard]] Table experience_table(const Form& form, const std::vector<Answer>& rows);
[[nodiscard]] Plot opinion_plot(const Form& form, const std::vector<ItemReference>& items,
                                const std::vector<Answer>& rows);

}  // namespace enc::bench::questionnaire
