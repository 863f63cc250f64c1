#include "app/window/link.h"

#include <algorithm>
#include <thread>

namespace enc::app {

using std::chrono::milliseconds;

void Link::set(bool& what, bool value) {
  const std::lock_guard lock(mutex_);
  what = value;
  changed_.notify_all();
}

void Link::wish(const RunRequests& wishes) {
  if (wishes.hand && wishes.hand->xyz != told_.xyz) {
    told_ = *wishes.hand;
    hand_.write(told_);
  }
  if (wishes.changes_tool) changes_tool_ = true;
  faults_ = wishes.faults;
  paused_ = wishes.paused;
  speed_ = wishes.speed;
  to_event_ = wishes.to_event;
  ticks_ += wishes.ticks;
  if (wishes.ends || wishes.restarts) ends_ = true;
  // A stop takes precedence over a resume, and over an earlier resume that the run has not taken yet.
  trial::Hand none = trial::Hand::none;
  if (wishes.stops)
    machine_ = trial::Hand::halt;
  else if (wishes.resumes)
    machine_.compare_exchange_strong(none, trial::Hand::resume);
}

// The run stands still until here, so an earlier request cannot make it pass the event.
bool Link::take_event() {
  if (!event_) return false;
  paused_ = true;
  to_event_ = false;
  event_ = false;
  return true;
}

bool Link::wait_for_begin() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return begun_ || over_; });
  return begun_;
}

void Link::let_go() { set(drawing_, true); }

void Link::refuse() {
  const std::lock_guard lock(mutex_);
  refused_ = drawing_ = true;
  changed_.notify_all();
}

bool Link::ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void Link::closed() { set(closed_, true); }

bool Link::begin(bool wall) {
  wall_ = wall;
  std::unique_lock lock(mutex_);
  begun_ = true;
  changed_.notify_all();
  changed_.wait(lock, [&] { return drawing_; });
  return !refused_;
}

void Link::wait_for_close() {
  std::unique_lock lock(mutex_);
  ended_ = true;
  changed_.notify_all();
  changed_.wait(lock, [&] { return closed_; });
}

void Link::over() { set(over_, true); }

std::optional<trial::HandWord> Link::hand() {
  trial::HandWord word;
  Point<'W'> place;
  if (hand_.read(place)) word.place = place;
  word.changes_tool = changes_tool_.exchange(false);
  word.faults = faults_;
  if (!word.place && !word.changes_tool && word.faults == told_faults_) return {};
  told_faults_ = word.faults;
  return word;
}

bool Link::waits(double dt) {
  using Clock = std::chrono::steady_clock;
  constexpr milliseconds kNap{2}, kSlice{20};  // while paused, and until the next tick is due
  constexpr milliseconds kLate{50};            // the rest of a longer delay is never made up
  if (wall_) return false;
  const Clock::time_point now = Clock::now();
  if (paused_ || event_) {
    due_ = now;
    if (ticks_ > 0 && !event_) {
      --ticks_;
      return false;
    }
    std::this_thread::sleep_for(kNap);
    return true;
  }
  if (now < due_) {
    std::this_thread::sleep_until(std::min(due_, now + kSlice));
    if (Clock::now() < due_) return true;
  }
  const std::chrono::duration<double> period(dt / speed_);
  due_ = std::max(due_, now - kLate) + std::chrono::duration_cast<Clock::duration>(period);
  return false;
}

}  // namespace enc::app
