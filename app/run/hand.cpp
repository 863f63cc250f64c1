#include "app/run/hand.h"

#include <array>
#include <csignal>
#include <utility>

#include <termios.h>
#include <unistd.h>

#include "app/process.h"

namespace enc::app {
namespace {

constexpr std::array<int, 2> kSignals{SIGUSR1, SIGUSR2};
volatile std::sig_atomic_t halts = 0, resumes = 0;
std::array<struct sigaction, kSignals.size()> before{};

extern "C" void note_hand(int number) { (number == SIGUSR1 ? halts : resumes) = 1; }

}  // namespace

struct HandAtTheRun::Terminal {
  termios settings{};
};

HandAtTheRun::HandAtTheRun() {
  halts = 0;
  resumes = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = note_hand;
    sigaction(kSignals[i], &action, &before[i]);
  }
  auto terminal = std::make_unique<Terminal>();
  if (!reads_terminal() || tcgetattr(STDIN_FILENO, &terminal->settings) != 0) return;
  termios keys = terminal->settings;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C stays a signal
  keys.c_cc[VMIN] = keys.c_cc[VTIME] = 0;                 // nobody waits for a key
  if (tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0) before_ = std::move(terminal);
}

HandAtTheRun::~HandAtTheRun() {
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &before_->settings);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
}

trial::Hand HandAtTheRun::next() noexcept {
  constexpr std::uint32_t kSeldom = 16;  // calls: a key may wait some ms
  if (before_ && ++calls_ % kSeldom == 0) {
    std::array<char, 16> keys{};
    const ssize_t got = read(STDIN_FILENO, keys.data(), keys.size());
    for (ssize_t i = 0; i < got; ++i) {
      const char key = keys[static_cast<std::size_t>(i)];
      if (key == ' ') halts = 1;
      if (key == 'r') resumes = 1;
      if (key == 'q') quits_ = true;
    }
  }
  if (halts != 0) {
    halts = 0;
    resumes = 0;
    return trial::Hand::halt;
  }
  if (resumes == 0) return trial::Hand::none;
  resumes = 0;
  return trial::Hand::resume;
}

}  // namespace enc::app
