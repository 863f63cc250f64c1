#include "hw_drivers/forcedimension/drive/delta_arm.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/arm/threaded_arm.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"

namespace enc::forcedimension {
namespace {

constexpr const char* kProduct = "the SDK 3 of Force Dimension";
constexpr int kOldest = 3;  // of the SDK
constexpr std::chrono::microseconds kPeriod{1000};

arm::LibraryRequest request(const std::string& chosen) {
  return {{"libdhd.so", "libdhd.so.3"}, chosen, "driver.forcedimension.library", kProduct};
}

}  // namespace

DhdDevice::DhdDevice(const Offer& offer, const ForceDimensionSettings& settings)
    : settings_(settings),
      arm_(offer.rig.arm.machine),
      origin_(arm_.tip(arm_.zero())),
      library_(request(settings.library)),
      dhd_(library_),
      ability_{offer.rig.arm.machine, offer.rig.arm.peak, offer.rig.arm.continuous} {
  dhd_.sdk_version(&version_[0], &version_[1], &version_[2], &version_[3]);
  if (version_[0] < kOldest)
    throw failed(fmt::format("it is DHD {}.{}; expected {} or newer; install {}", version_[0], version_[1],
                             kOldest, kProduct));
  const int id = settings_.serial == 0 ? dhd_.open() : dhd_.open_serial(static_cast<int>(settings_.serial));
  if (id < 0)
    throw failed(
        fmt::format("it does not open: {}; see cable, power and rights (udev), and "
                    "driver.forcedimension.serial",
                    dhd_.error_text()));
  id_ = static_cast<char>(id);
  try {
    inspect();
    set_limits();
  } catch (...) {
    dhd_.close(id_);
    throw;
  }
}

DhdDevice::~DhdDevice() {
  switch_off();
  dhd_.close(id_);
}

Error DhdDevice::failed(const std::string& what) const {
  const std::string name =
      settings_.serial == 0 ? "the first device" : fmt::format("device {}", settings_.serial);
  return Error(fmt::format("{} of {}: {}", name, library_.file(), what), {}, ErrorKind::device);
}

void DhdDevice::inspect() {
  const char* const name = dhd_.system_name(id_);
  name_ = net::printable(name != nullptr ? name : "");
  std::uint16_t serial = 0;
  if (dhd_.serial_number(&serial, id_) >= 0) serial_ = serial;
  std::array<int, dhd::kStatuses> status{};
  if (dhd_.status(status.data(), id_) < 0) throw failed("it does not report its state: " + dhd_.error_text());
  if (status[dhd::kPower] == 0) throw failed("it has no power; switch it on");
  if (status[dhd::kReset] != 0)
    throw failed("it is not calibrated; calibrate it with the vendor's tool (HapticInit)");
  if (status[dhd::kError] != 0) throw failed("it reports an error; switch it off and on");
}

// The force's limit and the firmware's watchdog: both work after this program is gone.
void DhdDevice::set_limits() {
  dhd_.stop(id_);
  if (dhd_.set_max_force(ability_.peak, id_) < 0)
    throw failed("it takes no limit of force: " + dhd_.error_text());
  dhd_.enable_expert();
  const auto steps = std::lround(settings_.device_watchdog / dhd::kWatchdogStep);
  const int done = dhd_.set_watchdog(static_cast<unsigned char>(steps), id_);
  dhd_.disable_expert();
  if (done < 0) throw failed("its watchdog cannot be set: " + dhd_.error_text());
}

std::string DhdDevice::describe() const {
  return fmt::format("{}, serial {}, DHD {}.{}.{}, calibrated", name_, serial_, version_[0], version_[1],
                     version_[2]);
}

arm::ArmReading DhdDevice::read() {
  std::array<double, 3> at{}, speed{};
  const bool good = dhd_.position(&at[0], &at[1], &at[2], id_) >= 0 &&
                    dhd_.velocity(&speed[0], &speed[1], &speed[2], id_) >= 0;
  if (!good) error_ = std::max(dhd_.last_error(), 1);
  arm::ArmReading reading;
  reading.at = net::steady_now();
  reading.sample.tip = origin_ + Vec<'R'>(at[0], at[1], at[2]);
  reading.sample.velocity = Vec<'R'>(speed[0], speed[1], speed[2]);
  static_cast<void>(arm_.inverse(reading.sample.tip, joints_));
  reading.sample.joints = joints_;
  const Vec3 rates = arm_.jacobian(joints_).fullPivLu().solve(Vec3(speed[0], speed[1], speed[2]));
  for (std::size_t i = 0; i < arm_.joints(); ++i)
    reading.sample.joint_velocities[i] = rates(static_cast<Eigen::Index>(i));
  reading.pressed = settings_.pressed(dhd_.buttons(id_));
  reading.error = std::exchange(error_, 0);
  return reading;
}

void DhdDevice::exert(const Vec<'R'>& force) {
  if (dhd_.set_force(force.xyz[0], force.xyz[1], force.xyz[2], id_) < 0)
    error_ = std::max(dhd_.last_error(), 1);
}

void DhdDevice::switch_on() {
  if (dhd_.enable_force(1, id_) < 0) error_ = std::max(dhd_.last_error(), 1);
}

void DhdDevice::switch_off() noexcept { dhd_.stop(id_); }

// ---- its thread

DhdLoop::DhdLoop(const Offer& offer, const ForceDimensionSettings& settings)
    : device_(offer, settings),
      servo_(
          settings.servo(offer, device_.ability()), offer.log, [this] { device_.switch_off(); },
          dhd::words_of),
      thread_([this] { run(); }) {
  if (servo_.comes(settings.timeout)) return;
  if (!shut()) thread_.join();  // the vendor's own time limit ends it
  throw device_.failed(
      fmt::format("it gives no position within {:.0f} ms; see cable and power", 1e3 * settings.timeout));
}

void DhdLoop::run() noexcept {
  auto next = std::chrono::steady_clock::now();
  while (!end_) {
    try {
      turn();
    } catch (...) {
      servo_.lose("the vendor's library threw an exception");
      break;
    }
    next = std::max(next + kPeriod, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
  ended_ = true;
}

void DhdLoop::turn() {
  servo_.switch_motors(device_);
  const arm::ArmReading reading = device_.read();
  if (reading.error != 0) servo_.lose(dhd::words_of(reading.error));
  const Vec<'R'> force = servo_.turn(reading);
  if (servo_.motors_on()) device_.exert(force);
}

bool DhdLoop::shut() noexcept {
  constexpr Duration kPatience{300'000'000};
  end_ = true;
  servo_.end();
  for (const Duration until = net::steady_now() + kPatience; !ended_ && net::steady_now() < until;)
    std::this_thread::sleep_for(kPeriod);
  device_.switch_off();
  if (!ended_) return false;
  thread_.join();
  return true;
}

std::unique_ptr<HapticArm> opened(const Offer& offer) {
  ForceDimensionSettings settings;
  settings.declare(offer.table);
  return std::make_unique<arm::ThreadedArm<DhdLoop>>(std::make_unique<DhdLoop>(offer, settings));
}

}  // namespace enc::forcedimension
