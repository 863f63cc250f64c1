#include "hw_drivers/leap/drive/leap_tracker.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/arm/library.h"
#include "hw_drivers/leap/wire/hand_of.h"

namespace enc::leap {
namespace {

constexpr std::int64_t kMostClock = std::int64_t{1} << 52;  // us, 140 years
constexpr std::int64_t kOldest = 1'000'000;                 // us: no frame is on its way for so long
constexpr std::uint64_t kRestart = 1000;                    // frames on: the service began anew

// Ends a service. One whose thread hangs in the library is kept for good, because that thread still uses it.
void end(std::unique_ptr<Service> service) {
  static auto* const hanging = new std::vector<std::unique_ptr<Service>>;  // never destroyed
  if (!service->shut()) hanging->push_back(std::move(service));
}

}  // namespace

LeapTracker::LeapTracker(const Offer& offer, const LeapSettings& settings, const leapc::Functions& leap)
    : settings_(settings), service_(std::make_unique<Service>(leap, settings)), arrival_(!offer.waits) {
  try {
    wait_for_device();
  } catch (...) {
    end(std::move(service_));
    throw;
  }
}

LeapTracker::~LeapTracker() { end(std::move(service_)); }

void LeapTracker::wait_for_device() const {
  Frame frame;
  for (const Duration until = net::steady_now() + from_seconds(settings_.timeout);
       net::steady_now() < until;) {
    if (service_->take(frame)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const std::string trouble = service_->trouble();
  throw Error(fmt::format("LeapC: {} within {:.0f} ms{}; see {}",
                          !service_->connected()    ? "no tracking service answers"
                          : !service_->has_device() ? "the tracking service has no device"
                                                    : "the device sends no frame",
                          1e3 * settings_.timeout, trouble.empty() ? "" : " (" + trouble + ")",
                          service_->connected() ? "the device's cable, and the vendor's control panel"
                                                : "that the service ultraleap-hand-tracking-service runs"),
              {}, ErrorKind::device);
}

std::string LeapTracker::describe() const {
  return fmt::format("{} hand of Leap device '{}', answered", settings_.side, service_->serial());
}

bool LeapTracker::is_fake() const { return service_->serial() == kFakeName; }

bool LeapTracker::poll(Time now, Measurement<HandSample>& newest) noexcept {
  arrival_.begin(now, net::steady_now());
  const bool came = service_->take(frame_);
  if (!polled_) heard_ = now;
  const bool before_the_run = !std::exchange(polled_, true);
  const bool news = came && !before_the_run;
  if (news) heard_ = now;
  const bool silent = age(now, heard_) > settings_.silent;
  const bool linked = !silent && service_->has_device();
  counts_.silent += linked_ && !linked ? 1 : 0;
  linked_ = linked;
  return news && evaluate(frame_, now, newest);
}

bool LeapTracker::evaluate(const Frame& frame, Time now, Measurement<HandSample>& newest) noexcept {
  ++counts_.frames;
  // The numbers may be anything, and their difference wraps.
  const std::uint64_t on = static_cast<std::uint64_t>(frame.number) - static_cast<std::uint64_t>(number_);
  if (any_ && on > 1 && on < kRestart) counts_.missing += static_cast<std::int64_t>(on - 1);
  any_ = true;
  number_ = frame.number;
  Time exposed;
  HandSample hand;
  if (!place_in_time(frame, now, exposed) || (frame.seen && !hand_of(frame.hand, hand))) {
    ++counts_.wrong;
    return false;
  }
  if (!frame.seen) return false;
  ++counts_.hands;
  stamp_ = counts_.hands == 1 ? exposed : std::max(stamp_, exposed);
  newest = {hand, std::min(stamp_, now), Health::ok};
  return true;
}

// The library's clock was read at the frame's arrival, so a frame's age needs no relation of two clocks. The
// relation smooths the moments at which the thread was interrupted between the two readings.
bool LeapTracker::place_in_time(const Frame& frame, Time now, Time& exposed) noexcept {
  const auto counts = [](std::int64_t us) { return -kMostClock < us && us < kMostClock; };
  if (!counts(frame.read) || !counts(frame.stamp)) return false;
  const std::int64_t old = frame.read - frame.stamp;
  if (counts_.frames > 1 && frame.read < read_) {
    ++counts_.steps;
    tie_.forget();
  }
  read_ = frame.read;
  const Time read = tie_.here(1000 * frame.read, arrival_.of(now, frame.came));
  exposed = read - Duration(1000 * old);
  return old >= 0 && old <= kOldest;
}

std::vector<std::string> LeapTracker::remarks() const {
  std::string text = fmt::format("{}: {} frames, {} with the hand, {} missing, {} wrong", describe(),
                                 counts_.frames, counts_.hands, counts_.missing, counts_.wrong);
  const auto add = [&text](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format("; {} {} times", what, count);
  };
  add(service_->lost(), "device lost");
  add(counts_.silent, "link lost");
  add(counts_.steps, "its clock was set back");
  if (const std::string clock = net::words(tie_.estimate()); !clock.empty()) text += "; " + clock;
  if (const std::string trouble = service_->trouble(); !trouble.empty()) text += "; last: " + trouble;
  return {text};
}

std::unique_ptr<HandTracker> opened(const Offer& offer) {
  LeapSettings settings;
  settings.declare(offer.table);
  const arm::Library library(
      {{"libLeapC.so", "libLeapC.so.5", "/usr/lib/ultraleap-hand-tracking-service/libLeapC.so",
        "/usr/lib/ultraleap-hand-tracking-service/libLeapC.so.5"},
       settings.library,
       "driver.leap.library",
       "the hand tracking software 5 of Ultraleap"});
  return std::make_unique<LeapTracker>(offer, settings, leapc::Functions(library));
}

}  // namespace enc::leap
