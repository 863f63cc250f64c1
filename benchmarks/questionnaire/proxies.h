// What the twin measures of what people were asked. No answer is simulated: a figure stands beside an item,
// never in its place [VHMR Fig 14].
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/questionnaire/form.h"
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

}  // namespace enc::bench::questionnaire
