#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "benchmarks/commands/commands.h"
#include "benchmarks/commands/committed.h"
#include "benchmarks/kit/bench.h"
#include "benchmarks/report/choice.h"
#include "benchmarks/report/report.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/scene_file.h"
#include "trial/operator/consent.h"
#include "trial/operator/standard_error.h"

namespace enc::bench {
namespace {

using WallClock = std::chrono::steady_clock;

double since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

std::string bounds(const Figure& f) {
  if (std::isfinite(f.low) && std::isfinite(f.high))
    return fmt::format(" within {:.4g}..{:.4g}", f.low, f.high);
  if (std::isfinite(f.high)) return fmt::format(" at most {:.4g}", f.high);
  return std::isfinite(f.low) ? fmt::format(" at least {:.4g}", f.low) : "";
}

std::string value(const Figure& f) {
  return std::isnan(f.twin) ? std::string("absent") : fmt::format("{:.4g}", f.twin);
}

// The words that were given, for the report: whoever repeats them gets its figures.
std::string command_of(const trial::BenchOptions& options) {
  std::string text = "./encounter bench";
  for (const std::string& name : options.names) text += " " + name;
  if (options.quick) text += " --quick";
  if (options.full) text += " --full";
  if (options.seed != 1) text += fmt::format(" --seed {}", options.seed);
  if (options.repeats != 0) text += fmt::format(" --repeats {}", options.repeats);
  if (!options.rig.empty()) text += " --rig " + options.rig;
  if (options.armed) text += " --armed";
  if (options.lockstep) text += " --lockstep";
  if (options.not_real_time) text += " --not-real-time";
  if (options.fakes) text += " --fakes";
  for (const std::string& set : options.set) text += " --set '" + set + "'";
  return text;
}

// A run with other settings gives other figures: there is nothing to compare them with.
bool is_default(const trial::BenchOptions& options) {
  return !options.quick && !options.full && options.seed == 1 && options.repeats == 0 &&
         options.set.empty() && options.rig.empty();
}

// Columns one beside the other; the last one as long as it is.
void print_table(const Table& table) {
  std::vector<std::size_t> width;
  for (const std::string& column : table.columns) width.push_back(column.size());
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text;
    for (std::size_t c = 0; c + 1 < row.size(); ++c) text += fmt::format("{:<{}}  ", row[c], width[c]);
    fmt::print("  {}{}\n", text, row.back());
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
}

// Signals that end a process wait until somebody asks; threads and what they start inherit that. Over devices
// a suspension ends it, too: what was measured before it is no measure.
class Signals {
 public:
  explicit Signals(bool over_devices) {
    sigemptyset(&set_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1}) wait_for(signal);
    if (over_devices)
      for (const int signal : {SIGTSTP, SIGUSR2, SIGALRM, SIGXCPU, SIGPWR}) wait_for(signal);
    sigset_t blocked = set_;
    for (const int signal : {SIGTTIN, SIGTTOU}) sigaddset(&blocked, signal);  // reading fails instead
    pthread_sigmask(SIG_BLOCK, &blocked, &before_);
  }
  ~Signals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  // Number of one that came; 0 or less: none.
  [[nodiscard]] int came() const {
    const timespec none{};
    return sigtimedwait(&set_, nullptr, &none);
  }

 private:
  // One that is ignored, as by nohup, stays so.
  void wait_for(int signal) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaddset(&set_, signal);
  }

  sigset_t set_{}, before_{};
};

// How far a benchmark is: a line that renews itself in a terminal, one line in a file.
class Teller {
 public:
  Teller(const char* name, std::size_t number, std::size_t of)
      : text_(fmt::format("{} of {}: {}", number, of, name)) {}
  void tell(double share) {
    if (error_.terminal())
      error_.write(
          fmt::format("\r  {} {:3.0f} %  {:.0f} s ", text_, std::floor(100.0 * share), since(start_)));
    else if (since(start_) > 2.0)  // what is refused at once has one line: why
      say();
  }
  void end() {
    if (error_.terminal())
      error_.write(fmt::format("\r{:60}\r", ""));
    else
      say();
  }

 private:
  void say() {
    if (!said_) error_.write(fmt::format("encounter: {}\n", text_));
    said_ = true;
  }
  const trial::StandardError error_;  // this thread looks for signals, too
  const std::string text_;
  const WallClock::time_point start_ = WallClock::now();
  bool said_ = false;
};

// New, empty, or with what an earlier `bench` has put there: then it may be used again.
void check_folder(const std::string& path, bool force) {
  namespace fs = std::filesystem;
  if (force || fs::is_empty(path)) return;
  constexpr std::string_view kOurs = "{\n  \"encounter\"";
  std::string start(kOurs.size(), ' ');
  std::ifstream(fs::path(path) / "results.json")
      .read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start != kOurs)
    throw Error(path +
                ": holds other files; expected a new folder, an empty one or one of `encounter bench`; "
                "choose one, or give --force to write over what has the same names");
}

std::vector<Choice> choices_of(const trial::BenchOptions& options) {
  std::vector<Choice> all = chosen(options.names);
  if (!options.rig.empty()) all = over_devices(std::move(all), !options.names.empty());
  if (options.set.empty()) return all;
  std::vector<std::string> left;
  all = settable(std::move(all), !options.names.empty(), models::models_dir(), left);
  if (!left.empty())
    fmt::print(stderr, "encounter: left out: {}; they read no scene that --set could change\n",
               fmt::join(left, ", "));
  return all;
}

// The work is done in a thread of its own, so that this one can tell, and can stop whatever the other does.
class Session {
 public:
  Session(const trial::BenchOptions& options, const trial::ModuleFinder& modules)
      : options_(options), choices_(choices_of(options)), signals_(!options.rig.empty()) {
    if (!options.out.empty()) {
      folder_.emplace(options.out);
      check_folder(options.out, options.force);
    }
    report_.command = command_of(options);
    report_.seed = options.seed;
    report_.set = options.set;
    for (const Choice& choice : choices_) report_.missing.emplace_back(choice.benchmark->name);
    context_.models = models::models_dir();
    report_.background = load_background(context_.models);
    if (is_default(options)) committed_ = Committed::load(context_.models);
    context_.seed = options.seed;
    context_.repeats = options.repeats;
    context_.quick = options.quick;
    context_.full = options.full;
    context_.set = options.set;
    context_.module = modules;
    context_.rig = options.rig;
    context_.armed = options.armed;
    context_.lockstep = options.lockstep;
    context_.fakes = options.fakes;
    context_.not_real_time = options.not_real_time;
    context_.confirm = [this](const std::string& question) { confirm(question); };
    context_.stop = [this] { return stopping_.load(); };
    context_.progress = [this](double share) { share_ = share; };
  }

  int run() {
    begin();
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      const Choice& choice = choices_[i];
      BenchResult result = measured(*choice.benchmark, i + 1);
      check_ids(choice, result);
      print(choice, result);
      add_result(report_, std::move(result));
      write();
    }
    const std::string felt = verdict_line(judged(report_.results, report_.background.thresholds));
    if (!felt.empty()) fmt::print("errors beside what a person can tell: {}\n", felt);
    if (!options_.out.empty() && !report_.not_drawn.empty())
      fmt::print(stderr, "encounter: not drawn: {}; tables and figures are complete\n", report_.not_drawn);
    if (!differ_.empty())
      fmt::print("not as in benchmarks/reference/figures.csv, by more than their spread: {}\n",
                 fmt::join(differ_, ", "));
    if (fell_short_.empty()) return 0;
    fmt::print("out of bounds: {}\n", fmt::join(fell_short_, ", "));
    return 1;
  }

 private:
  BenchResult measured(const Benchmark& benchmark, std::size_t number) {
    if (const int signal = signals_.came(); signal > 0) stop(signal);
    share_ = 0.0;
    Teller teller(benchmark.name, number, choices_.size());
    const WallClock::time_point start = WallClock::now();
    std::future<BenchResult> work =
        std::async(std::launch::async, [&] { return result_of(benchmark, context_); });
    while (work.wait_for(kTurn) != std::future_status::ready) {
      if (const int signal = signals_.came(); signal > 0) {
        let_go(work);
        stop(signal);
      }
      teller.tell(share_);
    }
    BenchResult result = work.get();
    result.run_time = since(start);
    teller.end();
    return result;
  }

  // A machine that moves is stopped by its run, and fakes are ended, however many signals come meanwhile.
  void let_go(const std::future<BenchResult>& work) {
    stopping_ = true;
    while (!options_.rig.empty() && work.wait_for(kTurn) != std::future_status::ready) {
    }
  }

  // Once, before the first motion. The worker's thread asks, and this one still looks for signals.
  void confirm(const std::string& question) {
    if (confirmed_ || options_.yes) return;
    trial::refuse_unasked();
    const trial::Answer answer = trial::ask("\n" + question, [this] { return stopping_.load(); });
    if (answer == trial::Answer::stopped) throw Error("interrupted; nothing has moved");
    if (answer == trial::Answer::no) throw Error("not begun; nothing has moved");
    confirmed_ = true;
  }

  void print(const Choice& choice, const BenchResult& result) {
    fmt::print("{} ({}): {}{:.2f} s\n", result.name, choice.benchmark->what,
               result.simulated > 0.0 ? fmt::format("{:.1f} s simulated in ", result.simulated) : "",
               result.run_time);
    for (const Figure& f : result.figures) {
      if (!wanted(choice, f)) continue;
      if (!f.ok()) fell_short_.push_back(f.id);
      const bool differs = committed_.differs(f);
      if (differs) differ_.push_back(f.id);
      fmt::print("  {:34} {:>10} {:5}{}{}{}{}\n", f.id, value(f), f.unit,
                 std::isfinite(f.paper) ? fmt::format(" (paper {:.4g}, {})", f.paper, role_name(f.role)) : "",
                 bounds(f), differs ? fmt::format("  was {:.4g}", committed_.find(f.id)->value) : "",
                 f.ok() ? "" : "  OUT OF BOUNDS");
    }
    for (const Table& table : result.tables)
      if (table.printed && choice.ids.empty()) print_table(table);
    if (!result.note.empty()) fmt::print("  {}\n", result.note);
    std::fflush(stdout);
  }

  // An unwritable folder is refused before hours of work. A report that is there stays until there is more to
  // say than that all is missing.
  void begin() const {
    if (options_.out.empty()) return;
    const std::string results = (std::filesystem::path(options_.out) / "results.json").string();
    if (!std::filesystem::exists(results)) return write();
    const models::OutFile writable(results, models::Existing::replace);
  }
  void write() const {
    if (!options_.out.empty()) write_report(options_.out, report_);
  }

  // The files already say what is missing. The other thread may be anywhere, so nothing is torn down.
  [[noreturn]] void stop(int signal) const {
    std::string missing;
    for (const std::string& name : report_.missing) missing += " " + name;
    const trial::StandardError error;
    error.write(fmt::format("{}encounter: interrupted; {} of {} benchmarks complete, missing:{}\n",
                            error.terminal() ? "\n" : "", report_.results.size(), choices_.size(), missing));
    _exit(128 + signal);
  }

  static constexpr std::chrono::milliseconds kTurn{50};

  const trial::BenchOptions& options_;
  const std::vector<Choice> choices_;
  std::optional<models::OutFolder> folder_;
  const Signals signals_;
  Report report_;
  BenchContext context_;
  std::atomic<double> share_{0.0};
  std::atomic<bool> stopping_{false};
  bool confirmed_ = false;               // of the worker
  std::vector<std::string> fell_short_;  // ids
  Committed committed_;
  std::vector<std::string> differ_;  // ids
};

int list_benchmarks() {
  for (const Benchmark& b : benchmarks()) fmt::print("{:12} {}\n", b.name, b.what);
  for (const Group& g : groups()) {
    std::string members;
    for (const std::string& member : g.members) members += " " + member;
    fmt::print("{:12} {}:{}\n", g.name, g.what, members);
  }
  return 0;
}

}  // namespace

int bench_command(const trial::BenchOptions& options, const trial::ModuleFinder& modules) {
  if (options.list) return list_benchmarks();
  if (options.repeats < 0 || options.repeats > 1'000'000)
    throw Error("--repeats: expected a whole number from 1 to 1000000");
  for (const auto& [given, name] :
       {std::pair{options.armed, "--armed"}, {options.lockstep, "--lockstep"}, {options.fakes, "--fakes"}})
    if (given && options.rig.empty())
      throw Error(fmt::format(
          "{}: it is of the devices of a rig; expected --rig, too; name one, or leave it out", name));
  if (options.quick && options.full) throw Error("--quick and --full exclude each other; give one of them");
  return Session(options, modules).run();
}

}  // namespace enc::bench
