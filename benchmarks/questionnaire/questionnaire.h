// A questionnaire: questions on a scale of steps, and the people's answers in a file.
// models/questionnaires/*.toml; asked by `encounter questionnaire`, never simulated [VHMR 4.4, Fig 14].
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace enc::bench::questionnaire {

// A step of the scale, a group of items, or a device that a person has used before.
struct Wording {
  std::string name, text;
};
struct Item {
  std::string name, text;
  std::string group;    // by name
  std::string figures;  // ids of figures on the subject of the item, with blanks between
};
struct Form {
  std::int64_t format = 1;
  std::string title, source;
  std::string reference;  // file in benchmarks/reference with the means of a published study; may be empty
  std::string groups_reference{};  // likewise, of people with one experience
  std::vector<Wording> steps;      // the first is 1
  std::vector<Wording> experience, groups;
  std::vector<Item> items;
  std::string name{};  // file name, without ".toml"

  [[nodiscard]] int highest() const { return static_cast<int>(steps.size()); }
};

// `name`: a file in models/questionnaires without ".toml", or a path. Throws Error with the place of the
// error.
[[nodiscard]] Form load_form(const std::string& models, const std::string& name);
[[nodiscard]] Form parse_form(const std::string& text, const std::string& path);

// The answers to a form: one row for each of them in a CSV file that only ever grows.
//
//   participant,force_feedback,vr_mr,visuo_haptics,item_1,...,item_11[,date]
//   1,yes,no,no,6,4,6,6,5,5,5,4,6,6,5

struct Answer {
  std::string participant;               // a number or a code, never a name
  std::vector<std::uint8_t> experience;  // 1: yes; in the form's order
  std::vector<int> points;               // points for each item, from 1
  std::string date{};                    // may be empty
};
struct Answers {
  std::vector<Answer> rows;
  bool dated = false;  // the file has a column `date`
};
// Throws Error "path:line:column: ..." if the text does not fit this form.
[[nodiscard]] Answers parse_answers(std::string_view text, const std::string& path, const Form& form);

// Appends the rows to the file, all or none, and returns its new content. Existing rows stay unchanged;
// simultaneous writers take turns. A new file has a date column if one of the rows has a date. Throws Error,
// and writes nothing, if the file belongs to another form or a participant is there twice.
Answers append_answers(const std::string& path, const Form& form, std::vector<Answer> rows);

// Throws Error if append_answers() would refuse such an answer or could not write it. Writes nothing.
void check_store(const std::string& path, const Form& form, const Answer& draft);

// Asks on `out`, reads from `in`. `again`: repeats the question after an invalid answer, as for a person;
// otherwise an invalid answer is an Error with its place. The end of the input is an Error, too.
[[nodiscard]] Answer ask(const Form& form, std::istream& in, std::ostream& out, bool again);

}  // namespace enc::bench::questionnaire
