#include "hw_drivers/phantom/drive/hd_device.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/devices/fake.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/phantom/wire/coordinates.h"

namespace enc::phantom {
namespace {

constexpr const char* kProduct = "OpenHaptics 3 and the driver of the device, both of 3D Systems";
constexpr int kOldest = 3;  // OpenHaptics; earlier ones lack parameters that the driver needs

arm::LibraryRequest request(const std::string& chosen) {
  return {{"libHD.so", "libHD.so.3.4", "libHD.so.3.0"}, chosen, "driver.phantom.library", kProduct};
}

// The first number of a version text; -1: it has none.
int first_number(const std::string& text) {
  const std::size_t at = text.find_first_of("0123456789");
  int number = -1;
  if (at != std::string::npos) std::from_chars(text.data() + at, text.data() + text.size(), number);
  return number;
}

std::int64_t window_of(const Offer& offer) {
  const double window = offer.rig.arm.loop.value_or(ArmLoop{}).velocity_window;
  return std::clamp<std::int64_t>(std::llround(window / seconds(offer.period)), 1, 63);
}

}  // namespace

HdDevice::HdDevice(const Offer& offer, const PhantomSettings& settings)
    : settings_(settings),
      arm_(offer.rig.arm.machine),
      window_(window_of(offer)),
      library_(request(settings.library)),
      hd_(library_),
      ability_{offer.rig.arm.machine, kUnset, kUnset} {
  if (arm_.joints() != kMostJoints || settings_.joint_signs.size() != kMostJoints ||
      (!settings_.origin.empty() && settings_.origin.size() != 3))
    throw Error(
        "a PHANToM has three joints; expected as many in [arm.machine], three joint_signs, and "
        "three numbers of origin_mm, or none",
        {}, ErrorKind::device);
  origin_ = arm_.tip(arm_.zero());
  if (!settings_.origin.empty())
    origin_ = Point<'R'>(settings_.origin[0], settings_.origin[1], settings_.origin[2]);
  open();
  try {
    ask();
    check_time(offer.lockstep);
  } catch (...) {
    hd_.disable_device(handle_);
    throw;
  }
}

HdDevice::~HdDevice() {
  switch_off();
  hd_.disable_device(handle_);
}

Error HdDevice::failed(const std::string& what) const {
  const std::string name = settings_.device.empty() ? "the default device" : net::printable(settings_.device);
  return Error(fmt::format("{} of {}: {}", name, library_.file(), what), {}, ErrorKind::device);
}

void HdDevice::open() {
  handle_ = hd_.init_device(settings_.device.empty() ? nullptr : settings_.device.c_str());
  const hd::Enum error = hd_.take_errors();
  if (handle_ != hd::kNoDevice && error == hd::kSuccess) return;
  throw failed(fmt::format(
      "it does not open: {}; see driver.phantom.device, and for a fake start `encounter fake RIG`",
      error == hd::kSuccess ? "no reason given; see cable and power" : hd::words_of(error)));
}

void HdDevice::ask() {
  hd_.make_current(handle_);
  const auto text = [&](hd::Enum of) {
    const char* said = hd_.get_string(of);
    return net::printable(said != nullptr ? said : "");
  };
  vendor_ = text(hd::kVendor);
  model_ = text(hd::kModel);
  serial_ = text(hd::kSerial);
  version_ = text(hd::kVersion);
  driver_version_ = text(hd::kDriverVersion);
  static_cast<void>(hd_.take_errors());  // some devices lack a text
  if (const int major = first_number(version_); major >= 0 && major < kOldest)
    throw failed(fmt::format("it is HD {}; expected {} or newer; install {}", version_, kOldest, kProduct));
  hd_.get_doubles(hd::kNominalMaxForce, &ability_.peak);
  hd_.get_doubles(hd::kContinuousForce, &ability_.continuous);
  if (const hd::Enum error = hd_.take_errors(); error != hd::kSuccess)
    throw failed("it does not report its forces: " + hd::words_of(error));
  std::array<double, hd::kMotors> warmth{};
  hd_.get_doubles(hd::kMotorTemperature, warmth.data());
  has_warmth_ = hd_.take_errors() == hd::kSuccess;  // not every device has a model of its motors
}

void HdDevice::check_time(bool lockstep) const {
  if (serial_.ends_with(kInStep) == lockstep) return;
  throw failed(lockstep ? "its time goes on by itself; leave out --lockstep"
                        : "its time goes on with each force; begin the fake without --lockstep");
}

std::string HdDevice::describe() const {
  return fmt::format("{} {} {}, HD {}, driver {}, calibrated{}", vendor_, model_, serial_, version_,
                     driver_version_.empty() ? "unknown" : driver_version_,
                     has_warmth_ ? "" : ", does not report motor temperatures");
}

void HdDevice::calibrate() {
  hd::Enum state = hd_.check_calibration();
  if (state == hd::kCalibrated) return;
  int style = 0;
  hd_.get_integers(hd::kCalibrationStyle, &style);
  static_cast<void>(hd_.take_errors());
  if (settings_.calibration == "update" && style != 0) {
    const int one = (style & hd::kAutomatic) != 0      ? hd::kAutomatic
                    : (style & hd::kEncoderReset) != 0 ? hd::kEncoderReset
                                                       : style;
    hd_.update_calibration(static_cast<hd::Enum>(one));
    if (hd_.take_errors() == hd::kSuccess) state = hd_.check_calibration();
  }
  if (state == hd::kCalibrated) return;
  const char* const how = (style & hd::kEncoderReset) != 0 ? "hold the arm in its reset position"
                          : (style & hd::kInkwell) != 0    ? "put the stylus into the inkwell"
                                                           : "move the arm through its range";
  throw failed(
      fmt::format("it is not calibrated; {}, and meanwhile run `encounter devices` once with --set "
                  "rig.driver.phantom.calibration=update",
                  how));
}

double HdDevice::apart(const arm::ArmReading& reading) const noexcept {
  return (point_of(reported_mm_, origin_) - reading.sample.tip).norm();
}

void HdDevice::compare(double apart) const {
  if (apart <= settings_.agreement) return;
  throw failed(
      fmt::format("its tip is {:.1f} mm from where [arm.machine] has it at its joints; expected at "
                  "most {:g}; see its calibration, then [arm.machine], joint_signs and origin_mm",
                  apart / kMillimetre, settings_.agreement / kMillimetre));
}

arm::ArmReading HdDevice::read(Duration at, double dt) {
  std::array<double, 3> joints{}, position{}, velocity{};
  std::array<double, hd::kMotors> warmth{};
  int buttons = 0;
  hd_.get_doubles(hd::kJointAngles, joints.data());
  hd_.get_doubles(hd::kPosition, position.data());
  hd_.get_doubles(hd::kVelocity, velocity.data());
  if (has_warmth_) hd_.get_doubles(hd::kMotorTemperature, warmth.data());
  hd_.get_integers(hd::kButtons, &buttons);
  arm::ArmReading reading;
  reading.at = at;
  reading.error = error_;
  for (std::size_t i = 0; i < kMostJoints; ++i)
    reading.sample.joints[i] = settings_.joint_signs[i] * joints[i];
  reading.sample.tip = arm_.tip(reading.sample.joints);
  reading.warmth = *std::max_element(warmth.begin(), warmth.begin() + kMostJoints);
  reading.pressed = settings_.pressed(static_cast<std::uint32_t>(buttons));
  reported_mm_ = Vec3(position[0], position[1], position[2]);
  find_velocities(reading, dt);
  if (settings_.velocity == "device")
    reading.sample.velocity =
        Vec<'R'>(Vec3(kMillimetre * axes_to_ours(Vec3(velocity[0], velocity[1], velocity[2]))));
  return reading;
}

// The joints over the last frames; the rig's velocity_window is the time that the certificate assumes.
void HdDevice::find_velocities(arm::ArmReading& reading, double dt) {
  constexpr auto kRing = static_cast<std::int64_t>(kLongest);
  ArmSample& sample = reading.sample;
  kept_[static_cast<std::size_t>(frames_ % kRing)] = {sample.joints, reading.at};
  const std::int64_t back = std::min(window_, frames_);
  const JointSample& before = kept_[static_cast<std::size_t>((frames_ - back) % kRing)];
  const double time = std::isnan(dt) ? seconds(reading.at - before.at) : static_cast<double>(back) * dt;
  for (std::size_t i = 0; back > 0 && time > 0.0 && i < kMostJoints; ++i)
    sample.joint_velocities[i] = (sample.joints[i] - before.joints[i]) / time;
  ++frames_;
  const PerJoint& v = sample.joint_velocities;
  sample.velocity = Vec<'R'>(Vec3(arm_.jacobian(sample.joints) * Vec3(v[0], v[1], v[2])));
}

void HdDevice::exert(const Vec<'R'>& force) {
  const Vec3 of_hd = axes_to_hd(Vec3(force.e()));
  hd_.set_doubles(hd::kCurrentForce, of_hd.data());
}

void HdDevice::end_frame() {
  hd_.end_frame(handle_);
  error_ = static_cast<int>(hd_.take_errors());
}

arm::ArmReading HdDevice::look(Duration at, double dt) {
  hd_.begin_frame(handle_);
  const arm::ArmReading reading = read(at, dt);
  end_frame();
  return reading;
}

void HdDevice::push(const Vec<'R'>& force) {
  hd_.begin_frame(handle_);
  exert(force);
  end_frame();
}

void HdDevice::switch_on() {
  hd_.make_current(handle_);
  hd_.enable(hd::kForceClamping);
  hd_.enable(hd::kForceRamping);
  static_cast<void>(hd_.take_errors());  // not every device has them
  hd_.enable(hd::kForceOutput);
}

void HdDevice::switch_off() noexcept {
  hd_.make_current(handle_);
  hd_.disable(hd::kForceOutput);
}

}  // namespace enc::phantom
