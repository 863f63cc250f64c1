// Who is at a run: by signals from anywhere, by keys on a terminal of a process of its own; and afterwards
// all is as it was.
#include "app/run/hand.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "app/run/signal_actions.h"
#include "app/run/stop_signals.h"

namespace enc::app {
namespace {

using trial::Hand;

using Handler = void (*)(int);

Handler handler_of(int signal) {
  struct sigaction now {};
  EXPECT_EQ(sigaction(signal, nullptr, &now), 0);
  return now.sa_handler;
}
void nothing_of(int) {}
void something_of(int) {}

TEST(HandAtTheRun, IsToldBySignalsAndAStopComesFirst) {
  const Handler before = std::signal(SIGUSR1, nothing_of);
  std::signal(SIGUSR2, SIG_IGN);
  {
    HandAtTheRun hand;
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
  EXPECT_EQ(HandAtTheRun().next(), Hand::none) << "what came for the one before is not for this one";
  std::signal(SIGUSR1, before);
  std::signal(SIGUSR2, SIG_DFL);
}

TEST(SignalActions, AreTakenAndGivenBackAndWhatIsIgnoredMayStaySo) {
  std::signal(SIGUSR1, nothing_of);
  std::signal(SIGUSR2, SIG_IGN);
  {
    SignalActions actions;
    actions.take(SIGUSR1, something_of);
    actions.take(SIGUSR2, something_of, 0, true);
    EXPECT_EQ(handler_of(SIGUSR1), &something_of);
    EXPECT_EQ(handler_of(SIGUSR2), SIG_IGN);
    actions.take(SIGUSR1, SIG_IGN);  // the last comes back first
    EXPECT_EQ(handler_of(SIGUSR1), SIG_IGN);
  }
  EXPECT_EQ(handler_of(SIGUSR1), &nothing_of);
  EXPECT_EQ(handler_of(SIGUSR2), SIG_IGN);
  std::signal(SIGUSR1, SIG_DFL);
  std::signal(SIGUSR2, SIG_DFL);
}

TEST(StopSignals, AreNotedOnceAndGivenBack) {
  const Handler before = std::signal(SIGTERM, nothing_of);
  {
    const StopSignals signals;
    EXPECT_EQ(StopSignals::caught(), 0);
    raise(SIGTERM);
    EXPECT_EQ(StopSignals::caught(), SIGTERM);
    EXPECT_EQ(handler_of(SIGTERM), SIG_DFL) << "a second one kills";
    EXPECT_EQ(handler_of(SIGPIPE), SIG_IGN);
  }
  EXPECT_EQ(handler_of(SIGTERM), &nothing_of);
  {
    const StopSignals again;
    EXPECT_EQ(StopSignals::caught(), 0);
  }
  std::signal(SIGTERM, before);
}

// ---- keys
// -----------------------------------------------------------------------------------------------------------

constexpr tcflag_t kLines = ICANON | ECHO;  // a terminal waits for the end of a line, and shows what is typed

// In a process whose terminal that is: says each thing that the hand wants, a letter each.
[[noreturn]] void be_at_terminal(const char* name, int says) {
  const auto say = [says](char what) { static_cast<void>(!write(says, &what, 1)); };
  setsid();
  const int terminal = open(name, O_RDWR);
  if (terminal < 0 || ioctl(terminal, TIOCSCTTY, 0) != 0 || dup2(terminal, STDIN_FILENO) < 0) _exit(3);
  {
    HandAtTheRun hand;
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

TEST(HandAtTheRun, IsToldByKeysOfItsTerminalWhichIsAfterwardsAsItWas) {
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

}  // namespace
}  // namespace enc::app
