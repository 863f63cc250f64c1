// A person at the terminal of an armed run: whatever they press, send or close, the machine stops and the run
// ends.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/record/record.h"
#include "tests/conformance/laboratory.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/terminal/run_record.h"

namespace enc::test {
namespace {

using ::testing::HasSubstr;
using tests::module_folder;

// A person's terminal: an interactive shell on a pseudo-terminal, its keys and its output.
class Terminal {
 public:
  // Starts bash as the shell, which has job control and sends SIGHUP to its jobs when the terminal closes.
  Terminal();
  ~Terminal();  // closes it, and kills the remaining processes
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Types a command line with each word quoted, and `rest` unquoted.
  void run(const std::vector<std::string>& words, const std::string& rest = {});
  void type(const std::string& keys) const;  // unchanged: "\x03" is Ctrl-C
  void close();
  void hang(bool hangs) { reads_ = !hangs; }  // its link: the output is no longer read

  // The whole output so far.
  [[nodiscard]] std::string shown() const;
  // Waits until the output has this text behind `from`; returns false after the timeout.
  [[nodiscard]] bool shows(const std::string& text, double seconds, std::size_t from = 0) const;
  // The program in the shell; -1: no program within a second.
  [[nodiscard]] pid_t child() const;

 private:
  int master_ = -1;
  pid_t shell_ = -1;
  mutable std::mutex mutex_;
  std::string shown_;
  std::atomic<bool> over_ = false, reads_ = true;
  std::thread reader_;
};

// True if a process ends within so many seconds.
bool ends(pid_t process, double seconds);

using Clock = std::chrono::steady_clock;
void wait_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

template <class Is>
bool within(double seconds, const Is& is) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  while (!is()) {
    if (Clock::now() > until) return false;
    wait_ms(1);
  }
  return true;
}

Terminal::Terminal() {
  winsize size{};
  size.ws_col = 200;
  size.ws_row = 50;
  // Made before the fork: several threads may open several terminals.
  std::vector<std::string> variables{"ENCOUNTER_MODULES=" + module_folder(), "PS1=$ ", "TERM=dumb",
                                     "HOME=/tmp", "PATH=/usr/local/bin:/usr/bin:/bin"};
  std::vector<std::string> words{"bash", "--norc", "--noprofile", "--noediting", "-i"};
  std::vector<char*> environment, arguments;
  for (std::string& one : variables) environment.push_back(one.data());
  for (std::string& one : words) arguments.push_back(one.data());
  environment.push_back(nullptr);
  arguments.push_back(nullptr);
  static_cast<void>(fflush(nullptr));  // the child must not inherit buffered output
  shell_ = forkpty(&master_, nullptr, nullptr, &size);
  if (shell_ == 0) {
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGTTIN, SIGTTOU})
      std::signal(signal, SIG_DFL);
    close_range(3, ~0U, 0);  // otherwise this shell keeps the terminals of other tests open
    execve("/bin/bash", arguments.data(), environment.data());
    _exit(127);
  }
  fcntl(master_, F_SETFD, FD_CLOEXEC);
  reader_ = std::thread([this] {
    std::array<char, 4096> bytes{};
    while (!over_) {
      pollfd ready{master_, POLLIN, 0};
      if (!reads_) wait_ms(2);
      if (!reads_ || poll(&ready, 1, 2) <= 0) continue;
      const ssize_t got = read(master_, bytes.data(), bytes.size());
      if (got <= 0) break;
      const std::lock_guard lock(mutex_);
      shown_.append(bytes.data(), static_cast<std::size_t>(got));
    }
  });
}

Terminal::~Terminal() {
  const pid_t left = child();
  close();
  if (left > 0 && !ends(left, 2.0)) kill(left, SIGKILL);
  kill(shell_, SIGKILL);
  waitpid(shell_, nullptr, 0);
}

void Terminal::close() {
  over_ = true;
  if (reader_.joinable()) reader_.join();
  if (master_ >= 0) ::close(master_);
  master_ = -1;
}

void Terminal::run(const std::vector<std::string>& words, const std::string& rest) {
  std::string line;
  for (const std::string& word : words) line += "'" + word + "' ";
  type(line + rest + "\n");
}

void Terminal::type(const std::string& keys) const {
  static_cast<void>(write(master_, keys.data(), keys.size()));
}

std::string Terminal::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

bool Terminal::shows(const std::string& text, double seconds, std::size_t from) const {
  return within(seconds, [&] { return shown().find(text, from) != std::string::npos; });
}

pid_t Terminal::child() const {
  const std::string list =
      "/proc/" + std::to_string(shell_) + "/task/" + std::to_string(shell_) + "/children";
  pid_t found = -1;
  static_cast<void>(within(1.0, [&] { return bool(std::ifstream(list) >> found); }));
  return found;
}

bool ends(pid_t process, double seconds) {
  return within(seconds, [&] {
    std::ifstream status("/proc/" + std::to_string(process) + "/stat");
    std::string all;
    if (!std::getline(status, all)) return true;
    const std::size_t name_end = all.rfind(')');
    return name_end == std::string::npos || all.substr(name_end + 2, 1) == "Z";
  });
}

// ---- A person at the terminal of an armed run: whatever they press, send or close, the machine stops and
// the record is sealed. The fakes are in this process, and a shell on a pseudo-terminal starts the run.

constexpr double kSetPoints = 0.030;  // s: three set-points of models/rigs/fakes.toml

// The tool touches a wall after some 1.5 s, again and again. The hand lets go faster than the tip follows, so
// that restore lasts.
constexpr const char* kScene = R"(format = 1
title = "A wall for somebody at the terminal"
[[object]]
name = "wall"
shape = "plane"
position_mm = [0, 0, 10]
normal = [0, 0, 1]
behaviour = "wall"
[[tool]]
name = "stylus"
markers_mm = [[0, 0, 0], [52, 0, 0], [0, 41, 0], [-17, -30, 12]]
tip_mm = [0, 0, -120]
[manipulator]
[force]
[tracker]
[user]
depth_mm = 3
press_s = 0.4
hold_s = 0.4
release_s = 0.02
rest_s = 1.5
approach_from_mm = 30
approach_mm_s = [50]
repeats = 20
)";

// Fakes in this process, a terminal, and an armed run in it.
class TerminalSession {
 public:
  explicit TerminalSession(std::vector<std::string> more = {"--yes"}) {
    std::ofstream(scene_) << kScene;
    static std::mutex one_at_a_time;  // several would set variables of this process
    {
      const std::lock_guard lock(one_at_a_time);
      const std::vector<std::string> none;
      for (int attempt = 0; !there_; ++attempt) {
        try {
          there_ = std::make_unique<Laboratory>(false, none, none, scene_);
        } catch (const Error&) {
          if (attempt == 5) throw;  // another program may just have taken a port
        }
      }
    }
    words_ = {tests::program_file(),
              "run",
              scene_,
              "--rig",
              "fakes",
              "--armed",
              "--for-s",
              "60",
              "--record",
              record()};
    for (const std::string& set : there_->ports) words_.insert(words_.end(), {"--set", set});
    words_.insert(words_.end(), more.begin(), more.end());
    EXPECT_TRUE(terminal.shows("$ ", 10.0));
  }
  void begin(const std::string& rest = {}) { terminal.run(words_, rest); }
  // Begins with a terminal of its own as standard input, which sends no signal.
  void begin_with_own_input() {
    int slave = -1;
    std::array<char, 100> name{};
    ASSERT_EQ(openpty(&input_, &slave, name.data(), nullptr, nullptr), 0);
    terminal.run(words_, std::string("< ") + name.data());
    EXPECT_TRUE(terminal.shows("  missed ", 20.0)) << terminal.shown();
    ::close(slave);
  }
  void close_input() { ::close(std::exchange(input_, -1)); }
  [[nodiscard]] std::string record() const { return folder_.file("r.encrec"); }
  // True if the run came to `mode`. A busy machine may have put it in hold before.
  [[nodiscard]] bool comes_to(const std::string& mode) {
    if (!terminal.shows("s  follow", 20.0)) return false;
    if (mode == "hold") fault("igtl:stall");
    const std::string sign = mode == "contact"   ? "s  contact 1 with 'wall'"
                             : mode == "restore" ? "s  contact 1 is over"
                             : mode == "hold"    ? "s  hold: tool lost"
                                                 : "s  follow";
    return terminal.shows(sign, 20.0);
  }
  void end(pid_t run) const {
    kill(run, SIGTERM);
    EXPECT_TRUE(ends(run, 10.0)) << terminal.shown();
  }
  void fault(const std::string& text) {
    there_->pause();
    there_->fakes->suffer(app::fault_of(text, "the test"), "the test");
    there_->serve();
  }
  void heal() {
    there_->pause();
    there_->fakes->heal();
    there_->serve();
  }
  [[nodiscard]] double now() const { return there_->now; }
  // True if a finished run commanded the machine to stop, between two moments of the fakes' world.
  [[nodiscard]] bool stopped_between(double from, double to) {
    constexpr double kTick = 0.002;  // s: the log stamps a command with the tick before
    const std::vector<double> all = stops_in(there_->log());
    return std::any_of(all.begin(), all.end(), [&](double t) { return t >= from - kTick && t <= to; });
  }
  [[nodiscard]] bool is_sealed_within(double seconds) const {
    for (double waited = 0.0; waited < seconds; waited += 0.01) {
      if (std::filesystem::exists(record())) return RecordReader(record()).sealed();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  [[nodiscard]] std::string stops() { return there_->log(); }
  [[nodiscard]] bool stands_for(double time) const {
    there_->moves = false;
    std::this_thread::sleep_for(std::chrono::duration<double>(time));
    return !there_->moves;
  }
  Terminal terminal;

 private:
  const TemporaryFolder folder_;
  const std::string scene_ = folder_.file("wall.toml");
  std::unique_ptr<Laboratory> there_;
  std::vector<std::string> words_;
  int input_ = -1;
};

struct Way {
  const char* name;
  int code;  // exit code of the run; -1: no shell is left
  std::function<void(TerminalSession& at, pid_t run)> act;
  bool own_input = false;
};

const std::vector<Way>& ways() {
  // The signal does not come from a key: a busy kernel delivers a key's signal seconds late.
  const auto sent = [](int signal, int times) {
    return [signal, times](TerminalSession&, pid_t run) {
      for (int i = 0; i < times; ++i) kill(run, signal);
    };
  };
  static const std::vector<Way> kWays{
      {"SIGHUP twice", 129, sent(SIGHUP, 2)},
      {"SIGINT three times", 130, sent(SIGINT, 3)},
      {"SIGTERM", 143, sent(SIGTERM, 1)},
      {"SIGQUIT", 131, sent(SIGQUIT, 1)},
      {"closed terminal", -1, [](TerminalSession& at, pid_t) { at.terminal.close(); }},
      {"closed standard input", 129, [](TerminalSession& at, pid_t) { at.close_input(); }, true}};
  return kWays;
}

// Ends one run in one way in one mode. Repeats if the mode was over before the signal came.
void end_in(const Way& way, const std::string& mode) {
  std::string met, last;
  for (int attempt = 0; attempt < 6 && met != mode; ++attempt) {
    SCOPED_TRACE(std::string(way.name) + " in " + mode);
    TerminalSession at;
    way.own_input ? at.begin_with_own_input() : at.begin();
    const bool there = at.comes_to(mode);
    const pid_t run = at.terminal.child();
    ASSERT_GT(run, 0);
    if (!there) {
      last = at.terminal.shown();
      at.end(run);
      continue;
    }
    const double before = at.now();
    way.act(at, run);
    const double acted = at.now();
    ASSERT_TRUE(ends(run, 10.0)) << at.terminal.shown();
    EXPECT_TRUE(at.stopped_between(before, acted + kSetPoints)) << at.stops();
    ASSERT_NO_THROW(met = last_mode(at.record())) << at.terminal.shown();
    if (way.code < 0) continue;
    const std::size_t from = at.terminal.shown().size();
    at.terminal.type("echo code $?\n");
    EXPECT_TRUE(at.terminal.shows(fmt::format("code {}", way.code), 5.0, from)) << at.terminal.shown();
  }
  EXPECT_EQ(met, mode) << way.name << last;
}

// SIGTSTP stops the machine before the process. After fg the machine stands until r, and the keys work.
void suspend_in(const std::string& mode) {
  std::string met, last;
  for (int attempt = 0; attempt < 6 && met != mode; ++attempt) {
    SCOPED_TRACE("SIGTSTP in " + mode);
    TerminalSession at;
    at.begin();
    const bool there = at.comes_to(mode);
    const pid_t run = at.terminal.child();
    if (!there) {
      last = at.terminal.shown();
      at.end(run);
      continue;
    }
    const double before = at.now();
    kill(run, SIGTSTP);
    const double acted = at.now();
    ASSERT_TRUE(at.terminal.shows("Stopped", 10.0)) << at.terminal.shown();
    std::this_thread::sleep_for(std::chrono::milliseconds(700));  // it comes to rest
    EXPECT_TRUE(at.stands_for(0.2));
    at.terminal.type("stty sane\nfg\n");
    EXPECT_TRUE(at.terminal.shows("STOPPED BY HAND", 10.0)) << at.terminal.shown();
    EXPECT_TRUE(at.stands_for(0.3));
    if (mode == "hold") at.heal();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the tracker is connected again
    at.terminal.type("r");
    EXPECT_TRUE(at.terminal.shows("s  resumed", 10.0)) << at.terminal.shown();
    at.terminal.type("q");
    ASSERT_TRUE(ends(run, 10.0)) << at.terminal.shown();
    // The mode of the tick in which the stop was sent, and its time.
    double sent = kUnset;
    RecordReader reader(at.record());
    EXPECT_TRUE(reader.sealed());
    RecordedTick tick, earlier;
    while (reader.next(tick)) {
      if (std::isnan(sent) && tick.in.tip.health == Health::fault) {
        sent = seconds(tick.tick.t.time_since_epoch());
        met = mode_name(earlier.out.mode);
      }
      earlier = tick;
    }
    EXPECT_GT(sent, 0.0);
    EXPECT_TRUE(at.stopped_between(before, acted + kSetPoints)) << at.stops();
  }
  EXPECT_EQ(met, mode) << last;
}

void for_each_mode(const std::function<void(const std::string&)>& check) {
  std::vector<std::future<void>> all;
  for (const char* mode : {"follow", "contact", "restore", "hold"})
    all.push_back(std::async(std::launch::async, check, mode));
  for (std::future<void>& one : all) one.get();
}

class AtTheTerminal : public testing::TestWithParam<std::size_t> {};
void end_everywhere(const Way& way) {
  for_each_mode([&](const std::string& mode) { end_in(way, mode); });
}
TEST_P(AtTheTerminal, WhateverEndsTheRunStopsTheMachineAndSealsTheRecord) {
  end_everywhere(ways()[GetParam()]);
}
INSTANTIATE_TEST_SUITE_P(Each, AtTheTerminal, testing::Range<std::size_t>(0, ways().size()));

TEST(AtTheTerminalToo, ASuspensionStopsTheMachineAndTheKeysWorkAfterFg) { for_each_mode(suspend_in); }

// Space stops and r resumes; the status line has the information that a person needs.
TEST(AtTheTerminalToo, TheStatusLineAndTheEventsAreThere) {
  TerminalSession at;
  at.begin();
  ASSERT_TRUE(at.comes_to("contact")) << at.terminal.shown();
  EXPECT_THAT(at.terminal.shown(),
              testing::ContainsRegex("s  follow  \\| space stops, r resumes, q ends \\|  [0-9.]+ N  "
                                     "gap [0-9.]+ mm  p99 [0-9.]+ ms  missed [0-9]+"));
  at.terminal.type(" ");
  EXPECT_TRUE(at.terminal.shows("s  stopped by hand: the machine stands until r", 5.0));
  EXPECT_TRUE(at.terminal.shows("s  STOPPED BY HAND", 5.0));
  std::size_t from = at.terminal.shown().size();
  at.terminal.type("r");
  EXPECT_TRUE(at.terminal.shows("s  resumed", 5.0, from));
  at.terminal.type("r");  // the machine was not stopped, so this is no event
  EXPECT_TRUE(at.terminal.shows("s  hold is over", 5.0, from)) << at.terminal.shown();
  from = at.terminal.shown().size();
  at.fault("netft:stall");
  EXPECT_TRUE(at.terminal.shows("s  link lost: force sensor", 5.0, from)) << at.terminal.shown();
  at.terminal.type("q");
  EXPECT_TRUE(at.terminal.shows("s  ends: q", 5.0, from));
  EXPECT_THAT(at.terminal.shown().substr(from), testing::Not(HasSubstr("resumed")));
}

// Ctrl-S: the terminal takes no output. The loop keeps its time, and a stop still stops.
TEST(AtTheTerminalToo, ATerminalThatTakesNoWordsKeepsNoTickWaiting) {
  TerminalSession at;
  at.begin();
  ASSERT_TRUE(at.comes_to("follow")) << at.terminal.shown();
  at.terminal.type("\x13");
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  const pid_t run = at.terminal.child();
  const double before = at.now();
  kill(run, SIGTERM);
  const double acted = at.now();
  EXPECT_TRUE(at.is_sealed_within(5.0));
  at.terminal.type("\x11");  // only its report is outstanding
  ASSERT_TRUE(ends(run, 10.0));
  EXPECT_TRUE(at.stopped_between(before, acted + kSetPoints)) << at.stops();
  RecordReader reader(at.record());
  EXPECT_TRUE(reader.sealed());
  std::int64_t missed = 0;
  RecordedTick tick;
  while (reader.next(tick)) missed = std::max(missed, tick.in.missed);
  EXPECT_LT(missed, 50) << "cycles at once: the loop waited for the terminal";
}

// The link to the terminal hangs: it takes some kB, and then no more bytes, not even an end.
TEST(AtTheTerminalToo, ATerminalThatHangsLeavesNoRecordUnsealed) {
  TerminalSession at;
  at.begin();
  ASSERT_TRUE(at.comes_to("follow")) << at.terminal.shown();
  const pid_t run = at.terminal.child();
  at.terminal.hang(true);
  std::this_thread::sleep_for(std::chrono::seconds(7));  // status lines fill its buffer
  const double before = at.now();
  kill(run, SIGTERM);
  const double acted = at.now();
  EXPECT_TRUE(at.is_sealed_within(5.0));
  at.terminal.hang(false);  // only its report is outstanding
  ASSERT_TRUE(ends(run, 10.0));
  EXPECT_TRUE(at.stopped_between(before, acted + kSetPoints)) << at.stops();
}

// Before the first motion the program states the machine, the distance and the speed. Enter begins; any other
// key does not.
TEST(AtTheTerminalToo, TheFirstMotionIsAskedFor) {
  TerminalSession at(std::vector<std::string>{});
  at.begin();
  at.terminal.type("\n");  // before the question: not an answer
  ASSERT_TRUE(at.terminal.shows("Enter begins", 10.0)) << at.terminal.shown();
  EXPECT_THAT(at.terminal.shown(),
              testing::AllOf(
                  HasSubstr("manipulator C-887"),
                  testing::ContainsRegex("moves -[0-9]+ to [0-9]+, -[0-9]+ to [0-9]+, -[0-9]+ to [0-9]+ mm "
                                         "along x, y, z from its zero, at most at 50 mm/s and 0.41 m/s2")));
  EXPECT_TRUE(at.stands_for(0.5));
  at.terminal.type("no\n");
  EXPECT_TRUE(at.terminal.shows("not begun; nothing has moved", 5.0));
  std::size_t from = at.terminal.shown().size();
  at.terminal.type("echo code $?\n");
  EXPECT_TRUE(at.terminal.shows("code 2", 5.0, from));
  EXPECT_FALSE(std::filesystem::exists(at.record()));
  from = at.terminal.shown().size();
  at.begin();
  ASSERT_TRUE(at.terminal.shows("Enter begins", 10.0, from));
  at.terminal.type("\x1a");  // nothing moves yet: an ordinary pause
  ASSERT_TRUE(at.terminal.shows("Stopped", 5.0, from)) << at.terminal.shown();
  at.terminal.type("fg\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(3000));  // a person takes time
  at.terminal.type("\n");
  EXPECT_TRUE(at.terminal.shows("s  contact 1 with 'wall'", 20.0, from)) << at.terminal.shown();
  EXPECT_THAT(at.terminal.shown().substr(from), testing::Not(HasSubstr("STOPPED")));
  at.terminal.type("q");
  EXPECT_TRUE(at.terminal.shows("state hash", 10.0, from));
  from = at.terminal.shown().size();
  at.terminal.type("rm " + at.record() + "\n");
  at.begin();
  ASSERT_TRUE(at.terminal.shows("Enter begins", 10.0, from));
  at.terminal.type("\x03");
  ASSERT_TRUE(at.terminal.shows("not begun; nothing has moved", 5.0, from)) << at.terminal.shown();
  at.terminal.type("echo code $?\n");
  EXPECT_TRUE(at.terminal.shows("code 130", 5.0, from));
  from = at.terminal.shown().size();
  at.begin("2>/dev/null; echo code $?");  // the question is invisible
  EXPECT_TRUE(at.terminal.shows("code 2", 10.0, from)) << at.terminal.shown();
}

TEST(AtTheTerminalLong, WhateverEndsTheRunTwentyTimes) {
  for (int i = 0; i < 20; ++i) {
    for (const Way& way : ways()) end_everywhere(way);
    for_each_mode(suspend_in);
  }
}

}  // namespace
}  // namespace enc::test
