// Requests of any client to the fake coupler. The driver's own end is libmodbus.
#include <algorithm>
#include <string>

#include "hw_drivers/gripper/fake/coupler_image.h"
#include "hw_drivers/gripper/wire/requests.h"
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

const Offer kRequests("modbus_requests", &requests);

}  // namespace
}  // namespace enc::fuzz
