#include "trial/operator/operator.h"

#include <array>
#include <csignal>
#include <span>

namespace enc::trial {

int Operator::signal() const noexcept {
  if (const int caught = Signals::caught(); caught != 0) return caught;
  return stops_ && keys_.lost() ? SIGHUP : 0;  // nobody can stop it by hand any more
}

bool Operator::stop() noexcept {
  // A clock that waits for long asks only this; nothing moves before the keys are read.
  const bool at_rest = !stops_ || !listens_;
  if (at_rest && Signals::take_suspension()) suspend();
  return signal() != 0 || quits_;
}

void Operator::suspend() noexcept {
  if (pauses) pauses();
  keys_.release();
  signals_.suspend();
  keys_.take();
  static_cast<void>(Signals::take_continued());
}

Hand Operator::next() noexcept {
  // On the tick before, what moves was stopped.
  if (suspending_) suspend();
  suspending_ = false;
  if (Signals::take_continued()) keys_.renew();
  bool halt = Signals::take_halt(), resume = Signals::take_resume();
  std::array<char, 64> keys{};
  const std::size_t pressed = keys_.read(keys);
  for (const char key : std::span(keys).first(pressed)) {
    halt = halt || key == ' ';
    resume = resume || key == 'r';
    quits_ = quits_ || key == 'q';
  }
  if (stops_ && Signals::take_suspension()) suspending_ = halt = true;
  const Hand hand = halt ? Hand::halt : resume ? Hand::resume : Hand::none;
  if (hand != Hand::none && acts) acts(hand, suspending_);
  return hand;
}

Answer Operator::confirm(const std::string& question) {
  return ask(question, [this] { return stop(); });
}

}  // namespace enc::trial
