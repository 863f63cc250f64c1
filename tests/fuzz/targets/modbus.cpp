// Requests of any client to the fake coupler, and replies of any coupler to the driver.
#include <algorithm>
#include <string>
#include <thread>

#include <sys/socket.h>

#include "core/base/error.h"
#include "hw_drivers/gripper/drive/conversation.h"
#include "hw_drivers/gripper/fake/coupler_image.h"
#include "hw_drivers/gripper/wire/requests.h"
#include "hw_drivers/net/socket.h"
#include "tests/fuzz/machine/fuzzing.h"

namespace enc::fuzz {
namespace {

struct AnyJaws final : Gripper {
  Measurement<GripSample> read(Time now) noexcept override { return {{}, now, Health::ok}; }
  void command(const Grip&) noexcept override {}
  void stop() noexcept override {}
};

// Corrects the length of each telegram but the last to the length that its function has.
void mend_telegrams(std::string& input) {
  for (std::size_t at = 0; at + 12 <= input.size(); at += 12) {
    input[at + 2] = input[at + 3] = input[at + 4] = 0;
    input[at + 5] = 6;
  }
}

// Telegrams in pieces of seven bytes. Each request gets one answer with its transaction, and the outputs stay
// in their image.
Target requests() {
  Target target;
  const auto one = [](const char* bytes) { return std::string(bytes, 12); };
  target.seeds = {one("\0\1\0\0\0\6\1\5\0\0\xff\0") + one("\0\2\0\0\0\6\1\2\0\0\0\2") +
                      one("\0\3\0\0\0\6\1\6\x8\0\0\1") + one("\0\4\0\0\0\6\1\3\x10\0\0\7"),
                  std::string("\0\1\0\0\0\x8\1\xf\0\0\0\2\1\2", 14) +
                      std::string("\0\1\0\0\0\x9\1\x10\x11\x20\0\1\2\0\xc8", 15)};
  target.tokens = {std::string("\xff\0", 2),   std::string("\x11\x21", 2), std::string("\xbe\xcf", 2),
                   std::string("\xaf\xfe", 2), std::string("\x8\0", 2),    std::string("\0\6", 2)};
  target.mend = mend_telegrams;
  target.run = [](const std::string& input) {
    AnyJaws jaws;
    gripper::CouplerImage image(jaws, {}, 100.0);
    gripper::Requests requests;
    bool right = false;
    std::int64_t time = 0;
    for (std::size_t at = 0; at < input.size() && !requests.lost();) {
      const std::span<std::byte> room = requests.room();
      expect(!room.empty(), "no room, and nothing is lost");
      const std::size_t part = std::min({std::size_t{7}, input.size() - at, room.size()});
      std::transform(input.begin() + static_cast<std::ptrdiff_t>(at),
                     input.begin() + static_cast<std::ptrdiff_t>(at + part), room.begin(),
                     [](char c) { return static_cast<std::byte>(c); });
      requests.came(part);
      at += part;
      for (auto next = requests.next(); next; next = requests.next()) {
        const auto answer = image.answer(*next, Time(Duration(time += 100'000'000)));
        expect(answer.size() > gripper::kHeader + 1 && answer.size() <= gripper::kMostTelegram,
               "an answer of a wrong size");
        right = right || next->wrong == gripper::Exception::none;
      }
    }
    return right;
  };
  return target;
}

// ---- replies: libmodbus reads them; the driver inspects the coupler, then closes the jaws

// A connection to a coupler of this process, which sends its replies before it is asked.
struct CouplerLine {
  CouplerLine() : coupler(settings_of(listener().port())) {
    while (!peer.is_open()) peer = listener().accept();
  }
  // Otherwise thousands of ports would wait for late packets.
  ~CouplerLine() {
    constexpr linger kAtOnce{1, 0};
    static_cast<void>(setsockopt(peer.descriptor(), SOL_SOCKET, SO_LINGER, &kAtOnce, sizeof kAtOnce));
  }
  CouplerLine(const CouplerLine&) = delete;
  CouplerLine& operator=(const CouplerLine&) = delete;
  static net::Socket& listener() {
    static net::Socket the = net::listen_tcp("127.0.0.1", 0);
    return the;
  }
  static gripper::GripperSettings settings_of(std::uint16_t port) {
    gripper::GripperSettings settings;
    settings.address = "127.0.0.1";
    settings.port = port;
    settings.rest = 0.0;
    return settings;
  }
  // The inspection, and some turns with the command to close; true: the link stays.
  bool talk() {
    const gripper::GripperSettings settings = settings_of(listener().port());
    static_cast<void>(gripper::inspect(coupler, settings));
    gripper::Conversation conversation(coupler, settings);
    conversation.take({1, true, 0, 0});
    bool linked = true;
    Duration now{};
    for (int i = 0; i < 4 && linked; ++i)
      linked = conversation.turn([&now] { return now += Duration(1'000'000); });
    const gripper::Report& report = conversation.report();
    expect(linked == (report.trap != gripper::Trap::lost && report.trap != gripper::Trap::fallback),
           "a lost link goes on");
    expect(!gripper::words_of(report, coupler.why()).empty() == (report.trap != gripper::Trap::none),
           "a fault without words");
    const GripSample& jaws = report.jaws;
    expect(!report.read || (jaws.opening >= 0.0 && jaws.opening <= 0.016 && !(jaws.force < 0.0)),
           "jaws that cannot be");
    return linked;
  }
  gripper::Coupler coupler;
  net::Socket peer;
};

// The fake's replies to a whole conversation.
std::string good_replies() {
  CouplerLine line;
  std::string replies;
  std::thread answers([&] {
    AnyJaws jaws;
    gripper::CouplerImage image(jaws, {}, 100.0);
    gripper::Requests requests;
    while (!line.peer.closed()) {
      line.peer.wait(Duration(10'000'000));
      requests.came(line.peer.receive(requests.room()));
      for (auto next = requests.next(); next; next = requests.next()) {
        const auto answer = image.answer(*next, Time{});
        replies += text_of(answer);
        line.peer.send(answer);
      }
    }
  });
  const bool linked = line.talk();
  shutdown(line.peer.descriptor(), SHUT_RD);
  answers.join();
  expect(linked, "the fake's own replies lose the link");
  return replies;
}

// Corrects transactions and lengths, as far as they lead.
void mend_replies(std::string& input) {
  for (std::size_t at = 0, number = 1; at + 9 <= input.size(); ++number) {
    input[at] = static_cast<char>(number >> 8U);
    input[at + 1] = static_cast<char>(number);
    input[at + 2] = input[at + 3] = input[at + 4] = 0;
    const auto function = static_cast<unsigned char>(input[at + 7]);
    const std::size_t length = function >= 0x80 ? 3
                               : function == 5 || function == 6
                                   ? 6
                                   : 3U + static_cast<unsigned char>(input[at + 8]);
    input[at + 5] = static_cast<char>(length);
    at += 6 + length;
  }
}

Target replies() {
  Target target;
  target.seeds = {good_replies()};
  target.tokens = {std::string("\xff\0", 2),   std::string("\x83\2", 2), std::string("\x81\x0b", 2),
                   std::string("\0\0\0\3", 4), std::string("\1\2", 2),   "EK9000"};
  target.mend = mend_replies;
  target.run = [](const std::string& input) {
    CouplerLine line;
    line.peer.send(std::as_bytes(std::span(input)));
    shutdown(line.peer.descriptor(), SHUT_WR);
    return line.talk();
  };
  return target;
}

const Offer kRequests("modbus_requests", &requests);
const Offer kReplies("modbus_replies", &replies);

}  // namespace
}  // namespace enc::fuzz
