// What the driver takes from a server of tool data.
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include "hw_drivers/igtl/drive/reception.h"
#include "hw_drivers/igtl/wire/stream.h"
#include "hw_drivers/net/big_endian.h"
#include "tests/fuzz/machine/target.h"

namespace enc::fuzz {
namespace {

// Length and checksum of the header, so that the body is read, too.
void mend(std::string& input) {
  constexpr std::size_t kSize = 42, kCrc = 50;
  if (input.size() < igtl::kHeader) return;
  const std::string body = input.substr(igtl::kHeader);
  const std::uint64_t numbers[2] = {body.size(), igtl::crc64(std::as_bytes(std::span(body)))};
  for (std::size_t i = 0; i < 8; ++i) {
    input[kSize + i] = static_cast<char>(numbers[0] >> (56 - 8 * i));
    input[kCrc + i] = static_cast<char>(numbers[1] >> (56 - 8 * i));
  }
}

Target datagram() {
  Target target;
  const auto content = igtl::transform(Pose<'C', 'T'>::shift(0.1, 0.2, 0.9));
  target.seeds = {text_of(igtl::Written("TRANSFORM", "stylusToTracker", 1'500'000'000, 7, content).bytes()),
                  text_of(igtl::Written("STATUS", "Server", 1'500'000'000, 8, igtl::status(1)).bytes())};
  target.tokens = {"TRANSFORM",
                   "STATUS",
                   std::string("\x7f\xc0\x00\x00", 4),
                   std::string("\xff\xff\xff\xff", 4),
                   std::string("\x00\x0c", 2),
                   "stylusToTracker"};
  target.mend = mend;
  target.run = [](const std::string& input) {
    static const std::vector<std::string> kTools{"stylus"};
    igtl::Reception reception({}, kTools, false);
    Stamped<TrackedTool> newest;
    const bool news = reception.take(std::as_bytes(std::span(input)), Time(Duration(1'000'000)), newest);
    expect(!news || newest.value.X_CT.valid(), "what was taken is no pose");
    expect(news == (newest.health == Health::ok), "news that is none");
    return reception.heard();
  };
  return target;
}

// Checksums of one message after the other, as far as their lengths lead.
void mend_stream(std::string& input) {
  constexpr std::size_t kSize = 42, kCrc = 50;
  for (std::size_t at = 1; at + igtl::kHeader <= input.size();) {
    const auto header = std::as_bytes(std::span(input)).subspan(at);
    const auto size = net::take<std::uint64_t>(header, kSize);
    if (size > header.size() - igtl::kHeader) return;
    const std::uint64_t crc = igtl::crc64(header.subspan(igtl::kHeader, static_cast<std::size_t>(size)));
    net::put(std::as_writable_bytes(std::span(input)), at + kCrc, crc);
    at += igtl::kHeader + static_cast<std::size_t>(size);
  }
}

// A stream of messages in pieces, whose length the first byte tells.
Target stream() {
  Target target;
  const Pose<'C', 'T'> X_CT = Pose<'C', 'T'>::shift(0.1, 0.2, 0.9);
  std::vector<std::byte> two;
  for (const char* name : {"hammer", "stylusToTracker"}) {
    const auto one = igtl::element(name, X_CT);
    two.insert(two.end(), one.begin(), one.end());
  }
  const std::string transform =
      text_of(igtl::Written("TRANSFORM", "stylusToTracker", 1'500'000'000, igtl::transform(X_CT)).bytes());
  const std::string tdata = text_of(igtl::Written("TDATA", "Tracker", 1'510'000'000, two).bytes());
  const std::string exact =
      text_of(igtl::Written("TDATA", "Tracker", 1'520'000'000, 9, igtl::element("stylus", X_CT),
                            igtl::kPoseKey, igtl::pose_text(X_CT))
                  .bytes());
  std::array<std::byte, 28> place{};  // 0, 0, 1000 mm, not turned
  net::put(std::span<std::byte>(place), 8, std::bit_cast<std::uint32_t>(1000.0F));
  net::put(std::span<std::byte>(place), 24, std::bit_cast<std::uint32_t>(1.0F));
  const std::string position =
      text_of(igtl::Written("POSITION", "stylusToTracker", 1'530'000'000, place).bytes());
  const std::string three = text_of(
      igtl::Written("POSITION", "stylusToTracker", 1'540'000'000, std::span(place).first(24)).bytes());
  target.seeds = {"\x40" + transform + tdata + exact, "\x07" + position + three,
                  "\xff" + exact + exact + tdata};
  target.tokens = {"TRANSFORM",
                   "TDATA",
                   "POSITION",
                   "IMAGE",
                   "stylus",
                   "TransformStatus",
                   std::string("\x7f\xc0\x00\x00", 4),
                   std::string("\x00\x00\x00\x00\x00\x01\x00\x00", 8),
                   std::string("\xff\xff\xff\xff\xff\xff\xff\xff", 8)};
  target.mend = mend_stream;
  target.run = [](const std::string& input) {
    static const std::vector<std::string> kTools{"stylus"};
    igtl::IgtlSettings settings;
    settings.transport = "tcp";
    igtl::Reception reception(settings, kTools, false);
    igtl::Stream stream;
    Stamped<TrackedTool> newest;
    std::span<const std::byte> bytes = std::as_bytes(std::span(input));
    const std::size_t piece = bytes.empty() ? 1 : std::to_integer<std::size_t>(bytes.front()) + 1;
    for (bytes = bytes.subspan(std::min<std::size_t>(1, bytes.size())); !bytes.empty() && !stream.lost();) {
      const std::span<std::byte> room = stream.room();
      expect(!room.empty(), "no room, and nothing is lost");
      const std::size_t part = std::min({piece, bytes.size(), room.size()});
      std::copy_n(bytes.begin(), part, room.begin());
      stream.came(part);
      bytes = bytes.subspan(part);
      for (auto message = stream.next(); !message.empty(); message = stream.next()) {
        expect(message.size() >= igtl::kHeader, "a message without a header");
        const Time before = newest.t;
        const bool news = reception.take(message, Time(Duration(1'000'000)), newest);
        expect(!news || (newest.value.X_CT.valid() && newest.t >= before),
               "what was taken is no pose, or is older");
      }
    }
    return reception.counts().poses > 0;
  };
  return target;
}

const Offer kDatagram("igtl_datagram", &datagram);
const Offer kStream("igtl_stream", &stream);

}  // namespace
}  // namespace enc::fuzz
