#include "trial/trackers/threaded_tracker.h"

#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "trial/time/priority.h"

namespace enc::trial {

ThreadedTracker::ThreadedTracker(std::unique_ptr<PoseTracker> tracker) : tracker_(std::move(tracker)) {
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error& e) {
    throw Error(std::string("the tracker gets no thread: ") + e.what() + "; end some programs", {},
                ErrorKind::device);
  }
}

ThreadedTracker::~ThreadedTracker() {
  stop_ = true;
  ++calls_;
  calls_.notify_one();
  thread_.join();
}

// Nothing throws here: a tracker's poll() is noexcept, and reports failures as Health.
void ThreadedTracker::work() noexcept {
  come_after(2);  // the loop, and the thread that fetches the frames
  Word word;
  Time now;
  while (true) {
    calls_.wait(word.calls);
    word.calls = calls_;  // read before the time, which is then the time of this call or newer
    if (stop_) return;
    if (!now_.read(now)) continue;
    const std::lock_guard lock(at_work_);
    word.news += tracker_->poll(now, word.tool) ? 1 : 0;
    word.linked = tracker_->linked();
    said_.write(word);
  }
}

bool ThreadedTracker::poll(Time now, Measurement<TrackedTool>& newest) noexcept {
  now_.write(now);
  ++calls_;
  calls_.notify_one();
  said_.read(heard_);
  if (std::exchange(told_, heard_.news) == heard_.news) return false;
  newest = heard_.tool;
  return true;
}

bool ThreadedTracker::linked() const noexcept {
  return heard_.linked && calls_.load(std::memory_order_relaxed) - heard_.calls <= kPatience;
}

std::string ThreadedTracker::describe() const {
  const std::lock_guard lock(at_work_);
  return tracker_->describe() + ", in a thread of its own";
}

std::vector<std::string> ThreadedTracker::remarks() const {
  const std::lock_guard lock(at_work_);
  return tracker_->remarks();
}

}  // namespace enc::trial
