#include "hw_drivers/images/play/image_camera.h"

#include <exception>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::images {

using Clock = std::chrono::steady_clock;

Playback::Playback(std::unique_ptr<FrameSource> source, double rate, Say say, bool waits)
    : source_(std::move(source)),
      words_(source_->words()),
      say_(std::move(say)),
      waits_(waits),
      frames_{rate} {
  if (!source_->next(slots_[0])) throw Error(words_ + ": has no frame; expected at least one");
  read_ = 1;
  reader_ = std::thread([this] { read_ahead(); });
  teller_ = std::thread([this] { tell(); });
}

Playback::~Playback() {
  stop_ = true;
  source_->stop();
  wake();
  reader_.join();
  teller_.join();
}

void Playback::wake() noexcept {
  ++calls_;
  calls_.notify_all();
}

// Reads frames ahead. A slot is free once its frame is no longer in use.
void Playback::read_ahead() {
  while (!over_) {
    const int calls = calls_;  // read first, so that a later call is not missed
    if (stop_) return;
    const int frame = read_;
    if (frame - taken_ == kSlots)
      calls_.wait(calls);
    else if (!read(frame))
      over_ = true;
  }
}

bool Playback::read(std::int64_t frame) {
  try {
    if (!source_->next(slots_[slot(frame)])) return false;
  } catch (const std::exception& e) {
    if (!stop_) error_ = e.what();
    return false;
  }
  read_.store(static_cast<int>(frame) + 1, std::memory_order_release);
  return true;
}

// Reports each event once. The end is reported only when playback reaches it, because frames are read before
// they are due.
void Playback::tell() {
  bool late_told = false;
  for (State told = State::playing;;) {
    const int calls = calls_;
    const State is = state_;
    if (const int late = late_; late >= 0 && !std::exchange(late_told, true))
      say_(fmt::format("{}: frame {} came late: this run cannot be repeated to the bit", words_, late));
    if (std::exchange(told, is) != is) {
      if (is == State::stalled) say_(fmt::format("{}: stalled after {} frames", words_, read_.load()));
      if (is == State::ended) say_(fmt::format("{}: ended after {} frames", words_, read_.load()));
      if (is == State::failed) say_(error_);
    }
    if (stop_) return;
    calls_.wait(calls);
  }
}

bool Playback::there() noexcept {
  const auto is = [&] { return frames_.n < read_.load(std::memory_order_acquire); };
  if (!waits_ || late_ >= 0 || is()) return is();
  for (const auto until = Clock::now() + kLongestWait; !is() && !over_ && Clock::now() < until;)
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  return is();
}

bool Playback::take(Time now) noexcept {
  if (!begun_) {
    begun_ = true;
    frames_.phase = now.time_since_epoch();
  }
  constexpr double kPatience = 0.5;  // s, plus some frames
  bool newer = false;
  for (; frames_.next() <= now; ++frames_.n) {
    if (!there()) {
      State is = state_;
      const double overdue = age(now, frames_.next());
      if (over_ && frames_.n >= read_)
        is = error_.empty() ? State::ended : State::failed;
      else if (overdue > kPatience + 3.0 / frames_.hz)
        is = State::stalled;
      const bool first_late = !over_ && late_ < 0;
      if (first_late) late_ = static_cast<int>(frames_.n);
      if (state_.exchange(is) != is || first_late) wake();
      return newer;
    }
    exposed_ = frames_.next();
    taken_ = static_cast<int>(frames_.n);
    newer = true;
    state_ = State::playing;
    wake();
  }
  return newer;
}

// ---- the device

ImageCamera::ImageCamera(const Reel& reel, Log& log, bool waits) {
  try {
    std::unique_ptr<FrameSource> source = open_reel(reel);
    size_ = source->size();
    words_ = fmt::format("images {}: {} x {} px each at {:.4g} Hz", source->words(), size_.width,
                         size_.height, reel.rate);
    playback_ = std::make_unique<Playback>(
        std::move(source), reel.rate, [&log](const std::string& line) { log.say("images " + line); }, waits);
  } catch (const Error& e) {
    throw Error(e.what(), {}, ErrorKind::device);
  }
}

bool ImageCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  using State = Playback::State;
  // The end comes after the last frame, even if both are known at once.
  const bool newer = playback_->take(now);
  const State state = newer ? State::playing : playback_->state();
  if (!newer && state == told_) return false;
  told_ = state;
  const ImagePair& frame = playback_->frame();
  newest = {{frame.left.view(), frame.right.view()},
            playback_->exposed(),
            state == State::playing  ? Health::ok
            : state == State::failed ? Health::fault
                                     : Health::stale};
  return true;
}

}  // namespace enc::images
