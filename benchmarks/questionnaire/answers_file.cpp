// The file of answers grows at its end and nowhere else: one write under a lock, taken back if it was cut.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "benchmarks/questionnaire/answers.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"

namespace enc::bench::questionnaire {
namespace {

class LockedFile {
 public:
  explicit LockedFile(std::string path)
      : path_(std::move(path)),
        fd_(open(path_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644)) {
    if (fd_ < 0) fail();
    struct stat kind {};
    if (fstat(fd_, &kind) == 0 && S_ISREG(kind.st_mode) && flock(fd_, LOCK_EX) == 0) {
      models::note_input(path_);  // no other output of this command goes over it
      return;
    }
    if (!S_ISREG(kind.st_mode)) errno = EINVAL;  // a device or a pipe keeps nothing
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
    if (ftruncate(fd_, static_cast<off_t>(size_before)) != 0) errno = why;  // the first reason counts
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

// Rows are written in the form's order; a file in another one can be read, but not added to.
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

// Without the mark that some programs put before UTF-8.
std::string unmarked(const std::string& text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

bool in_file(const Answers& answers, const std::string& participant) {
  return std::any_of(answers.rows.begin(), answers.rows.end(),
                     [&](const Answer& a) { return a.participant == participant; });
}

// What the file holds with `rows`; `text` is what is to be put at its end.
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
          fmt::format("{}:1:1: there is no column 'date'; expected one for answers with a date; "
                      "leave the date out, or choose another file",
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

}  // namespace

Answers append_answers(const std::string& path, const Form& form, std::vector<Answer> rows) {
  std::string text;
  try {
    const LockedFile file(path);
    const std::string before = file.text();
    Answers all = joined(unmarked(before), path, form, std::vector<Answer>(rows), text);
    file.append(text, before.size());
    return all;
  } catch (const Error& e) {
    if (rows.size() != 1) throw;  // many are in a file of their own
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
    throw Error(
        fmt::format("{}: cannot be written: {}; expected a file in a folder that exists and is yours; "
                    "choose another",
                    path, std::strerror(errno)));
  }
  std::string text;
  const LockedFile file(path);
  static_cast<void>(joined(unmarked(file.text()), path, form, {draft}, text));
}

}  // namespace enc::bench::questionnaire
