// Connects the run's thread and the window's thread: requests go one way, begin and end both ways. The run
// never waits for a picture.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "app/window/controls.h"
#include "core/base/latest.h"
#include "trial/trial_options.h"

namespace enc::app {

class Link {
 public:
  // ---- window's side
  void wish(const RunRequests& wishes);
  [[nodiscard]] bool take_event();  // true: the awaited change of mode came, and the run is paused
  void end() { ends_ = true; }
  // Blocks until the run is about to begin; false: it ended without beginning.
  [[nodiscard]] bool wait_for_begin();
  void let_go();  // lets the run begin
  void refuse();  // ends the run before its first tick, without a record or a report
  [[nodiscard]] bool ended();
  void closed();  // the window no longer draws the run

  // ---- run's side
  // Blocks until the window is open; false: it could not be opened. `wall`: the run keeps the wall clock.
  [[nodiscard]] bool begin(bool wall);
  void wait_for_close();  // waits until closed()
  void over();            // the last call
  void see(const trial::Glance& glance) {
    if (to_event_ && glance.out.mode != mode_) event_ = true;
    mode_ = glance.out.mode;
  }
  [[nodiscard]] bool ends() const { return ends_; }
  [[nodiscard]] trial::Hand machine() { return machine_.exchange(trial::Hand::none); }
  [[nodiscard]] std::optional<trial::HandWord> hand();  // set if there is news
  // Returns true if the next tick is not due yet, after a short sleep. Always false for a run on the wall
  // clock.
  [[nodiscard]] bool waits(double dt);

 private:
  void set(bool& what, bool value);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool begun_ = false, drawing_ = false, ended_ = false, closed_ = false, over_ = false, refused_ = false;
  bool wall_ = false;             // the run keeps the wall clock
  Point<'W'> told_;               // newest position sent by the window
  LatestValue<Point<'W'>> hand_;  // window to run, as all below except event_
  std::atomic<bool> changes_tool_ = false;
  std::atomic<std::uint8_t> faults_ = 0;
  std::uint8_t told_faults_ = 0;  // run's side
  std::atomic<bool> paused_ = false, to_event_ = false, ends_ = false;
  std::atomic<bool> event_ = false;  // run to window; the run stands still while it is set
  std::atomic<double> speed_ = 1.0;
  std::atomic<int> ticks_ = 0;
  std::atomic<trial::Hand> machine_ = trial::Hand::none;
  Mode mode_ = Mode::away;
  std::chrono::steady_clock::time_point due_{};
};

}  // namespace enc::app
