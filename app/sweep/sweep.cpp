// `encounter sweep`: many runs of a scene, on the cores of this computer or as one of many shards
// (docs/guide/sweep.md).
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/words.h"
#include "app/sweep/cluster.h"
#include "app/sweep/results.h"
#include "app/sweep/sweep_options.h"
#include "app/sweep/sweep_run.h"
#include "app/sweep/workers.h"
#include "core/base/error.h"
#include "models/order_statistics.h"
#include "models/schema/wording.h"
#include "trial/operator/terminal.h"
#include "trial/provenance/provenance.h"
#include "trial/sweep/shard.h"
#include "trial/sweep/spec.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;
using WallClock = std::chrono::steady_clock;

double since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

// The scene, rig and other files as the program reads them: results of a changed scene are not mixed.
std::string setup_hash(const models::Setup& setup) {
  std::string all;
  for (const auto& [name, text] : models::record_texts(setup)) all += name + "\n" + text + "\n";
  return fmt::format("{:016x}", trial::text_hash(all));
}

trial::SweepIdentity identity_of(const trial::SweepSpec& spec, const models::Setup& setup) {
  nlohmann::ordered_json json{{"sweep", fmt::format("{:016x}", trial::Design(spec).hash())},
                              {"runs", spec.runs()},
                              {"setup", setup_hash(setup)},
                              {"program", trial::program_words()},
                              {"keep", spec.keep}};
  const std::string text = json.dump();
  return {text.substr(1, text.size() - 2), spec.runs()};
}

// Holds back the signals that end a process until the sweep looks for them: a line is never cut off by one.
class SweepSignals {
 public:
  SweepSignals() {
    sigemptyset(&set_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
      struct sigaction before {};
      // A signal that is ignored, as by nohup, stays ignored.
      if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaddset(&set_, signal);
    }
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
  }
  ~SweepSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SweepSignals(const SweepSignals&) = delete;
  SweepSignals& operator=(const SweepSignals&) = delete;
  // Number of the first signal that came; 0: none.
  [[nodiscard]] int came() {
    const timespec none{};
    if (const int signal = sigtimedwait(&set_, nullptr, &none); signal > 0 && first_ == 0) first_ = signal;
    return first_;
  }

 private:
  sigset_t set_{}, before_{};
  int first_ = 0;
};

std::string duration_text(double s) {
  if (s < 100.0) return fmt::format("{:.0f} s", s);
  return s < 6000.0 ? fmt::format("{:.0f} min", s / 60.0) : fmt::format("{:.1f} h", s / 3600.0);
}

// Shows on standard error how far the shard is: a line that renews itself in a terminal, some lines in a
// file.
class SweepProgress {
 public:
  explicit SweepProgress(const trial::ShardFile& shard) : shard_(shard), first_(shard.finished()) {}
  void show() {
    const double now = since(start_);
    if (now < next_) return;
    next_ = now + (error_.terminal() ? 0.2 : 30.0);  // s
    const std::string text = words(now);
    error_.write(error_.terminal() ? fmt::format("\r  {:<70}", text) : "encounter: " + text + "\n");
  }
  void end() {
    if (error_.terminal()) error_.write(fmt::format("\r{:72}\r", ""));
  }

 private:
  [[nodiscard]] std::string words(double now) const {
    const std::int64_t done = shard_.finished(), left = shard_.count() - done;
    std::string text = fmt::format("{} of {}", done, counted(shard_.count(), "run"));
    if (shard_.failures() > 0) text += fmt::format(", {} failed", shard_.failures());
    if (done > first_)
      text += fmt::format(
          ", {} left", duration_text(now / static_cast<double>(done - first_) * static_cast<double>(left)));
    return text;
  }
  const trial::StandardError error_;
  const trial::ShardFile& shard_;
  const std::int64_t first_;
  const WallClock::time_point start_ = WallClock::now();
  double next_ = 1.0;  // s: a sweep that is refused at once prints one line
};

// Does the missing runs of a shard. 0: all are there; else the signal that stopped it.
int do_shard(const trial::SweepSpec& spec, trial::ShardFile& shard, std::size_t workers) {
  if (shard.finished() == shard.count()) return 0;
  SweepRunner runner(spec);
  SweepSignals signals;
  SweepProgress progress(shard);
  const WorkerJob job{
      [&] { runner.check_measures(); }, [&](std::int64_t run) { return runner.line(run); },
      [&](std::int64_t run, int signal, int times) { return runner.line_of_killed(run, signal, times); }};
  const WorkerQueue queue{[&](std::size_t most) { return shard.next(most); },
                          [&] { return shard.count() - shard.finished(); },
                          [&](const std::string& line) { shard.append(line); },
                          [&] {
                            progress.show();
                            return signals.came() != 0;
                          }};
  WorkerPool pool(workers, job, queue);
  pool.check();
  const bool all = pool.run();
  progress.end();
  return all ? 0 : signals.came();
}

void print_table(const std::string& folder, const SweepTable& table) {
  const auto runs = static_cast<std::int64_t>(table.exits.size());
  fmt::print("sweep       {} of {}; {} failed, {} crossed limits (exit code 1)\n", counted(runs, "run"),
             table.spec.scene, table.failures(), table.crossed());
  constexpr std::size_t kMost = 10;
  for (std::size_t i = 0; i < std::min(kMost, table.errors.size()); ++i)
    fmt::print("failed      {}\n", models::printable(table.errors[i]));
  if (table.errors.size() > kMost)
    fmt::print("failed      and {} more, in results.csv\n", table.errors.size() - kMost);
  double sum = 0.0;
  for (const double s : table.cpu) sum += s;
  fmt::print("cost        {:.1f} s of CPU time; a run {:.3f} s (median)\n", sum, models::median(table.cpu));
  fmt::print("results     {0}/report.html, results.csv, results.ndjson, cost.csv\n", folder);
}

int merge(const SweepOptions& options, const trial::SweepSpec& spec, const trial::SweepIdentity& identity) {
  const SweepTable table = write_results(options.out, spec, identity);
  print_table(options.out, table);
  return table.failures() > 0 ? 1 : 0;
}

int status(const SweepOptions& options, const trial::SweepIdentity& identity) {
  const std::vector<trial::ShardState> shards = trial::shards_in(options.out, identity);
  std::int64_t finished = 0, failures = 0, whole = 0;
  for (const trial::ShardState& s : shards) {
    fmt::print("shard {:<6}{} of {}, {} failed, {:.1f} s of CPU time; {}\n",
               fmt::format("{}/{}", s.number.index, s.number.count), s.finished,
               counted(s.number.runs(identity.runs), "run"), s.failures, s.cpu,
               s.whole     ? "whole"
               : s.running ? "running"
                           : "stopped");
    finished += s.finished;
    failures += s.failures;
    whole += s.whole ? 1 : 0;
  }
  const std::int64_t count = shards.empty() ? 1 : shards.front().number.count;
  fmt::print("sweep       {} of {}, {} failed; {} of {} whole\n", finished, counted(identity.runs, "run"),
             failures, whole, counted(count, "shard"));
  return whole == count && failures == 0 ? 0 : 1;
}

std::string program_file() {
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none).string();
}

SweepOptions with_folder(SweepOptions options) {
  if (options.out.empty()) options.out = fs::path(options.spec).stem().string() + "_sweep";
  while (options.out.size() > 1 && options.out.ends_with('/')) options.out.pop_back();
  return options;
}

// Each point loads the scene's files.
void check_unchanged(const SweepOptions& options, const trial::SweepSpec& spec,
                     const trial::SweepIdentity& identity) {
  if (identity_of(spec, sweep_setup(spec, {})).text != identity.text)
    throw Error(
        fmt::format("{}: the scene, its rig or another file of them changed while this sweep ran; "
                    "expected the same for all runs; remove {} and begin anew",
                    spec.scene, options.out));
}

// A shard, and the results if it is the only one.
int run_shard(const SweepOptions& options, const trial::SweepSpec& spec,
              const trial::SweepIdentity& identity) {
  const SweepShare share = share_of(options.shard);
  const bool existed = fs::exists(options.out);
  {
    trial::ShardFile shard(options.out, identity, share.shard,
                           options.only.empty() ? trial::Retry::none : trial::Retry::failures);
    try {
      if (const int signal = do_shard(spec, shard, share.workers); signal != 0) {
        fmt::print(stderr, "encounter: stopped after {} of {}; the same command goes on\n", shard.finished(),
                   counted(shard.count(), "run"));
        return 128 + signal;
      }
    } catch (const Error&) {
      if (shard.finished() == 0) shard.discard(existed ? std::string() : options.out);
      throw;
    }
    check_unchanged(options, spec, identity);
    shard.complete();
    if (!share.alone) {
      fmt::print("shard       {} of {}: {}, {} failed, {:.1f} s of CPU time\n", share.shard.index,
                 share.shard.count, counted(shard.count(), "run"), shard.failures(), shard.cpu());
      return shard.failures() > 0 ? 1 : 0;
    }
  }
  return merge(options, spec, identity);
}

}  // namespace

int sweep(const SweepOptions& given) {
  const SweepOptions options = with_folder(given);
  const trial::SweepSpec spec = trial::load_sweep(options.spec);
  // The scene as its files are: values of the axes are checked against it.
  const models::Setup setup = sweep_setup(spec, {});
  trial::check_axes(spec, setup);
  if (!options.submit.empty()) {
    fmt::print("{}", slurm_script(options, program_file()));
    return 0;
  }
  const trial::SweepIdentity identity = identity_of(spec, setup);
  if (options.status) return status(options, identity);
  if (options.merge) return merge(options, spec, identity);
  return run_shard(options, spec, identity);
}

}  // namespace enc::app
