// The person at a run: signals from anywhere, keys on the terminal of a process of its own; and afterwards
// the terminal and the signals are as they were.
#include "trial/operator/operator.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "app/run/console.h"

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

// A fault of the program itself is still its end.
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

constexpr tcflag_t kLines = ICANON | ECHO;  // a terminal waits for the end of a line, and shows what is typed

// In a process whose terminal that is: writes a letter for each thing that the person wants.
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
  press('x');  // is for nobody
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
  see(Mode::hold, kForceLost, 1);  // a reason that goes is no news
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
  RunStatus status;
  status.t = Time(from_seconds(3.214));
  status.mode = Mode::follow;
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

}  // namespace
}  // namespace enc::trial
