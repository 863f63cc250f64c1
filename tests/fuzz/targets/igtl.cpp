// What the driver takes from a server of tool data.
#include "hw_drivers/igtl/drive/reception.h"
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

const Offer kDatagram("igtl_datagram", &datagram);

}  // namespace
}  // namespace enc::fuzz
