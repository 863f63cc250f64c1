// Summary of the answers: mean, range and counts of each item, as [VHMR Fig 14] shows them, beside the
// published means and the twin's figures on the question. No answer is simulated: a figure stands beside an
// item, never in its place.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/questionnaire/questionnaire.h"
#include "benchmarks/verdict/verdict.h"

namespace enc::bench::questionnaire {

struct ItemReference {
  std::string name, text;
  double paper = kUnset;  // mean of the paper's participants, on its scale
  std::vector<double>
      with_experience{};             // the same of those with each experience of the form; unset: not stated
  std::vector<std::string> figures;  // ids
};
// Includes the means of the study that the form names, if it names one.
[[nodiscard]] std::vector<ItemReference> items_of(const Form& form, const std::string& models);

// Empty if no figure was judged.
[[nodiscard]] Table proxy_table(const std::vector<ItemReference>& items,
                                const std::vector<FigureVerdict>& all);

struct Opinion {
  double mean = kUnset;
  int least = 0, most = 0;          // lowest and highest points; 0: no answer
  std::vector<std::size_t> counts;  // of each step
};
// Summary of one item.
[[nodiscard]] Opinion opinion_of(const Form& form, const std::vector<Answer>& rows, std::size_t item);
[[nodiscard]] double global_mean(const std::vector<Answer>& rows);
// The answers of people who have, or have not, used `experience` before.
[[nodiscard]] std::vector<Answer> with_experience(const std::vector<Answer>& rows, std::size_t experience,
                                                  bool yes);

[[nodiscard]] Table opinion_table(const Form& form, const std::vector<ItemReference>& items,
                                  const std::vector<Answer>& rows);
// Means of people with and of people without each experience, beside those that the study states.
[[nodiscard]] Table experience_table(const Form& form, const std::vector<ItemReference>& items,
                                     const std::vector<Answer>& rows);
[[nodiscard]] Plot opinion_plot(const Form& form, const std::vector<ItemReference>& items,
                                const std::vector<Answer>& rows);

}  // namespace enc::bench::questionnaire
