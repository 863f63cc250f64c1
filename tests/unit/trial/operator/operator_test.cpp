// The person at a run: signals from anywhere, keys on the terminal of its own process. Afterwards the
// terminal and the signals are as before.
#include "trial/operator/operator.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "app/run/console.h"
#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/refusal.h"
#include "tests/unit/trial/runs.h"
#include "trial/operator/terminal.h"
#include "trial/steered/steering.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

using Handler = void (*)(int);

Handler handler_of(int signal) {
  struct sigaction now {};
  EXPECT_EQ(sigaction(signal, nullptr, &now), 0);
  return now.sa_handler;
}
void nothing_of(int) {}

TEST(Operator, ActsBySignalsAndAStopComesFirst) {
  const Handler before = std::signal(SIGUSR1, nothing_of);
  std::signal(SIGUSR2, SIG_IGN);
  {
    Operator hand;
    hand.begin();
    EXPECT_EQ(hand.next(), Hand::none);
    raise(SIGUSR1);
    EXPECT_EQ(hand.next(), Hand::halt);
    EXPECT_EQ(hand.next(), Hand::none) << "once";
    raise(SIGUSR2);
    EXPECT_EQ(hand.next(), Hand::resume) << "whatever it was before";
    EXPECT_EQ(hand.next(), Hand::none);
    raise(SIGUSR2);
    raise(SIGUSR1);
    EXPECT_EQ(hand.next(), Hand::halt);
    EXPECT_EQ(hand.next(), Hand::none) << "who stops does not resume with what came before";
    EXPECT_FALSE(hand.quits());
    raise(SIGUSR1);
  }
  EXPECT_EQ(handler_of(SIGUSR1), &nothing_of);
  EXPECT_EQ(handler_of(SIGUSR2), SIG_IGN);
  EXPECT_EQ(Operator().next(), Hand::none) << "what came for the one before is not for this one";
  std::signal(SIGUSR1, before);
  std::signal(SIGUSR2, SIG_DFL);
}

TEST(Signals, AreNotedHoweverOftenTheyComeAndGivenBack) {
  const Handler before = std::signal(SIGTERM, nothing_of);
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPROF, nothing_of);
  {
    Signals signals;
    signals.begin();
    EXPECT_EQ(Signals::caught(), 0);
    for (int i = 0; i < 3; ++i) raise(SIGTERM);
    raise(SIGINT);
    EXPECT_EQ(Signals::caught(), SIGTERM) << "the first";
    EXPECT_EQ(handler_of(SIGPIPE), SIG_IGN);
    EXPECT_EQ(handler_of(SIGHUP), SIG_IGN) << "as nohup wants it";
    EXPECT_EQ(handler_of(SIGPROF), &nothing_of) << "a profiler has it";
    EXPECT_EQ(handler_of(SIGTSTP), SIG_DFL) << "only a run looks at a suspension";
  }
  EXPECT_EQ(handler_of(SIGTERM), &nothing_of);
  {
    const Signals again;
    EXPECT_EQ(Signals::caught(), 0);
  }
  std::signal(SIGTERM, before);
  for (const int signal : {SIGHUP, SIGPROF}) std::signal(signal, SIG_DFL);
}

TEST(SignalsDeathTest, EndTheProgramAtOnceBeforeAnythingHasBegun) {
  EXPECT_EXIT(
      {
        const Signals signals;
        raise(SIGQUIT);
      },
      testing::ExitedWithCode(128 + SIGQUIT), "");
}

// A fault of the program itself still ends it.
TEST(SignalsDeathTest, AFaultOfTheProgramIsNoWish) {
  EXPECT_DEATH(
      {
        Signals signals;
        signals.begin();
        std::abort();
      },
      "");
}

// ---- keys
// -----------------------------------------------------------------------------------------------------------

constexpr tcflag_t kLines = ICANON | ECHO;  // a terminal waits for the end of a line, and echoes typed text

// Runs in the process that owns the terminal, and writes a letter for each of the person's requests.
[[noreturn]] void be_at_terminal(const char* name, int says) {
  const auto say = [says](char what) { static_cast<void>(!write(says, &what, 1)); };
  setsid();
  const int terminal = open(name, O_RDWR);
  if (terminal < 0 || ioctl(terminal, TIOCSCTTY, 0) != 0 || dup2(terminal, STDIN_FILENO) < 0) _exit(3);
  {
    Operator hand;
    hand.begin();
    hand.listen();
    say(hand.reads_keys() ? 'k' : '-');
    constexpr int kMost = 100'000;  // of 0.1 ms
    for (int i = 0; i < kMost && !hand.quits(); ++i) {
      const Hand wants = hand.next();
      if (wants != Hand::none) say(wants == Hand::halt ? 'h' : 'r');
      usleep(100);
    }
    say(hand.quits() ? 'q' : '-');
  }
  termios after{};
  say(tcgetattr(STDIN_FILENO, &after) == 0 && (after.c_lflag & kLines) == kLines ? 'w' : '-');
  _exit(0);
}

// The next letter, within 10 s; else a blank.
char heard(int says) {
  pollfd ready{says, POLLIN, 0};
  char what = ' ';
  return poll(&ready, 1, 10'000) > 0 && read(says, &what, 1) == 1 ? what : ' ';
}

TEST(Operator, ReadsTheKeysOfATerminalWhichIsAfterwardsAsItWas) {
  const int keyboard = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (keyboard < 0 || grantpt(keyboard) != 0 || unlockpt(keyboard) != 0)
    GTEST_SKIP() << "there are no pseudo terminals here";
  const std::string name = ptsname(keyboard);
  std::array<int, 2> says{};
  ASSERT_EQ(pipe2(says.data(), O_CLOEXEC), 0);
  const pid_t child = fork();
  if (child == 0) be_at_terminal(name.c_str(), says[1]);
  close(says[1]);
  const auto press = [keyboard](char key) { EXPECT_EQ(write(keyboard, &key, 1), 1); };
  EXPECT_EQ(heard(says[0]), 'k');
  press(' ');
  EXPECT_EQ(heard(says[0]), 'h');
  press('x');  // a key without a meaning
  press('r');
  EXPECT_EQ(heard(says[0]), 'r');
  press('q');
  EXPECT_EQ(heard(says[0]), 'q');
  EXPECT_EQ(heard(says[0]), 'w');
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  close(says[0]);
  close(keyboard);
}

// ---- what is shown
// ------------------------------------------------------------------------------------------

TEST(RunWatch, EachChangeIsOneEvent) {
  const Scene scene;
  const sim::Truth truth;
  Tick tick;
  Inputs in;
  Outputs out;
  const auto watch = std::make_unique<RunWatch>();
  std::vector<std::string> shown;
  const auto see = [&](Mode mode, std::uint32_t why, std::int32_t contacts) {
    out.mode = mode;
    out.why = why;
    out.contacts = contacts;
    out.object = 0;
    watch->see({scene, tick, truth, in, out});
    RunEvent event;
    while (watch->next(event)) shown.push_back(app::event_text(event, {"ball"}));
  };
  see(Mode::follow, 0, 0);
  see(Mode::follow, kLimited, 0);  // a notice
  see(Mode::contact, 0, 1);
  see(Mode::hold, kToolLost, 1);
  see(Mode::hold, kToolLost, 1);
  see(Mode::hold, kToolLost | kForceLost, 1);
  see(Mode::hold, kForceLost, 1);  // a reason that ends is no news
  see(Mode::contact, 0, 1);
  see(Mode::restore, 0, 1);
  watch->note(RunEvent::Kind::ends, SIGTERM);
  see(Mode::restore, 0, 1);
  EXPECT_EQ(shown, (std::vector<std::string>{"contact 1 with 'ball'", "hold: tool lost",
                                             "hold: tool lost, force lost", "hold is over: contact",
                                             "contact 1 is over", "ends: SIGTERM"}));
  EXPECT_EQ(watch->take_dropped(), 0U);
}

TEST(RunWatch, EventsThatComeTooFastAreCounted) {
  const auto watch = std::make_unique<RunWatch>();
  for (int i = 0; i < 200; ++i) watch->note(RunEvent::Kind::halted);
  EXPECT_EQ(watch->take_dropped(), 200U - 128U);
}

TEST(Console, TheStatusLineNamesModeReasonForceGapPeriodAndKeys) {
  RunStatus status{.t = Time(from_seconds(3.214)), .mode = Mode::follow};
  EXPECT_EQ(app::status_text(status, false), "    3.21 s  follow  missed 0");
  status.gap = 0.0123;
  status.force = -0.001;
  status.missed = 7;
  status.periods = 3;
  status.periods_ns = {1'000'000, 1'010'000, 1'010'000};
  EXPECT_EQ(
      app::status_text(status, true),
      "    3.21 s  follow  | space stops, r resumes, q ends |  0.00 N  gap 12.30 mm  max 1.01 ms  missed 7")
      << "of three periods there is no p99";
  status.why = kToolLost | kLimited;
  EXPECT_EQ(app::status_text(status, false),
            "    3.21 s  HOLD: tool lost  0.00 N  gap 12.30 mm  max 1.01 ms  missed 7");
  status.periods = 100;
  status.periods_ns.fill(1'010'000);
  EXPECT_THAT(app::status_text(status, false), testing::HasSubstr("gap 12.30 mm  p99 1.01 ms  missed 7"));
  status.halted = true;
  EXPECT_THAT(app::status_text(status, false), testing::HasSubstr("STOPPED BY HAND"));
}

// A terminal that accepts no output delays nothing.

// Standard error is an unread terminal, or a pipe, in the lifetime of this object.
class UnreadStream {
 public:
  explicit UnreadStream(bool terminal) {
    std::fflush(stderr);
    if (terminal ? openpty(ends_, ends_ + 1, nullptr, nullptr, nullptr) : pipe(ends_)) return;
    dup2(ends_[1], STDERR_FILENO);
  }
  ~UnreadStream() {
    dup2(before_, STDERR_FILENO);
    close_reader();
    close(ends_[1]);
    close(before_);
  }
  UnreadStream(const UnreadStream&) = delete;
  UnreadStream& operator=(const UnreadStream&) = delete;
  void close_reader() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  [[nodiscard]] std::string read_all() const {
    std::string all(1 << 20, ' ');
    all.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(ends_[0], all.data(), all.size()))));
    return all;
  }

 private:
  const int before_ = dup(STDERR_FILENO);
  int ends_[2] = {-1, -1};
};

TEST(StandardError, IsWrittenAsFarAsItTakes) {
  for (const bool terminal : {true, false}) {
    UnreadStream unread(terminal);
    const StandardError error;
    EXPECT_EQ(error.terminal(), terminal);
    EXPECT_EQ(error.write("hello"), 5U);
    EXPECT_EQ(unread.read_all(), "hello");
    const std::string much(1 << 18, 'x');  // more than a pipe holds
    std::size_t taken = 0;
    for (int i = 0; i < 8; ++i) taken += error.write(much);
    EXPECT_GT(taken, 1000U);
    EXPECT_LT(taken, much.size());
    EXPECT_EQ(error.write(much), 0U);
  }
}

TEST(StandardError, WithoutAReaderSwallowsAll) {
  UnreadStream unread(true);
  const StandardError error;
  unread.close_reader();
  EXPECT_EQ(error.write("hello"), 5U);
}

// Faults that somebody switches on change the core's inputs, and end with their cause.

// A tracker with a new sample every 8 ticks of 1 ms, and a force sensor.
class SwitchedFaults : public testing::Test {
 protected:
  void tick() {
    if (ticks_ % 8 == 0) {
      in_.tool.t = Time{} + from_seconds(1e-3 * ticks_);
      in_.tool.health = Health::ok;
      in_.tool.value.tool = 0;
    }
    in_.wrench.value.force = {0.5, -7, 9};
    in_.wrench.health = Health::ok;
    ++ticks_;
    faults_.apply(in_);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  // Age of the core's tracker sample, ms.
  [[nodiscard]] double age() const {
    return 1e3 * seconds(Time{} + from_seconds(1e-3 * (ticks_ - 1)) - in_.tool.t);
  }

  Faults faults_;
  Inputs in_;
  int ticks_ = 0;
};

TEST_F(SwitchedFaults, NothingHappensWithoutOne) {
  run(80);
  EXPECT_NEAR(age(), 7.0, 1e-6);
  EXPECT_EQ(in_.wrench.value.force.xyz, (std::array{0.5, -7.0, 9.0}));
}

TEST_F(SwitchedFaults, AFrozenTrackerRepeatsItsLastSample) {
  run(80);
  faults_.set(kFrozenTracker);
  run(200);
  EXPECT_NEAR(age(), 207.0, 1e-6);
  faults_.set(0);
  run(8);
  EXPECT_NEAR(age(), 7.0, 1e-6);
}

TEST_F(SwitchedFaults, ThreeOfFourPacketsAreLost) {
  faults_.set(kDroppedPackets);
  std::set<Time> told;
  for (int i = 0; i < 800; ++i) {
    tick();
    told.insert(in_.tool.t);
  }
  EXPECT_NEAR(static_cast<double>(told.size()), 25.0, 1.0) << "of 100";
}

TEST_F(SwitchedFaults, ALateClockStampsTooEarly) {
  run(80);
  faults_.set(kLateClock);
  run(80);
  EXPECT_NEAR(age(), 7.0 + 1e3 * Faults::kLate, 1e-6) << "once, not at each tick";
}

TEST_F(SwitchedFaults, ASaturatedSensorSaysSo) {
  faults_.set(kSaturated);
  tick();
  EXPECT_EQ(in_.wrench.value.force.xyz, (std::array{0.5, -Faults::kRange, Faults::kRange}));
  EXPECT_EQ(in_.wrench.health, Health::saturated);
  faults_.set(0);
  tick();
  EXPECT_EQ(in_.wrench.health, Health::ok);
}

// The part of a record that holds a steered hand.

HandWord to(double x, double y, double z) { return {Point<'W'>(x, y, z)}; }

TEST(SteeringLog, ComesBackToTheBit) {
  SteeringLog log;
  log.add(0, to(0.1, -1.0 / 3.0, 1e-17));
  log.add(17, to(0, 0, 0));
  log.add(17, to(1, 2, 3));
  log.add(19, {{}, true, 5});
  SteeringLog back = SteeringLog::read(log.text(), "a.encrec");
  EXPECT_EQ(back.text(), log.text());
  EXPECT_EQ(back.at(0)->place->xyz, (std::array{0.1, -1.0 / 3.0, 1e-17}));
  EXPECT_FALSE(back.at(1));
  EXPECT_FALSE(back.at(16));
  EXPECT_EQ(back.at(18)->place->xyz, (std::array{1.0, 2.0, 3.0})) << "the last of what is due";
  const HandWord last = *back.at(21);
  EXPECT_FALSE(last.place);
  EXPECT_TRUE(last.changes_tool);
  EXPECT_EQ(last.faults, 5);
  EXPECT_FALSE(back.at(22));
}

std::string refusal(const std::string& rows) {
  return test::refusal(
      [&] { (void)SteeringLog::read("tick,steered,x_m,y_m,z_m,changes_tool,faults\n" + rows, "a.encrec"); });
}

TEST(SteeringLog, WhatIsWrongIsSaidWithItsLine) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal("3,1,0,0,0,0,0\n"), "");
  EXPECT_THAT(refusal("3,1,0,0,0,0,0\n2,1,0,0,0,0,0\n"), HasSubstr(":3:1: a tick is not below"));
  EXPECT_THAT(refusal("-1,1,0,0,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("0.5,1,0,0,0,0,0\n"), HasSubstr(":2:1: a tick is a whole number"));
  EXPECT_THAT(refusal("1e300,1,0,0,0,0,0\n"), HasSubstr(":2:1:"));
  EXPECT_THAT(refusal("1,2,0,0,0,0,0\n"), HasSubstr("steered is 0 or 1"));
  EXPECT_THAT(refusal("1,1,0,0,11,0,0\n"), HasSubstr("within 10 m"));
  EXPECT_THAT(refusal("1,1,0,nan,0,0,0\n"), HasSubstr(":2:7:"));
  EXPECT_THAT(refusal("1,1,0,0,0,7,0\n"), HasSubstr("changes_tool is 0 or 1"));
  EXPECT_THAT(refusal("1,1,0,0,0,0,16\n"), HasSubstr("from 0 to 15"));
  EXPECT_THAT(refusal("1,1,0,0\n"), HasSubstr(":2:"));
}

// A steered hand puts its tool on the tray, takes the second one, and returns.

class SteeredToolChange : public testing::Test {
 protected:
  // Runs the scene; `change` at these ticks. Gives the held tool at the end of each second.
  std::vector<std::int32_t> held(const std::string& scene, double seconds,
                                 const std::vector<std::int64_t>& at) {
    TrialOptions options{.seconds = seconds};
    options.steer = [&](std::int64_t tick) -> std::optional<HandWord> {
      if (tick == 0) return HandWord{Point<'W'>(0, 0, 0.06)};
      if (std::find(at.begin(), at.end(), tick) == at.end()) return {};
      return HandWord{{}, true};
    };
    Trial trial(test::shipped(scene), options);
    std::vector<std::int32_t> tools;
    while (trial.tick()) {
      if (trial.result().ticks % 1000 == 0) tools.push_back(trial.truth().tool);
      farthest_ = std::max(farthest_, trial.truth().hand_force.norm());
      tip_ = trial.truth().tool_tip;
    }
    return tools;
  }
  double farthest_ = 0.0;  // N, most force of the hand
  Point<'W'> tip_;
};

TEST_F(SteeredToolChange, GoesToTheOtherToolAndBack) {
  const auto tools = held("session", 9, {1000, 5000});
  ASSERT_GE(tools.size(), 9U);
  EXPECT_EQ(tools[0], 0);
  EXPECT_EQ(tools[3], 1) << "after three seconds";
  EXPECT_EQ(tools[7], 0);
  EXPECT_NEAR((tip_ - Point<'W'>(0, 0, 0.06)).norm(), 0.0, 0.002) << "back where it was told to be";
  EXPECT_LT(farthest_, 15.0) << "nothing jerks";
}

TEST_F(SteeredToolChange, NothingHappensWithOneTool) {
  for (const std::int32_t tool : held("tennis_ball", 3, {1000})) EXPECT_EQ(tool, 0);
}

}  // namespace
}  // namespace enc::trial
