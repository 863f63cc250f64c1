// The fake libLeapC.so: functions of LeapC in front of a fake headset of `encounter fake`, whose lines it
// receives at the connection's server, HOST:PORT. Its clock is an hour ahead and fast, so that a driver that
// takes it for another one errs.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/arm/fake/message.h"
#include "hw_drivers/hand/drive/reception.h"
#include "hw_drivers/hand/wire/line.h"
#include "hw_drivers/leap/drive/settings.h"
#include "hw_drivers/leap/wire/hand_of.h"
#include "hw_drivers/leap/wire/leapc.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"

namespace enc::leap {
namespace {

constexpr double kAhead = 3600.0, kFast = 40e-6;  // s, s/s
constexpr float kRate = 120.0F;                   // Hz

// us of the library's clock at a time of the process.
std::int64_t clock_at(Duration steady) {
  return static_cast<std::int64_t>(1e6 * (kAhead + (1.0 + kFast) * seconds(steady)));
}

hand::HandSettings of_side(const char* side) {
  hand::HandSettings settings;
  settings.side = side;
  return settings;
}

struct FakeConnection {
  arm::Place place;
  net::Socket socket;
  hand::Reception left{of_side("left")}, right{of_side("right")};
  int announced = 0;  // number of messages before the first frame, two in all
  Measurement<HandSample> newest;
  leapc::Hand hand;
  leapc::DeviceEvent device{0, {nullptr, 1}, 1};
  leapc::TrackingEvent frame;
};

leapc::Result say(leapc::Message* to, std::uint32_t type, const void* event) {
  *to = {sizeof(leapc::Message), type, event, 1};
  return leapc::kSuccess;
}

bool take(FakeConnection& of, std::string_view lines) {
  bool news = false;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(std::min(line.size() + 1, lines.size()));
    for (hand::Reception* reception : {&of.left, &of.right})
      news = reception->take(line, Time(net::steady_now()), of.newest) || news;
  }
  return news;
}

leapc::Result poll(FakeConnection& of, std::uint32_t timeout_ms, leapc::Message* to) {
  if (!of.socket.is_open()) return leapc::kNotConnected;
  if (of.announced == 0) return ++of.announced, say(to, leapc::kConnection, nullptr);
  if (of.announced == 1) return ++of.announced, say(to, leapc::kDevice, &of.device);
  std::array<std::byte, 2 * hand::kLongestLine> bytes{};
  for (const Duration until = net::steady_now() + Duration(std::int64_t{timeout_ms} * 1'000'000);;) {
    const std::size_t got = of.socket.receive(bytes);
    if (take(of, {reinterpret_cast<const char*>(bytes.data()), got})) break;
    const Duration left = until - net::steady_now();
    if (got == 0 && left <= Duration{}) return leapc::kTimeout;
    if (got == 0) of.socket.wait(left);
  }
  of.hand = said_of(of.newest.value);
  ++of.frame.info.frame;
  of.frame.tracking_frame = of.frame.info.frame;
  of.frame.info.timestamp = clock_at(of.newest.t.time_since_epoch());
  of.frame.hands_count = 1;
  of.frame.hands = &of.hand;
  of.frame.rate = kRate;
  return say(to, leapc::kTracking, &of.frame);
}

leapc::Result describe(leapc::DeviceInfo* to) {
  constexpr std::uint32_t kRoom = kFakeName.size() + 1;
  const std::uint32_t room = std::exchange(to->serial_length, kRoom);
  if (to->serial == nullptr || room < kRoom) return leapc::kInsufficientBuffer;
  to->serial[kFakeName.copy(to->serial, kRoom - 1)] = '\0';
  return leapc::kSuccess;
}

FakeConnection& of(leapc::Connection connection) { return *static_cast<FakeConnection*>(connection); }

}  // namespace
}  // namespace enc::leap

// ---- the functions of libLeapC.so

namespace leapc = enc::leap::leapc;
#define LEAP_API extern "C" __attribute__((visibility("default")))

LEAP_API leapc::Result LeapCreateConnection(const leapc::ConnectionConfig* config, leapc::Connection* to) {
  const std::string server = config != nullptr && config->server != nullptr ? config->server : "";
  auto connection = std::make_unique<enc::leap::FakeConnection>();
  if (!enc::arm::read_place(server.empty() ? enc::leap::kUsualPlace : server, connection->place))
    return leapc::kUnknownError;
  *to = connection.release();
  return leapc::kSuccess;
}
LEAP_API leapc::Result LeapOpenConnection(leapc::Connection connection) {
  enc::leap::FakeConnection& fake = enc::leap::of(connection);
  try {
    fake.socket = enc::net::bind_udp(fake.place.host, fake.place.port);
  } catch (const enc::Error&) {
    return leapc::kUnknownError;
  }
  return leapc::kSuccess;
}
LEAP_API leapc::Result LeapPollConnection(leapc::Connection connection, std::uint32_t timeout_ms,
                                          leapc::Message* to) {
  return enc::leap::poll(enc::leap::of(connection), timeout_ms, to);
}
LEAP_API void LeapCloseConnection(leapc::Connection connection) { enc::leap::of(connection).socket = {}; }
LEAP_API void LeapDestroyConnection(leapc::Connection connection) { delete &enc::leap::of(connection); }
LEAP_API std::int64_t LeapGetNow() { return enc::leap::clock_at(enc::net::steady_now()); }
LEAP_API leapc::Result LeapSetTrackingMode(leapc::Connection, std::uint32_t) { return leapc::kSuccess; }
LEAP_API leapc::Result LeapOpenDevice(leapc::DeviceReference device, leapc::Device* to) {
  *to = device.handle;
  return leapc::kSuccess;
}
LEAP_API leapc::Result LeapGetDeviceInfo(leapc::Device, leapc::DeviceInfo* to) {
  return enc::leap::describe(to);
}
LEAP_API void LeapCloseDevice(leapc::Device) {}
