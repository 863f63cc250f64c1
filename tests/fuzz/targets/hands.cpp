// Hands: lines of a headset in any pieces, and structures of LeapC.
#include <algorithm>
#include <cstring>
#include <string>

#include "hw_drivers/hand/drive/reception.h"
#include "hw_drivers/hand/fake/server.h"
#include "hw_drivers/hand/wire/line.h"
#include "hw_drivers/leap/wire/hand_of.h"
#include "tests/fuzz/machine/fuzzing.h"

namespace enc::fuzz {
namespace {

HandSample any_hand() {
  HandSample hand;
  hand.wrist = Pose<'L', 'K'>::shift(0.1, -0.2, 0.3);
  for (std::size_t i = 0; i < kHandJoints; ++i)
    hand.joints[i] = Point<'L'>(0.01 * static_cast<double>(i), 0.25, 0.3);
  return hand;
}

// The first byte gives the length of the pieces. What is taken is a hand, no older than the one before; what
// is read is written and read again unchanged.
Target lines() {
  Target target;
  const Measurement<HandSample> first{any_hand(), Time(Duration(5'000'000'000)), Health::ok};
  const Measurement<HandSample> second{any_hand(), Time(Duration(5'008'333'333)), Health::ok};
  target.seeds = {"\x40" + hand::lines_of(first, 7, true) + hand::lines_of(second, 8, true),
                  "\x07Right wrist: 1,2,3,0,0,0,1\nHead pose: 0,0,0,0,0,0,1\n",
                  "\x09" + std::string(5000, 'x') + "\n" + hand::lines_of(first, 9, true)};
  target.tokens = {
      "Right wrist",          "Right landmarks",     "Left", " | f=", " | t=", ": ", ", ", "\n", "1e300",
      "-9223372036854775808", "9223372036854775807", "nan",  "1e-400"};
  target.run = [](const std::string& input) {
    hand::Lines lines;
    hand::Reception reception{hand::HandSettings{}};
    Measurement<HandSample> newest;
    const std::size_t piece = input.empty() ? 1 : static_cast<unsigned char>(input.front()) + 1U;
    std::int64_t time = 0;
    for (std::size_t at = 1; at < input.size();) {
      const std::span<std::byte> room = lines.room();
      expect(!room.empty(), "no room");
      const std::size_t part = std::min({piece, input.size() - at, room.size()});
      std::transform(input.begin() + static_cast<std::ptrdiff_t>(at),
                     input.begin() + static_cast<std::ptrdiff_t>(at + part), room.begin(),
                     [](char c) { return static_cast<std::byte>(c); });
      lines.came(part);
      at += part;
      for (auto line = lines.next(); line; line = lines.next()) {
        const Time before = newest.t;
        const bool any = newest.health != Health::absent;
        const bool news = reception.take(*line, Time(Duration(time += 1'000'000)), newest);
        expect(!news || newest.value.wrist.valid(), "what was taken is no hand");
        expect(!news || !any || newest.t >= before, "time goes back");
        for (const Point<'L'>& joint : newest.value.joints)
          expect(!news || joint.finite(), "a joint is no number");
        hand::Packet packet, again;
        if (hand::read(*line, packet) != hand::LineFault::nothing) continue;
        const std::string written = hand::line_of(packet);
        expect(hand::read(written, again) == hand::LineFault::nothing && hand::line_of(again) == written,
               "what is written of it is read as another");
      }
    }
    return reception.counts().hands > 0;
  };
  return target;
}

// Bytes of a library's hand. What is taken is a hand, and the same once it was written.
Target leap_hand() {
  Target target;
  const auto bytes = [](const leap::leapc::Hand& hand) {
    return std::string(reinterpret_cast<const char*>(&hand), sizeof(hand));
  };
  target.seeds = {bytes(leap::said_of(any_hand())), bytes({})};
  target.tokens = {std::string("\0\0\xc0\x7f", 4), std::string("\0\0\x80\x7f", 4), std::string("\1\0\0\0", 4),
                   std::string("\0\0\x80\xbf", 4), std::string("\xff\xff\x7f\x7f", 4)};
  target.run = [](const std::string& input) {
    leap::leapc::Hand said;
    std::memcpy(&said, input.data(), std::min(input.size(), sizeof(said)));
    HandSample hand, again;
    if (!leap::hand_of(said, hand)) return false;
    expect(hand.wrist.valid() && hand.skin >= 0.0, "what was taken is no hand");
    for (const Point<'L'>& joint : hand.joints) expect(joint.finite(), "a joint is no number");
    expect(leap::hand_of(leap::said_of(hand), again), "what is written of it is no hand");
    constexpr double kRounding = 1e-5;  // m, of single precision at 100 m
    for (std::size_t i = 0; i < kHandJoints; ++i)
      expect((again.joints[i] - hand.joints[i]).norm() < kRounding, "a joint moves when it is written");
    return true;
  };
  return target;
}

const Offer kLines("hand_lines", &lines);
const Offer kLeapHand("leap_hand", &leap_hand);

}  // namespace
}  // namespace enc::fuzz
