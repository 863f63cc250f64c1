#include "hw_drivers/phantom/drive/phantom_arm.h"

#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/arm/threaded_arm.h"
#include "hw_drivers/net/clocks.h"

namespace enc::phantom {
namespace {

arm::ServoSettings servo_settings(const Offer& offer, const PhantomSettings& settings,
                                  const ArmAbility& ability) {
  arm::ServoSettings of = settings.servo(offer, ability);
  of.hottest = settings.hottest;
  return of;
}

std::string error_text(int error) { return hd::words_of(static_cast<hd::Enum>(error)); }

}  // namespace

HdLoop::HdLoop(const Offer& offer, const PhantomSettings& settings)
    : device_(offer, settings),
      servo_(
          servo_settings(offer, settings, device_.ability()), offer.log, [this] { device_.switch_off(); },
          error_text) {
  try {
    start(settings);
  } catch (...) {
    static_cast<void>(shut());
    throw;
  }
}

void HdLoop::start(const PhantomSettings& settings) {
  const hd::Functions& hd = device_.hd();
  constexpr unsigned long kRate = 1000;  // Hz; HD's own, and the least for stiff surfaces
  hd.set_rate(kRate);
  static_cast<void>(hd.take_errors());  // some devices have one rate only
  hd.start_scheduler();
  scheduled_ = true;
  if (const hd::Enum error = hd.take_errors(); error != hd::kSuccess)
    throw device_.failed("its scheduler does not start: " + hd::words_of(error));
  device_.calibrate();
  const auto called = [](void* self) { return static_cast<HdLoop*>(self)->frame(); };
  callback_ = hd.schedule(called, this, hd::kFirst);
  if (!servo_.comes(settings.timeout))
    throw device_.failed(
        fmt::format("its scheduler makes no call within {:.0f} ms; see cable and power, and "
                    "that no other program has the device",
                    1e3 * settings.timeout));
  device_.compare(apart_);
}

unsigned HdLoop::frame() noexcept {
  if (end_) return hd::kDone;
  try {
    servo_.switch_motors(device_);
    device_.frame(net::steady_now(), kUnset, [this](const arm::ArmReading& reading) {
      if (frames_++ == 0) apart_ = device_.apart(reading);
      return servo_.turn(reading);
    });
    const auto error = static_cast<hd::Enum>(device_.error());
    if (hd::is_grave(error)) servo_.lose(hd::words_of(error));
    return hd::kContinue;
  } catch (...) {
    servo_.lose("the vendor's library threw an exception");
    done_ = true;
    return hd::kDone;
  }
}

bool HdLoop::shut() noexcept {
  constexpr double kGone = 0.1;  // s
  end_ = true;
  servo_.end();
  device_.switch_off();
  if (!scheduled_) return true;
  if (!done_ && servo_.silence() > kGone) return false;
  const hd::Functions& hd = device_.hd();
  hd.stop_scheduler();
  hd.unschedule(callback_);
  return true;
}

// ---- in lockstep with a fake

LockstepArm::LockstepArm(const Offer& offer, const PhantomSettings& settings)
    : device_(offer, settings), log_(offer.log), period_(seconds(offer.period)) {
  device_.calibrate();
}

Measurement<ArmSample> LockstepArm::read(Time now) noexcept {
  arm::ArmReading reading;
  try {
    if (linked_) reading = device_.look(net::steady_now(), period_);
    if (device_.error() != 0) lose(error_text(device_.error()));
  } catch (...) {
    lose("the vendor's library threw an exception");
  }
  return {reading.sample, now, linked_ && reading.pressed ? health_ : Health::fault};
}

void LockstepArm::command(const Vec<'R'>& force) noexcept {
  health_ = force.finite() ? Health::ok : Health::fault;
  if (!linked_) return;
  try {
    if (!on_) device_.switch_on();
    on_ = true;
    device_.push(force.finite() ? force : Vec<'R'>::zero());
    if (device_.error() != 0) lose(error_text(device_.error()));
  } catch (...) {
    lose("the vendor's library threw an exception");
  }
}

void LockstepArm::stop() noexcept {
  device_.switch_off();
  on_ = false;
}

void LockstepArm::lose(const std::string& why) noexcept {
  if (linked_) log_.say("arm lost: " + why);
  linked_ = false;
}

std::unique_ptr<HapticArm> opened(const Offer& offer) {
  PhantomSettings settings;
  settings.declare(offer.table);
  if (offer.lockstep) {
    settings.velocity = "joints";  // to the bit; the device's own is rounded to its unit
    return std::make_unique<LockstepArm>(offer, settings);
  }
  return std::make_unique<arm::ThreadedArm<HdLoop>>(std::make_unique<HdLoop>(offer, settings));
}

}  // namespace enc::phantom
