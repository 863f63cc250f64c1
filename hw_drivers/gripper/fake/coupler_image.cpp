#include "hw_drivers/gripper/fake/coupler_image.h"

#include <algorithm>
#include <cmath>

#include "core/devices/fake.h"

namespace enc::gripper {
namespace {

constexpr std::uint16_t kOff = 2;  // watchdog type
constexpr std::uint16_t kWritesOnly = 0;

bool writes(const Request& request) { return !request.values.empty(); }
bool is_bits(const Request& request) {
  return request.function == static_cast<std::uint8_t>(Function::read_coils) ||
         request.function == static_cast<std::uint8_t>(Function::read_inputs);
}

}  // namespace

CouplerImage::CouplerImage(Gripper& gripper, const GripperSettings& settings, double force)
    : gripper_(gripper), settings_(settings), force_(force) {
  const auto size = [](std::int64_t one, std::int64_t other) {
    return std::max(kOutputs, static_cast<std::size_t>(std::max(one, other)) + 1);
  };
  outputs_.resize(size(settings.open_output, settings.close_output));
  inputs_.resize(size(settings.open_input, settings.grip_input));
}

bool CouplerImage::can_fail(double code) noexcept {
  constexpr double kMost = 11.0;
  return (code >= 1.0 && code <= kMost) || code == kBusStatus || code == kWriteLock;
}

std::vector<std::byte> CouplerImage::answer(const Request& request, Time now) {
  cycle(now);
  if (failure_ > 0 && failure_ < kIdentity) return refusal(request, static_cast<Exception>(failure_));
  if (request.unit != settings_.unit) return refusal(request, Exception::target);
  if (request.wrong != Exception::none) return refusal(request, request.wrong);
  if (type_ == kAnyTelegram || writes(request)) fed_ = now;
  return writes(request) ? write(request, now) : read(request, now);
}

void CouplerImage::cycle(Time now) noexcept {
  if (now < last_) {  // the world was restarted, and the coupler with it
    outputs_.assign(outputs_.size(), false);
    armed_ = fallen_ = false;
    fed_ = now;
  }
  last_ = now;
  const Duration longest = time_ * Duration(1'000'000);
  if (armed_ && !fallen_ && type_ != kOff && now - fed_ > longest) {
    fallen_ = true;
    ++fallbacks_;
    if (fallback_type_ == kAllOff) outputs_.assign(outputs_.size(), false);
    act();
  }
  sense(now);
}

void CouplerImage::sense(Time now) noexcept {
  if (failure_ == kBusStatus) return;
  const GripSample jaws = gripper_.read(now).value;
  inputs_[static_cast<std::size_t>(settings_.open_input)] = jaws.phase == GripPhase::open;
  inputs_[static_cast<std::size_t>(settings_.grip_input)] = jaws.phase == GripPhase::closed && jaws.holding;
}

void CouplerImage::act() noexcept {
  if (failure_ == kBusStatus) return;
  const bool opens = outputs_[static_cast<std::size_t>(settings_.open_output)];
  const bool closes = outputs_[static_cast<std::size_t>(settings_.close_output)];
  if (opens == closes) return gripper_.stop();
  gripper_.command(closes ? Grip{true, force_} : Grip{});
}

std::optional<std::uint16_t> CouplerImage::value_of(int address, Time now) const noexcept {
  const auto image = [](const std::vector<bool>& bits, int word) {
    std::uint16_t value = 0;
    for (std::size_t i = 0; i < 16; ++i) {
      const std::size_t at = 16 * static_cast<std::size_t>(word) + i;
      if (at < bits.size() && bits[at]) value = static_cast<std::uint16_t>(value | 1U << i);
    }
    return value;
  };
  const auto words = [](const std::vector<bool>& bits) { return static_cast<int>((bits.size() + 15) / 16); };
  if (address >= kInputImage && address < kInputImage + words(inputs_)) return image(inputs_, address);
  if (address >= kOutputImage && address < kOutputImage + words(outputs_))
    return image(outputs_, address - kOutputImage);
  if (address >= kIdentity && address < kIdentity + static_cast<int>(kIdentityWords))
    return identity_words(kFakeName)[static_cast<std::size_t>(address - kIdentity)];
  switch (address) {
    case kOutputBits:
      return static_cast<std::uint16_t>(outputs_.size());
    case kInputBits:
      return static_cast<std::uint16_t>(inputs_.size());
    case kWatchdogLeft: {
      const double left = time_ - 1e3 * seconds(now - fed_);
      return static_cast<std::uint16_t>(std::clamp(left, 0.0, static_cast<double>(time_)));
    }
    case kFallback:
      return static_cast<std::uint16_t>(fallen_ ? 1 : 0);
    case kBusStatus:
      return static_cast<std::uint16_t>(failure_ == kBusStatus ? 0 : 1);
    case kWatchdogTime:
      return time_;
    case kWatchdogType:
      return type_;
    case kFallbackType:
      return fallback_type_;
    case kWriteLock:
      return static_cast<std::uint16_t>(failure_ == kWriteLock ? 1 : 0);
    default:
      return {};
  }
}

std::vector<std::byte> CouplerImage::read(const Request& request, Time now) {
  std::vector<std::uint16_t> values;
  const bool inputs = request.function == static_cast<std::uint8_t>(Function::read_inputs);
  const std::vector<bool>& bits = inputs ? inputs_ : outputs_;
  for (int i = request.address; i < request.address + request.count; ++i) {
    if (is_bits(request)) {
      if (static_cast<std::size_t>(i) >= bits.size()) return refusal(request, Exception::address);
      values.push_back(bits[static_cast<std::size_t>(i)] ? 1 : 0);
      continue;
    }
    const auto value = value_of(i, now);
    if (!value) return refusal(request, Exception::address);
    values.push_back(*value);
  }
  return gripper::answer(request, values);
}

std::vector<std::byte> CouplerImage::write(const Request& request, Time now) {
  if (failure_ == kWriteLock) return refusal(request, Exception::device);
  const bool coils = request.function == static_cast<std::uint8_t>(Function::write_coil) ||
                     request.function == static_cast<std::uint8_t>(Function::write_coils);
  const std::vector<bool> before = outputs_;
  for (std::size_t i = 0; i < request.values.size(); ++i) {
    const int at = request.address + static_cast<int>(i);
    const Exception wrong =
        coils ? write_output(at, request.values[i] != 0) : write_register(at, request.values[i]);
    if (wrong != Exception::none) return refusal(request, wrong);
  }
  if (before != outputs_) {
    ++switched_;
    act();
  }
  sense(now);
  return gripper::answer(request, {});
}

// A watchdog that ran out lets no output pass until it is reset.
Exception CouplerImage::write_output(int at, bool on) noexcept {
  if (at < 0 || static_cast<std::size_t>(at) >= outputs_.size()) return Exception::address;
  if (fallen_) return Exception::device;
  outputs_[static_cast<std::size_t>(at)] = on;
  armed_ = true;
  return Exception::none;
}

Exception CouplerImage::write_register(int at, std::uint16_t value) noexcept {
  if (at == kWatchdogReset) {
    const bool whole = reset_ == kResetFirst && value == kResetSecond;
    reset_ = value;
    if (whole) fallen_ = armed_ = false;
    return Exception::none;
  }
  if (at == kWatchdogTime) {
    time_ = value;
  } else if (at == kWatchdogType || at == kFallbackType) {
    if (value > kOff) return Exception::value;
    (at == kWatchdogType ? type_ : fallback_type_) = value;
  } else if (at >= kOutputImage && 16 * static_cast<std::size_t>(at - kOutputImage) < outputs_.size()) {
    const auto first = 16 * static_cast<std::size_t>(at - kOutputImage);
    for (std::size_t i = first; i < std::min(first + 16, outputs_.size()); ++i)
      if (const Exception wrong = write_output(static_cast<int>(i), (value >> (i - first) & 1) != 0);
          wrong != Exception::none)
        return wrong;
  } else {
    return Exception::address;
  }
  return Exception::none;
}

}  // namespace enc::gripper
