#include "benchmarks/questionnaire/answers.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"

namespace enc::bench::questionnaire {
namespace {

constexpr std::string_view kSpace = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

// The columns stand for a form: one too many is another form's.
void check_header(std::string_view text, const std::string& path, const Form& form) {
  const std::vector<std::string> known = answer_columns(form, true);
  std::size_t number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    if (trimmed(line).empty() || line.front() == '#') continue;
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      const std::string name(trimmed(line.substr(at, comma - at)));
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw Error(fmt::format("{}:{}:{}: column {} is not of the form {}; expected {}; {}", path, number,
                                at + 1, models::quoted(name), models::quoted(form.name),
                                fmt::join(answer_columns(form, false), ","), models::advice(name, known)));
      at = comma + 1;
    }
    return;
  }
  throw Error(fmt::format("{}:1:1: there is no header; expected {}; write it as the first line", path,
                          fmt::join(answer_columns(form, false), ",")));
}

// Reads the rows of a file by its columns.
class Rows {
 public:
  Rows(std::string_view text, const std::string& path, const Form& form)
      : form_(form), columns_(answer_columns(form, true)), reader_(text, path) {
    const std::vector<std::string_view> names(columns_.begin(), columns_.end());
    reader_.header({names.begin(), names.end() - 1}, {names.back()});
  }
  bool next(Answers& answers) {
    if (!reader_.next()) return false;
    Answer a{std::string(reader_.text(0)), {}, {}};
    if (a.participant.empty())
      reader_.fail(0, "the participant is empty; expected a number or a code; write one");
    for (const Answer& other : answers.rows)
      if (other.participant == a.participant)
        reader_.fail(0, fmt::format("participant {} is there twice; expected one row for each; remove one",
                                    models::quoted(a.participant)));
    for (std::size_t i = 0; i < form_.experience.size(); ++i) a.experience.push_back(yes_or_no(1 + i));
    for (std::size_t i = 0; i < form_.items.size(); ++i)
      a.points.push_back(points(1 + form_.experience.size() + i));
    a.date = reader_.text(columns_.size() - 1);
    answers.rows.push_back(std::move(a));
    return true;
  }
  [[nodiscard]] bool dated() const { return reader_.has(columns_.size() - 1); }

 private:
  [[nodiscard]] std::uint8_t yes_or_no(std::size_t column) const {
    const std::string_view text = reader_.text(column);
    if (text != "yes" && text != "no")
      reader_.fail(column, fmt::format("'{}' is {}; expected yes or no; correct it", columns_[column],
                                       text.empty() ? "empty" : models::quoted(std::string(text))));
    return text == "yes" ? 1 : 0;
  }
  [[nodiscard]] int points(std::size_t column) const {
    const std::string_view text = reader_.text(column);
    int value = 0;
    const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (bad != std::errc() || end != text.data() + text.size() || value < 1 || value > form_.highest())
      reader_.fail(
          column,
          fmt::format("'{}' is {}; expected a whole number from 1 to {}; correct it or remove the row",
                      columns_[column], text.empty() ? "empty" : models::quoted(std::string(text)),
                      form_.highest()));
    return value;
  }

  const Form& form_;
  const std::vector<std::string> columns_;
  models::CsvReader reader_;
};

}  // namespace

std::vector<std::string> answer_columns(const Form& form, bool dated) {
  std::vector<std::string> columns{"participant"};
  for (const Wording& e : form.experience) columns.push_back(e.name);
  for (const Item& item : form.items) columns.push_back("item_" + item.name);
  if (dated) columns.emplace_back("date");
  return columns;
}

Answers parse_answers(std::string_view text, const std::string& path, const Form& form) {
  check_header(text, path, form);
  Rows rows(text, path, form);
  Answers answers;
  answers.dated = rows.dated();
  while (rows.next(answers)) {
  }
  return answers;
}

std::string next_participant(const Answers& answers) {
  std::int64_t largest = 0;
  for (const Answer& a : answers.rows) {
    std::int64_t number = 0;
    const char* end = a.participant.data() + a.participant.size();
    if (std::from_chars(a.participant.data(), end, number).ptr == end) largest = std::max(largest, number);
  }
  return std::to_string(largest + 1);
}

}  // namespace enc::bench::questionnaire
