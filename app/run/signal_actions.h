// What signals do for as long as this lives; then each does what it did before.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>

namespace enc::app {

class SignalActions {
 public:
  SignalActions() = default;
  ~SignalActions() {
    for (; count_ > 0; --count_) sigaction(taken_[count_ - 1].signal, &taken_[count_ - 1].before, nullptr);
  }
  SignalActions(const SignalActions&) = delete;
  SignalActions& operator=(const SignalActions&) = delete;

  // At most kMost of them; one that was ignored stays so where `spared`. flags: as of sigaction().
  void take(int signal, void (*handler)(int), int flags = 0, bool spared = false) noexcept {
    Taken& one = taken_[count_];
    one.signal = signal;
    if (sigaction(signal, nullptr, &one.before) != 0 || (spared && one.before.sa_handler == SIG_IGN)) return;
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = flags;
    if (sigaction(signal, &action, nullptr) == 0) ++count_;
  }

 private:
  static constexpr std::size_t kMost = 4;
  struct Taken {
    int signal = 0;
    struct sigaction before {};
  };
  std::array<Taken, kMost> taken_{};
  std::size_t count_ = 0;
};

}  // namespace enc::app
