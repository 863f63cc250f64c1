// What answers say: mean, range and counts of each item, as [VHMR Fig 14] shows them, with the published
// means beside.
#pragma once

#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/questionnaire/answers.h"
#include "benchmarks/questionnaire/proxies.h"

namespace enc::bench::questionnaire {

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
