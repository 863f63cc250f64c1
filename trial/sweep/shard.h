// The results of a sweep on disk. A shard writes one line for each run to shard-I.ndjson.part and renames the
// file when all of its runs are there; started again, it goes on behind the last whole line.
//
//   {"sweep":"HASH","runs":N,...}                                      one header
//   {"id":7,"seed":S,"state_hash":"H","figures":{...},"exit":0,"cpu_s":0.1}    a run; cpu_s is last
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace enc::trial {

// Runs index, index + count, index + 2 count, ...
struct ShardNumber {
  std::int64_t index = 0, count = 1;
  [[nodiscard]] std::int64_t runs(std::int64_t all) const {
    return index < all ? (all - index - 1) / count + 1 : 0;
  }
};

// What all shards of a sweep share, as the members of a JSON object without braces.
struct SweepIdentity {
  std::string text;
  std::int64_t runs = 0;
};

// A run's line, read without a JSON parser: the writer is this program.
struct ResultLine {
  std::int64_t id = -1;
  int exit = 0;
  double cpu = 0.0;          // s
  std::string_view results;  // the line up to cpu_s, with its closing brace missing
};
// Unset if the text is no whole line of a run.
[[nodiscard]] std::optional<ResultLine> parse_result(std::string_view line);
// A run that exited so has no figures: refused, a lost device, ended in hold, diverged or killed.
[[nodiscard]] constexpr bool failed(int exit) { return exit >= 2; }

enum class Retry { none, failures };

// One shard, locked against a second process of the same number. Throws Error in one line.
class ShardFile {
 public:
  // Retry::failures: drops the lines of failed runs, whose runs are then missing.
  ShardFile(const std::string& folder, SweepIdentity identity, ShardNumber number, Retry retry);
  ~ShardFile();
  ShardFile(const ShardFile&) = delete;
  ShardFile& operator=(const ShardFile&) = delete;

  // The shard's runs that have no line yet, in order; at most `most` of them, from the cursor on.
  [[nodiscard]] std::vector<std::int64_t> next(std::size_t most);
  [[nodiscard]] std::int64_t count() const { return count_; }  // runs of the shard
  [[nodiscard]] std::int64_t finished() const { return finished_; }
  [[nodiscard]] std::int64_t failures() const { return failures_; }
  [[nodiscard]] double cpu() const { return cpu_; }  // s, of all lines

  void append(const std::string& line);  // a whole line of a run, without its end
  void complete();                       // all runs are there: renames the file
  // Removes a shard without lines, and its folder, unless that is empty text.
  void discard(const std::string& folder);

 private:
  void open_part();
  void load(const std::string& path, Retry retry);
  void rewrite(const std::string& text);
  void note(const ResultLine& line);
  [[noreturn]] void fail(int why) const;

  std::string whole_, part_;
  SweepIdentity identity_;
  ShardNumber number_;
  std::int64_t count_, finished_ = 0, failures_ = 0, cursor_ = 0;
  double cpu_ = 0.0;
  std::vector<bool> done_;  // by place in the shard
  bool is_whole_ = false;
  int fd_ = -1;
  std::int64_t size_ = 0;  // bytes of whole lines
};

// What a folder holds of a sweep.
struct ShardState {
  ShardNumber number;
  std::string path;
  bool whole = false, running = false;
  std::int64_t finished = 0, failures = 0;
  double cpu = 0.0;  // s
};
// Refuses a file that no sweep writes, and a shard of another sweep. An absent folder has no shards.
[[nodiscard]] std::vector<ShardState> shards_in(const std::string& folder, const SweepIdentity& identity);

// All lines of a complete sweep, in the order of the runs.
class MergedLines {
 public:
  // Refuses shards that are missing or not whole.
  MergedLines(const std::string& folder, const SweepIdentity& identity);
  ~MergedLines();
  MergedLines(const MergedLines&) = delete;
  MergedLines& operator=(const MergedLines&) = delete;

  [[nodiscard]] ResultLine at(std::int64_t run) const;
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(lines_.size()); }

 private:
  struct MappedFile {
    const char* data = nullptr;
    std::size_t size = 0;
  };
  void index(std::string_view text, const std::string& path);
  std::vector<MappedFile> files_;
  std::vector<std::string_view> lines_;  // by run
};

}  // namespace enc::trial
