#include "hw_drivers/v4l2/drive/live_camera.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/net/thread_priority.h"

namespace enc::v4l2 {
namespace {

constexpr Duration kTurn{50'000'000};             // longest wait for frames
constexpr std::chrono::milliseconds kAgain{250};  // between two attempts to open an unplugged camera

}  // namespace

LiveCamera::LiveCamera(const Offer& offer, const V4l2Settings& settings, std::unique_ptr<System> system)
    : system_(std::move(system)),
      settings_(settings),
      log_(offer.log),
      size_(offer.rig.camera.size()),
      rate_(offer.rig.camera.rate),
      capture_(*system_, settings_, size_, rate_),
      arrival_(!offer.waits) {
  first_pair();
  words_ = capture_.describe();
  counts_ = capture_.counts();
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error& e) {
    throw Error(
        fmt::format("{}: gets no thread: {}; expected one; end some programs", settings_.left, e.what()), {},
        ErrorKind::device);
  }
}

LiveCamera::~LiveCamera() {
  {
    const std::lock_guard lock(stops_);
    stop_ = true;
  }
  stopped_.notify_one();
  thread_.join();
}

void LiveCamera::first_pair() {
  for (const Duration until = system_->now() + from_seconds(settings_.timeout); system_->now() < until;) {
    if (capture_.turn(std::min(kTurn, until - system_->now()), pictures_.back())) {
      pictures_.write();
      return;
    }
    if (!capture_.there()) break;
  }
  const CaptureCounts& counts = capture_.counts();
  const char* why = !capture_.there()     ? "went away while it was started"
                    : counts.damaged > 0  ? "sent only damaged frames"
                    : counts.unpaired > 0 ? "and the right camera never had frames near enough to each other"
                                          : "sent no frame";
  throw Error(fmt::format("{}: {} within {:.0f} ms; expected {:.4g} a second; see to cable, trigger and "
                          "exposure time (v4l2-ctl -d {} --stream-mmap)",
                          settings_.left, why, 1e3 * settings_.timeout, rate_, settings_.left),
              {}, ErrorKind::device);
}

void LiveCamera::become(State state) {
  if (state_.exchange(state) == state) return;
  switch (state) {
    case State::gone:
      return log_.say(
          fmt::format("v4l2 {}: unplugged after {} pairs; it is opened again as soon as it is back",
                      settings_.left, capture_.counts().pairs));
    case State::silent:
      return log_.say(fmt::format("v4l2 {}: silent for {:.0f} ms after {} pairs", settings_.left,
                                  1e3 * settings_.silent, capture_.counts().pairs));
    case State::live:
      return log_.say(fmt::format("v4l2 {}: sends frames again", settings_.left));
  }
}

void LiveCamera::turn() {
  const bool news = capture_.turn(kTurn, pictures_.back());
  if (news && pictures_.write()) ++unread_;
  {
    const std::lock_guard lock(counts_change_);
    counts_ = capture_.counts();
    counts_.replaced += unread_;
  }
  if (news)
    become(State::live);
  else if (!capture_.there())
    become(State::gone);
  else if (capture_.silence() > settings_.silent)
    become(State::silent);
}

// A camera that is plugged in again may need some time until it can be opened.
void LiveCamera::come_back() {
  try {
    capture_.reopen();
  } catch (const Error&) {
    std::unique_lock lock(stops_);
    stopped_.wait_for(lock, kAgain, [this] { return stop_.load(); });
  }
}

void LiveCamera::work() noexcept {
  net::shift_priority(-1);  // after the loop
  while (!stop_) capture_.there() ? turn() : come_back();
}

bool LiveCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  arrival_.begin(now, system_->now());
  if (!std::exchange(polled_, true)) begun_ = now;
  const State state = state_;
  bool newer = pictures_.read();
  if (newer) {
    exposed_ = std::min(arrival_.of(now, pictures_.front().exposed), now);
    newer = exposed_ >= begun_;  // else from before the run
    any_ = any_ || newer;
  }
  const bool lost = state != State::live && state != told_ && any_;
  if (!newer && !lost) {
    if (state == State::live) told_ = state;
    return false;
  }
  const Health health = newer ? Health::ok : state == State::gone ? Health::fault : Health::stale;
  told_ = newer ? State::live : state;
  newest = {{pictures_.front().left.view(), pictures_.front().right.view()}, exposed_, health};
  return true;
}

std::vector<std::string> LiveCamera::remarks() const {
  CaptureCounts counts;
  {
    const std::lock_guard lock(counts_change_);
    counts = counts_;
  }
  return {capture_.remark(counts)};
}

}  // namespace enc::v4l2
