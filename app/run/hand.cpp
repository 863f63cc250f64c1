#include "app/run/hand.h"

#include <array>
#include <csignal>
#include <utility>

#include <termios.h>
#include <unistd.h>

#include "app/process.h"

namespace enc::app {
namespace {

volatile std::sig_atomic_t halts = 0, resumes = 0;

extern "C" void note_hand(int number) { (number == SIGUSR1 ? halts : resumes) = 1; }

}  // namespace

struct HandAtTheRun::Terminal {
  termios settings{};
};

HandAtTheRun::HandAtTheRun() {
  halts = 0;
  resumes = 0;
  for (const int signal : {SIGUSR1, SIGUSR2}) actions_.take(signal, note_hand);
  auto terminal = std::make_unique<Terminal>();
  if (!reads_terminal() || tcgetattr(STDIN_FILENO, &terminal->settings) != 0) return;
  termios keys = terminal->settings;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C stays a signal
  keys.c_cc[VMIN] = keys.c_cc[VTIME] = 0;                 // nobody waits for a key
  if (tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0) before_ = std::move(terminal);
}

HandAtTheRun::~HandAtTheRun() {
  if (before_) tcsetattr(STDIN_FILENO, TCSANOW, &before_->settings);
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
