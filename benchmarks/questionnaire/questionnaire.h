// A questionnaire: what people are asked, on a scale of steps, and their answers in a file.
// models/questionnaires/*.toml; asked by `encounter questionnaire`, never simulated [VHMR 4.4, Fig 14].
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
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

// What people answered to a form: one row for each of them in a CSV file that only ever grows.
//
//   participant,force_feedback,vr_mr,visuo_haptics,item_1,...,item_11[,date]
//   1,yes,no,no,6,4,6,6,5,5,5,4,6,6,5

struct Answer {
  std::string participant;               // a number or a code, never a name
  std::vector<std::uint8_t> experience;  // 1: yes; in the form's order
  std::vector<int> points;               // of each item, from 1
  std::string date{};                    // may be empty
};
struct Answers {
  std::vector<Answer> rows;
  bool dated = false;  // the file has a column `date`
};
// Throws Error "path:line:column: ..." for what is not of this form.
[[nodiscard]] Answers parse_answers(std::string_view text, const std::string& path, const Form& form);

// Puts the rows at the end of the file, all or none, and gives back all that is in it then. What stood there
// stays as it is; two that write at once take turns. A new file has a date column if one of the rows has a
// date. Throws Error, and writes nothing, where the file is of another form or a participant is there twice.
Answers append_answers(const std::string& path, const Form& form, std::vector<Answer> rows);

// Throws Error where append_answers() would refuse such an answer or could not write it. Writes nothing.
void check_store(const std::string& path, const Form& form, const Answer& draft);

// Asks on `out`, reads from `in`. `again`: what is no answer is asked again, as a person wants it; otherwise
// it is an Error with its place. The end of the input is an Error, too.
[[nodiscard]] Answer ask(const Form& form, std::istream& in, std::ostream& out, bool again);

}  // namespace enc::bench::questionnaire
