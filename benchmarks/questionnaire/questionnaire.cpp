#include "benchmarks/questionnaire/questionnaire.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <istream>
#include <ostream>
#include <sstream>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/toml_reader.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/tables/csv_reader.h"

namespace enc::bench::questionnaire {
namespace {

namespace fs = std::filesystem;
using models::Key;
using models::Presence;
using models::Visitor;

Key key(std::string_view name, std::string_view meaning, Presence presence = Presence::needed) {
  return {name, meaning, "form", models::Confidence::chosen, models::kAny, presence, {}, true};
}

template <class T, class Walk>
void list(Visitor& v, std::string_view name, std::vector<T>& entries, Walk walk) {
  entries.resize(v.open_list(name, entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    v.open_entry(name, i, entries[i].name);
    v.value(key("name", "name in tables and columns"), &entries[i].name);
    v.value(key("text", "text that people read"), &entries[i].text);
    walk(entries[i]);
    v.close();
  }
}

void describe(Visitor& v, Form& f) {
  const auto no_more = [](Wording&) {};
  Key format = key("format", "version of the form's format; this program reads version 1");
  format.range = {1.0, 1.0};
  v.value(format, &f.format);
  v.value(key("title", "topic of the form"), &f.title);
  v.value(key("source", "source of the wording"), &f.source);
  v.value(key("reference", "file in benchmarks/reference with published means", Presence::defaulted),
          &f.reference);
  v.value(key("groups_reference",
              "file in benchmarks/reference with published means of people with an experience",
              Presence::defaulted),
          &f.groups_reference);
  list(v, "step", f.steps, no_more);
  list(v, "experience", f.experience, no_more);
  list(v, "group", f.groups, no_more);
  list(v, "item", f.items, [&](Item& item) {
    v.value(key("group", "an entry of [[group]]"), &item.group);
    v.value(key("figures", "ids of figures that measure the topic of the item", Presence::defaulted),
            &item.figures);
  });
}

void check(const Form& f, const std::string& path, const models::Places& places) {
  const auto fail = [&](const std::string& at, const std::string& what) {
    const auto place = places.find(at);
    throw Error(fmt::format("{}: {}", place == places.end() ? path + ":1:1" : place->second, what));
  };
  if (f.steps.size() < 2) fail("step", "fewer than two steps; expected a scale; add [[step]]");
  for (std::size_t i = 0; i < f.steps.size(); ++i)
    if (f.steps[i].name != std::to_string(i + 1))
      fail(fmt::format("step.{}.name", f.steps[i].name),
           fmt::format("step {} in place {}; expected 1, 2, 3, ... in order; name it \"{}\"",
                       models::quoted(f.steps[i].name), i + 1, i + 1));
  // Names become columns of a table.
  const auto plain = [&](const char* list, const std::string& name) {
    if (std::all_of(name.begin(), name.end(),
                    [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }))
      return;
    fail(fmt::format("{}.{}.name", list, name),
         fmt::format("the name {} has other characters than letters, digits and _; expected a column's name; "
                     "rename it",
                     models::quoted(name)));
  };
  for (const Item& item : f.items) plain("item", item.name);
  for (const Wording& e : f.experience) plain("experience", e.name);
  if (f.items.empty()) fail("item", "no items; expected questions; add [[item]]");
  std::vector<std::string> groups;
  groups.reserve(f.groups.size());
  for (const Wording& g : f.groups) groups.push_back(g.name);
  for (const Item& item : f.items)
    if (std::find(groups.begin(), groups.end(), item.group) == groups.end())
      fail(fmt::format("item.{}.group", item.name),
           fmt::format("there is no group {}; expected an entry of [[group]]; {}", models::quoted(item.group),
                       models::advice(item.group, groups)));
}

constexpr std::string_view kSpace = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::vector<std::string> answer_columns(const Form& form, bool dated) {
  std::vector<std::string> columns{"participant"};
  for (const Wording& e : form.experience) columns.push_back(e.name);
  for (const Item& item : form.items) columns.push_back("item_" + item.name);
  if (dated) columns.emplace_back("date");
  return columns;
}

// The columns must match the form: an additional column belongs to another form.
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

// The file of answers only grows at its end: one write under a lock, taken back if it was cut.

class LockedFile {
 public:
  explicit LockedFile(std::string path)
      : path_(std::move(path)),
        fd_(open(path_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644)) {
    if (fd_ < 0) fail();
    struct stat kind {};
    if (fstat(fd_, &kind) == 0 && S_ISREG(kind.st_mode) && flock(fd_, LOCK_EX) == 0) {
      models::note_input(path_);  // no other output of this command may overwrite it
      return;
    }
    if (!S_ISREG(kind.st_mode)) errno = EINVAL;  // a device or a pipe does not keep the data
    const int why = errno;
    close(fd_);
    errno = why;
    fail();
  }
  ~LockedFile() { close(fd_); }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  [[nodiscard]] std::string text() const {
    std::string all;
    std::array<char, 65536> buffer{};
    for (ssize_t n = 0;
         (n = pread(fd_, buffer.data(), buffer.size(), static_cast<off_t>(all.size()))) != 0;) {
      if (n < 0) fail();
      all.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return all;
  }
  void append(const std::string& text, std::size_t size_before) const {
    const ssize_t written = write(fd_, text.data(), text.size());
    if (written == static_cast<ssize_t>(text.size()) && fsync(fd_) == 0) return;
    const int why = written < 0 ? errno : ENOSPC;
    if (ftruncate(fd_, static_cast<off_t>(size_before)) != 0) errno = why;  // keep the first error
    errno = why;
    fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(
        fmt::format("{}: cannot be written: {}; expected a file that is yours and has room; choose another",
                    path_, std::strerror(errno)));
  }
  const std::string path_;
  const int fd_;
};

std::string line_of(const Answer& a, bool dated) {
  std::string line = a.participant;
  for (const std::uint8_t yes : a.experience) line += yes != 0 ? ",yes" : ",no";
  for (const int points : a.points) line += fmt::format(",{}", points);
  return line + (dated ? "," + a.date : "") + "\n";
}

// Rows are written in the form's order. A file in another order can be read, but not extended.
void check_order(const std::string& text, const std::string& path, const std::vector<std::string>& columns) {
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const std::string expected = fmt::format("{}", fmt::join(columns, ","));
    if (line == expected) return;
    throw Error(fmt::format("{}:{}:1: the columns stand in another order; expected {}; choose another file",
                            path, number, expected));
  }
}

// Removes the byte-order mark that some programs put before UTF-8.
std::string unmarked(const std::string& text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

bool in_file(const Answers& answers, const std::string& participant) {
  return std::any_of(answers.rows.begin(), answers.rows.end(),
                     [&](const Answer& a) { return a.participant == participant; });
}

// One more than the largest participant number.
std::string next_participant(const Answers& answers) {
  std::int64_t largest = 0;
  for (const Answer& a : answers.rows) {
    std::int64_t number = 0;
    const char* end = a.participant.data() + a.participant.size();
    if (std::from_chars(a.participant.data(), end, number).ptr == end) largest = std::max(largest, number);
  }
  return std::to_string(largest + 1);
}

// The file's content with `rows`; `text` receives the text to append.
Answers joined(const std::string& before, const std::string& path, const Form& form,
               std::vector<Answer>&& rows, std::string& text) {
  const bool dates = std::any_of(rows.begin(), rows.end(), [](const Answer& a) { return !a.date.empty(); });
  Answers all;
  if (before.empty()) {
    all.dated = dates;
    text = fmt::format("{}\n", fmt::join(answer_columns(form, dates), ","));
  } else {
    all = parse_answers(before, path, form);
    check_order(before, path, answer_columns(form, all.dated));
    if (dates && !all.dated)
      throw Error(
          fmt::format("{}:1:1: there is no column 'date'; expected one for answers with a date; leave the "
                      "date out, or choose another file",
                      path));
    if (before.back() != '\n') text = "\n";
  }
  for (Answer& a : rows) {
    if (a.participant.empty()) a.participant = next_participant(all);
    if (in_file(all, a.participant))
      throw Error(
          fmt::format("{}: participant {} is there already; expected one row for each; choose another", path,
                      models::quoted(a.participant)));
    text += line_of(a, all.dated);
    all.rows.push_back(std::move(a));
  }
  return all;
}

class Interview {
 public:
  Interview(std::istream& in, std::ostream& out, bool again) : in_(in), out_(out), again_(again) {}

  // Asks until the answer is one of `words`, which are numbered from 0.
  int one_of(const std::string& question, const std::vector<std::string>& words, const std::string& wanted) {
    for (;;) {
      out_ << question << " [" << wanted << "] " << std::flush;
      std::string text;
      ++line_;
      if (!std::getline(in_, text))
        throw Error(
            fmt::format("standard input:{}:1: it ended before the last answer; expected {}; nothing was "
                        "stored, begin anew",
                        line_, wanted));
      if (!again_) out_ << text << '\n';  // echo an answer that was not typed
      while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
      for (std::size_t i = 0; i < words.size(); ++i)
        if (text == words[i]) return static_cast<int>(i);
      const std::string what = text.empty() ? "there is no answer" : models::quoted(text) + " is no answer";
      if (!again_)
        throw Error(fmt::format("standard input:{}:1: {}; expected {}; nothing was stored, begin anew", line_,
                                what, wanted));
      out_ << "  " << what << "; please give " << wanted << '\n';
    }
  }

 private:
  std::istream& in_;
  std::ostream& out_;
  const bool again_;
  std::size_t line_ = 0;
};

}  // namespace

Form parse_form(const std::string& text, const std::string& path) {
  Form form;
  const models::Places places = models::read_toml(text, path, [&](Visitor& v) { describe(v, form); });
  check(form, path, places);
  form.name = fs::path(path).stem().string();
  return form;
}

Form load_form(const std::string& models, const std::string& name) {
  if (name.ends_with(".toml"))
    return parse_form(models::csv_text(name, "form", "a TOML file as in models/questionnaires"), name);
  const std::vector<std::string> names = models::files_in(models, "questionnaires");
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(fmt::format("there is no questionnaire {}; expected a file in models/questionnaires; {}",
                            models::quoted(name), models::advice(name, names)));
  const std::string path =
      (fs::path(models) / "questionnaires" / (name + ".toml")).lexically_normal().string();
  return parse_form(models::csv_text(path, "form", "a TOML file"), path);
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

Answers append_answers(const std::string& path, const Form& form, std::vector<Answer> rows) {
  std::string text;
  try {
    const LockedFile file(path);
    const std::string before = file.text();
    Answers all = joined(unmarked(before), path, form, std::vector<Answer>(rows), text);
    file.append(text, before.size());
    return all;
  } catch (const Error& e) {
    if (rows.size() != 1) throw;  // several rows stay in their own file
    std::string line = line_of(rows.front(), !rows.front().date.empty());
    line.pop_back();
    throw Error(fmt::format("{}; the answers were {}", e.what(), line));
  }
}

void check_store(const std::string& path, const Form& form, const Answer& draft) {
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    if (errno == ENOENT && access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0) return;
    throw Error(fmt::format(
        "{}: cannot be written: {}; expected a file in a folder that exists and is yours; choose another",
        path, std::strerror(errno)));
  }
  std::string text;
  const LockedFile file(path);
  static_cast<void>(joined(unmarked(file.text()), path, form, {draft}, text));
}

Answer ask(const Form& form, std::istream& in, std::ostream& out, bool again) {
  Interview interview(in, out, again);
  Answer answer;
  out << form.title << "\n\n";
  for (const Wording& e : form.experience)
    answer.experience.push_back(interview.one_of(e.text, {"no", "yes"}, "yes or no") == 1 ? 1 : 0);
  out << "\nHow far do you agree?\n";
  std::vector<std::string> steps;
  for (const Wording& step : form.steps) {
    steps.push_back(step.name);
    out << "  " << step.name << "  " << step.text << '\n';
  }
  const std::string wanted = fmt::format("1 to {}", form.highest());
  std::string group;
  for (const Item& item : form.items) {
    for (const Wording& g : form.groups)
      if (g.name == item.group && item.group != group) out << '\n' << g.text << '\n';
    group = item.group;
    answer.points.push_back(1 + interview.one_of(fmt::format("{}. {}", item.name, item.text), steps, wanted));
  }
  out << '\n';
  return answer;
}

}  // namespace enc::bench::questionnaire
