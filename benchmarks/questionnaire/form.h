// A questionnaire: what people are asked, on a scale of steps. models/questionnaires/*.toml; asked by
// `encounter questionnaire`, never simulated [VHMR 4.4, Fig 14].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace enc::bench::questionnaire {

// A step of the scale, a group of items, or what somebody has used before.
struct Wording {
  std::string name, text;
};
struct Item {
  std::string name, text;
  std::string group;    // by name
  std::string figures;  // ids of figures that measure what the item asks about, with blanks between
};
struct Form {
  std::int64_t format = 1;
  std::string title, source;
  std::string reference;  // file in benchmarks/reference with the means of a published study; may be empty
  std::vector<Wording> steps;  // the first is 1
  std::vector<Wording> experience, groups;
  std::vector<Item> items;
  std::string name{};  // of the file, without ".toml"

  [[nodiscard]] int highest() const { return static_cast<int>(steps.size()); }
};

// `name`: a file in models/questionnaires without ".toml", or a path. Throws Error with the place of what is
// wrong.
[[nodiscard]] Form load_form(const std::string& models, const std::string& name);
[[nodiscard]] Form parse_form(const std::string& text, const std::string& path);

}  // namespace enc::bench::questionnaire
