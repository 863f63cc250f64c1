#include "trial/sweep/shard.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/words.h"
#include "models/tables/number_text.h"

namespace enc::trial {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kId = "{\"id\":", kExit = ",\"exit\":", kCpu = ",\"cpu_s\":";

std::string name_of(std::int64_t index) { return fmt::format("shard-{}.ndjson", index); }

std::string header_of(const SweepIdentity& identity, ShardNumber number) {
  return fmt::format("{{{},\"shard\":{},\"of\":{}}}", identity.text, number.index, number.count);
}

// "shard-7.ndjson", "shard-7.ndjson.part": the number and whether it is whole.
std::optional<std::pair<std::int64_t, bool>> shard_name(std::string_view name) {
  constexpr std::string_view kHead = "shard-", kTail = ".ndjson", kPart = ".part";
  const bool whole = !name.ends_with(kPart);
  if (!whole) name.remove_suffix(kPart.size());
  if (!name.starts_with(kHead) || !name.ends_with(kTail)) return std::nullopt;
  const auto index = models::number_in<std::int64_t>(
      name.substr(kHead.size(), name.size() - std::min(name.size(), kHead.size() + kTail.size())));
  if (!index || name != name_of(*index)) return std::nullopt;  // such as shard-00
  return std::pair(*index, whole);
}

// Results that the end of a sweep writes, and their unfinished forms.
bool is_result(std::string name) {
  if (name.ends_with(".part")) name.erase(name.size() - 5);
  for (const char* own : {"results.ndjson", "results.csv", "cost.csv", "report.html"})
    if (name == own) return true;
  return name.starts_with('.');  // file systems keep such files for themselves
}

std::string read_all(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The first difference between a header on disk and the one that this sweep writes, for people.
std::string difference(const std::string& there, const std::string& here) {
  const auto member = [](const std::string& text, const std::string& key) {
    const auto at = text.find("\"" + key + "\":");
    if (at == std::string::npos) return std::string();
    return text.substr(at, text.find(",\"", at + 1) - at);
  };
  if (!there.starts_with("{\"sweep\":")) return "its first line is no header of a sweep";
  constexpr std::array<std::pair<const char*, const char*>, 5> kParts{
      {{"of", "the sweep was begun in another number of shards"},
       {"program", "another Encounter wrote it"},
       {"sweep", "the design was another one then"},
       {"shard", "its name is that of another shard"},
       {"setup", "the scene or its rig was another one then"}}};
  for (const auto& [key, what] : kParts)
    if (member(there, key) != member(here, key)) return what;
  return "it keeps other measures";
}

void check_header(const std::string& path, const std::string& there, const SweepIdentity& identity,
                  ShardNumber number) {
  if (there == header_of(identity, number)) return;
  throw Error(
      fmt::format("{}:1:1: {}; expected results of this sweep, to go on with; name another folder by --out",
                  path, difference(there, header_of(identity, number))));
}

// The count that a header names; unset: no header of ours.
std::optional<std::int64_t> count_in(const std::string& header) {
  const auto at = header.rfind(",\"of\":");
  if (at == std::string::npos || !header.ends_with('}')) return std::nullopt;
  return models::number_in<std::int64_t>(std::string_view(header).substr(at + 6, header.size() - at - 7));
}

// 0, or the number of the error. One call writes at most 2 GiB.
int write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// Tries for a while, because --status holds a shared lock for a moment.
bool locked(int fd) {
  constexpr int kTries = 10, kPause = 20'000;  // us
  for (int i = 0; i < kTries; ++i) {
    if (flock(fd, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
    usleep(kPause);
  }
  return false;
}

// Calls see(line, number of the line) for each whole line behind the header.
template <class See>
void for_lines(std::string_view text, const See& see) {
  std::size_t number = 1;
  for (std::size_t at = text.find('\n') + 1; at < text.size(); ++number) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return;
    see(text.substr(at, end - at), number + 1);
    at = end + 1;
  }
}

ResultLine result_in(std::string_view line, const std::string& path, std::size_t number) {
  const std::optional<ResultLine> result = parse_result(line);
  if (result) return *result;
  throw Error(
      fmt::format("{}:{}:1: is no line of a run; expected the lines that this sweep wrote; remove the line",
                  path, number));
}

// The shards of a folder, without their lines. A whole one comes before an unfinished one of its number,
// which a cut-off retry left.
std::vector<ShardState> headers_in(const std::string& folder, const SweepIdentity& identity) {
  std::vector<ShardState> all;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    const auto shard = shard_name(name);
    if (!shard && (is_result(name) || name.ends_with(".part.part"))) continue;
    const fs::file_type type = entry.status(none).type();
    if (type == fs::file_type::not_found) continue;  // another process has just renamed it
    if (!shard || type != fs::file_type::regular)
      throw Error(
          fmt::format("{}: is no file of a sweep; expected a new folder, or one of this sweep; name "
                      "another by --out, or remove the file",
                      entry.path().string()));
    std::ifstream in(entry.path(), std::ios::binary);
    std::string header;
    if (!std::getline(in, header) || in.eof()) continue;  // another process has just begun it
    const ShardState state{.number = {shard->first, count_in(header).value_or(0)},
                           .path = entry.path().string(),
                           .whole = shard->second};
    check_header(state.path, header, identity, state.number);
    all.push_back(state);
  }
  const auto place = [](const ShardState& s) { return std::pair(s.number.index, !s.whole); };
  std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  const auto same = [](const auto& a, const auto& b) { return a.number.index == b.number.index; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

}  // namespace

std::optional<ResultLine> parse_result(std::string_view line) {
  const std::size_t cpu = line.rfind(kCpu), exit = line.rfind(kExit);
  if (!line.starts_with(kId) || !line.ends_with('}') || cpu == line.npos || exit == line.npos || exit > cpu)
    return std::nullopt;
  const auto id = models::number_in<std::int64_t>(line.substr(kId.size(), line.find(',') - kId.size()));
  const auto code = models::number_in<int>(line.substr(exit + kExit.size(), cpu - exit - kExit.size()));
  const auto seconds =
      models::number_in<double>(line.substr(cpu + kCpu.size(), line.size() - cpu - kCpu.size() - 1));
  if (!id || !code || !seconds) return std::nullopt;
  return ResultLine{*id, *code, *seconds, line.substr(0, cpu)};
}

ShardFile::ShardFile(const std::string& folder, SweepIdentity identity, ShardNumber number, Retry retry)
    : whole_((fs::path(folder) / name_of(number.index)).string()),
      part_(whole_ + ".part"),
      identity_(std::move(identity)),
      number_(number),
      count_(number.runs(identity_.runs)),
      done_(static_cast<std::size_t>(count_)) {
  std::error_code bad;
  fs::create_directories(folder, bad);
  if (bad)
    throw Error(fmt::format("{}: cannot be made: {}; expected a folder for the results; choose another",
                            folder, bad.message()));
  for (const ShardState& other : headers_in(folder, identity_))
    if (other.number.count != number_.count)
      throw Error(
          fmt::format("{}:1:1: the sweep was begun in {} shards; expected --shard {}/{}; or name "
                      "another folder by --out",
                      other.path, other.number.count, number_.index, other.number.count));
  open_part();
  is_whole_ = fs::exists(whole_, bad);
  load(is_whole_ ? whole_ : part_, retry);
  if (is_whole_ && finished_ == count_) {
    unlink(part_.c_str());  // this process has just made it, or a retry was cut off
    return;
  }
  if (is_whole_) unlink(whole_.c_str());  // its lines are in the part
  is_whole_ = false;
}

ShardFile::~ShardFile() {
  if (fd_ >= 0) close(fd_);
}

// Takes the lock of the shard. Another process may rename the file between open() and flock().
void ShardFile::open_part() {
  for (;;) {
    fd_ = open(part_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (fd_ < 0) fail(errno);
    if (!locked(fd_))
      throw Error(
          fmt::format("{}: another process runs shard {} of {}; expected one for each shard; give this one "
                      "another number, or wait",
                      part_, number_.index, number_.count));
    struct stat mine {
    }, there{};
    if (fstat(fd_, &mine) == 0 && stat(part_.c_str(), &there) == 0 && mine.st_ino == there.st_ino) return;
    close(fd_);
    fd_ = -1;
  }
}

// Reads what is there, and leaves the lines to go on with in the part.
void ShardFile::load(const std::string& path, Retry retry) {
  const std::string text = read_all(path);
  const std::string header = header_of(identity_, number_);
  const std::size_t first = text.find('\n');
  if (first == std::string::npos) {  // new, or cut off within its first line
    if (!header.starts_with(text)) check_header(path, text, identity_, number_);
    return rewrite(header + "\n");
  }
  check_header(path, text.substr(0, first), identity_, number_);
  std::string kept = header + "\n";
  for_lines(text, [&](std::string_view line, std::size_t number) {
    const ResultLine result = result_in(line, path, number);
    if (retry == Retry::failures && failed(result.exit)) return;
    note(result);
    kept.append(line).append("\n");
  });
  if (is_whole_ && finished_ == count_) return;
  if (is_whole_ || kept.size() != text.size()) return rewrite(kept);
  size_ = static_cast<std::int64_t>(text.size());
}

// Replaces the part at once: a crash leaves the old one or the new one. The lock moves with it.
void ShardFile::rewrite(const std::string& text) {
  const std::string fresh = part_ + ".part";  // a name that shards_in() takes for ours
  const int fd = open(fresh.c_str(), O_RDWR | O_APPEND | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (fd < 0) fail(errno);
  int why = write_all(fd, text);
  if (why == 0 && !(fsync(fd) == 0 && locked(fd) && rename(fresh.c_str(), part_.c_str()) == 0)) why = errno;
  if (why != 0) {
    close(fd);
    unlink(fresh.c_str());
    fail(why);
  }
  close(fd_);
  fd_ = fd;
  size_ = static_cast<std::int64_t>(text.size());
}

void ShardFile::note(const ResultLine& line) {
  const bool ours = line.id >= 0 && line.id < identity_.runs && line.id % number_.count == number_.index;
  const auto place = static_cast<std::size_t>(line.id / number_.count);
  if (!ours || done_[place])
    throw Error(fmt::format("{}:1:1: run {} {}; expected each run of the shard once; name another folder",
                            part_, line.id, ours ? "is there twice" : "is none of this shard"));
  done_[place] = true;
  ++finished_;
  if (failed(line.exit)) ++failures_;
  cpu_ += line.cpu;
}

std::vector<std::int64_t> ShardFile::next(std::size_t most) {
  std::vector<std::int64_t> runs;
  for (; cursor_ < count_ && runs.size() < most; ++cursor_)
    if (!done_[static_cast<std::size_t>(cursor_)]) runs.push_back(number_.index + cursor_ * number_.count);
  return runs;
}

void ShardFile::append(const std::string& line) {
  const std::optional<ResultLine> result = parse_result(line);
  if (!result) throw std::logic_error("not a line of a run: " + line);
  note(*result);
  const std::string text = line + "\n";
  if (const int why = write_all(fd_, text); why != 0) {
    if (ftruncate(fd_, size_) != 0) fail(errno);  // the next start drops the torn line
    fail(why);
  }
  size_ += static_cast<std::int64_t>(text.size());
}

void ShardFile::complete() {
  if (is_whole_) return;
  if (fsync(fd_) != 0 || rename(part_.c_str(), whole_.c_str()) != 0) fail(errno);
  is_whole_ = true;
}

void ShardFile::discard(const std::string& folder) {
  unlink(part_.c_str());
  if (!folder.empty()) rmdir(folder.c_str());  // fails if another shard is there
}

void ShardFile::fail(int why) const {
  throw Error(fmt::format(
      "{}: cannot be written: {}; expected room for one line a run; make room, and the same command goes on",
      part_, std::strerror(why)));
}

std::vector<ShardState> shards_in(const std::string& folder, const SweepIdentity& identity) {
  std::vector<ShardState> all = headers_in(folder, identity);
  for (ShardState& state : all) {
    const int fd = open(state.path.c_str(), O_RDONLY | O_CLOEXEC);
    state.running = !state.whole && fd >= 0 && flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (fd >= 0) close(fd);
    for_lines(read_all(state.path), [&](std::string_view line, std::size_t number) {
      const ResultLine result = result_in(line, state.path, number);
      ++state.finished;
      state.failures += failed(result.exit) ? 1 : 0;
      state.cpu += result.cpu;
    });
  }
  return all;
}

MergedLines::MergedLines(const std::string& folder, const SweepIdentity& identity) {
  std::vector<ShardState> shards = shards_in(folder, identity);
  std::erase_if(shards, [](const ShardState& s) { return !s.whole; });
  const std::int64_t count = shards.empty() ? 1 : shards.front().number.count;
  std::string missing;
  for (std::int64_t i = 0, next = 0; i < count && missing.size() < 60; ++i) {
    const bool there = static_cast<std::size_t>(next) < shards.size() &&
                       shards[static_cast<std::size_t>(next)].number.index == i;
    if (there)
      ++next;
    else
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", i);
  }
  if (!missing.empty())
    throw Error(
        fmt::format("{}: of {} these are not whole: {}; expected all of them; run them, "
                    "--status lists them",
                    folder, counted(count, "shard"), missing));
  lines_.resize(static_cast<std::size_t>(identity.runs));
  for (const ShardState& shard : shards) {
    const int fd = open(shard.path.c_str(), O_RDONLY | O_CLOEXEC);
    const auto size = static_cast<std::size_t>(fs::file_size(shard.path));
    void* data = fd < 0 ? MAP_FAILED : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
    if (fd >= 0) close(fd);
    if (data == MAP_FAILED)
      throw Error(fmt::format("{}: cannot be read: {}; expected a file that is yours; correct its rights",
                              shard.path, std::strerror(errno)));
    files_.push_back({static_cast<const char*>(data), size});
    index({files_.back().data, size}, shard.path);
  }
}

MergedLines::~MergedLines() {
  for (const MappedFile& file : files_) munmap(const_cast<char*>(file.data), file.size);
}

void MergedLines::index(std::string_view text, const std::string& path) {
  for_lines(text, [&](std::string_view line, std::size_t number) {
    const ResultLine result = result_in(line, path, number);
    const auto at = static_cast<std::size_t>(result.id);
    if (result.id < 0 || at >= lines_.size() || !lines_[at].empty())
      throw Error(
          fmt::format("{}:{}:1: run {} is there twice, or is none of this sweep; expected each once; remove "
                      "the line",
                      path, number, result.id));
    lines_[at] = line;
  });
}

ResultLine MergedLines::at(std::int64_t run) const {
  const std::string_view line = lines_.at(static_cast<std::size_t>(run));
  if (line.empty()) throw Error(fmt::format("run {} is in no shard; expected every run; --status", run));
  return *parse_result(line);
}

}  // namespace enc::trial
