// What people answered to a form: one row for each of them in a CSV file that only ever grows.
//
//   participant,force_feedback,vr_mr,visuo_haptics,item_1,...,item_11[,date]
//   1,yes,no,no,6,4,6,6,5,5,5,4,6,6,5
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/questionnaire/form.h"

namespace enc::bench::questionnaire {

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

[[nodiscard]] std::vector<std::string> answer_columns(const Form& form, bool dated);
// Throws Error "path:line:column: ..." for what is not of this form.
[[nodiscard]] Answers parse_answers(std::string_view text, const std::string& path, const Form& form);

// Puts the rows at the end of the file, all or none, and gives back all that is in it then. What stood there
// stays as it is; two that write at once take turns. A new file has a date column if one of the rows has a
// date. Throws Error, and writes nothing, where the file is of another form or a participant is there twice.
Answers append_answers(const std::string& path, const Form& form, std::vector<Answer> rows);

// Throws Error where append_answers() would refuse such an answer or could not write it. Writes nothing.
void check_store(const std::string& path, const Form& form, const Answer& draft);

// 1 more than the largest number among the participants.
[[nodiscard]] std::string next_participant(const Answers& answers);

// Asks on `out`, reads from `in`. `again`: what is no answer is asked again, as a person wants it; otherwise
// it is an Error with its place. The end of the input is an Error, too.
[[nodiscard]] Answer ask(const Form& form, std::istream& in, std::ostream& out, bool again);

}  // namespace enc::bench::questionnaire
