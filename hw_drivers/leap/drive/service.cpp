#include "hw_drivers/leap/drive/service.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"

namespace enc::leap {
namespace {

constexpr std::uint32_t kTurn = 20;  // ms, longest wait for a message
constexpr std::uint32_t kMostHands = 16;
constexpr std::chrono::milliseconds kAgain{20};  // after a call that failed

}  // namespace

Service::Service(const leapc::Functions& leap, const LeapSettings& settings)
    : leap_(leap),
      side_(settings.side == "left" ? leapc::kLeft : leapc::kRight),
      mode_(settings.mode_number()) {
  leapc::ConnectionConfig config;
  config.server = settings.server.empty() ? nullptr : settings.server.c_str();
  leapc::Result result = leap_.create(&config, &connection_);
  if (result == leapc::kSuccess) {
    result = leap_.open(connection_);
    if (result != leapc::kSuccess) leap_.destroy(connection_);
  }
  if (result != leapc::kSuccess)
    throw Error(fmt::format("LeapC gives no connection: {}; see driver.leap.server", leapc::words_of(result)),
                {}, ErrorKind::device);
  thread_ = std::thread([this] { run(); });
}

bool Service::shut() noexcept {
  constexpr Duration kPatience{300'000'000};
  end_ = true;
  for (const Duration until = net::steady_now() + kPatience; !ended_ && net::steady_now() < until;)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (!ended_) return false;
  thread_.join();
  leap_.close(connection_);
  leap_.destroy(connection_);
  return true;
}

void Service::run() noexcept {
  try {
    while (!end_) {
      leapc::Message message;
      const leapc::Result result = leap_.poll(connection_, kTurn, &message);
      if (result == leapc::kSuccess) take(message);
      if (result == leapc::kSuccess || result == leapc::kTimeout) continue;
      say(leapc::words_of(result));
      std::this_thread::sleep_for(kAgain);
    }
  } catch (...) {
    has_device_ = false;
    try {
      say("the vendor's library threw an exception");
    } catch (...) {  // no memory for these words
    }
  }
  ended_ = true;
}

void Service::take(const leapc::Message& message) {
  switch (message.type) {
    case leapc::kConnection:
      connected_ = true;
      if (const leapc::Result result = leap_.set_mode(connection_, mode_); result != leapc::kSuccess)
        say("it takes no tracking mode: " + leapc::words_of(result));
      return;
    case leapc::kDevice:
      if (message.event != nullptr) meet(static_cast<const leapc::DeviceEvent*>(message.event)->device);
      return;
    case leapc::kTracking:
      if (message.event != nullptr) deliver(*static_cast<const leapc::TrackingEvent*>(message.event));
      return;
    case leapc::kConnectionLost:
      connected_ = false;
      [[fallthrough]];
    case leapc::kDeviceFailure:
    case leapc::kDeviceLost:
      if (has_device_.exchange(false)) ++lost_;
      say(message.type == leapc::kConnectionLost ? "the tracking service is gone"
          : message.type == leapc::kDeviceLost   ? "the device is unplugged"
                                                 : "the device has failed");
      return;
    default:
      return;
  }
}

void Service::meet(const leapc::DeviceReference& device) {
  std::array<char, 128> serial{};
  leapc::Device open = nullptr;
  if (leap_.open_device(device, &open) == leapc::kSuccess) {
    leapc::DeviceInfo info;
    info.serial = serial.data();
    info.serial_length = serial.size() - 1;
    static_cast<void>(leap_.device_info(open, &info));
    leap_.close_device(open);
  }
  {
    const std::lock_guard lock(words_);
    serial_ = net::printable(serial.data());
  }
  has_device_ = true;
}

void Service::deliver(const leapc::TrackingEvent& event) {
  Frame frame;
  frame.read = leap_.now();
  frame.came = net::steady_now();  // after it: a thread that was interrupted in between seems late, not early
  frame.number = event.info.frame;
  frame.stamp = event.info.timestamp;
  const std::uint32_t count = event.hands == nullptr ? 0 : std::min(event.hands_count, kMostHands);
  for (std::uint32_t i = 0; i < count && !frame.seen; ++i) {
    frame.hand = event.hands[i];
    frame.seen = frame.hand.type == side_;
  }
  has_device_ = true;
  frames_.write(frame);
}

void Service::say(std::string trouble) {
  const std::lock_guard lock(words_);
  trouble_ = std::move(trouble);
}

std::string Service::serial() const {
  const std::lock_guard lock(words_);
  return serial_;
}

std::string Service::trouble() const {
  const std::lock_guard lock(words_);
  return trouble_;
}

}  // namespace enc::leap
