// Input of drivers from devices, and of fakes from any client: GCS, the Net F/T, tool data.
#include "tests/support/devices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/devices/device.h"
#include "hw_drivers/gcs/drive/conversation.h"
#include "hw_drivers/gcs/fake/commands.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/igtl/drive/reception.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/big_endian.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/netft/drive/session.h"
#include "hw_drivers/netft/fake/server.h"
#include "hw_drivers/netft/wire/messages.h"
#include "hw_drivers/netft/wire/page.h"
#include "tests/fuzz/machine/fuzzing.h"

namespace enc::fuzz {
namespace {

// ---- The two ends of GCS: the controller's input from any client, and the driver's input from a controller.

std::vector<std::string> words() {
  std::vector<std::string> all{" \n", "\n", "\x18", "\x05", " X 1", " X=1", "=", " R 1", "ALL", "e-3"};
  for (const gcs::Commands::Entry& one : gcs::Commands::all()) all.emplace_back(one.word);
  return all;
}

// The machine stays within its reach under any command; answers end with their line.
Target controller() {
  Target target;
  target.seeds = {"*IDN?\nCSV?\nERR?\nFRF?\nSVO?\nSPI?\nTMN?\nTMX?\nVLS?\nPOS?\nERR?\n",
                  "VLS 20\nMOV X 1 Y 2 Z 3 U 1 V 2 W 3\nPOS?\nERR?\n\x18"
                  "ERR?\n",
                  "SVO X 0 Y 1\nFRF X\n\x07MVR Z -0.5\nONT? X\nVMO? X 1.0\nHLP?\nHLT X\nSTP\n",
                  "SPI R 0 S 0 T 12.5\nSAI? ALL\nCST? X\nPUN?\n\x03\x04\x05\x06\x08\x09MOV? X Y\n"};
  target.tokens = words();
  target.run = [](const std::string& input) {
    test::FollowingMachine machine;
    gcs::Controller controller(machine, {});
    controller.cycle(Time{});
    const std::string answers(controller.take(input));
    expect(answers.empty() || answers.back() == '\n', "an answer has no end");
    controller.cycle(Time(Duration(50'000'000)));
    expect(machine.can.contains(machine.pose), "the machine is beyond its reach");
    return true;
  };
  target.bound = {1024, 4U << 20U};  // two letters can request a page of help
  return target;
}

// A conversation that keeps its link has a pose; a garbled one stays lost and sends no more.
Target answers() {
  Target target;
  const std::string zero = "X=0 \nY=0 \nZ=0 \nU=0 \nV=0 \nW=0\n";
  target.seeds = {zero + "0\n", zero + "7\n", "W=30 \nV=-15 \nU=1e-3 \nX=1.25 \nY=0 \nZ=-25\n10\n"};
  target.tokens = words();
  target.run = [](const std::string& input) {
    const gcs::Stand stand{{0, 0, 0.1}, {0, 0, 0}, {0, 0, 0.3}};
    gcs::Conversation talk(gcs::GcsSettings{}, stand, {}, Duration{});
    static_cast<void>(talk.send(Duration{}));
    talk.take(input, Duration(1'000'000));
    const bool linked = talk.loss() == gcs::Loss::none;
    const bool sends = !talk.send(Duration(10'000'000)).empty();
    expect(talk.report().X_RH.valid(), "a position is no pose");
    expect(linked || !sends, "it speaks to a link that is lost");
    return linked && talk.answers() == 1;
  };
  return target;
}

const Offer kController("gcs_controller", &controller);
const Offer kAnswers("gcs_answers", &answers);

// ---- The two ends of a Net F/T: the driver's input from a box, and the fake's input from any client.

std::span<const std::byte> bytes_in(const std::string& input) { return std::as_bytes(std::span(input)); }

// Consecutive records of 36 bytes each: times only grow, forces are numbers.
Target records() {
  Target target;
  const netft::Record first{1, 7, 0, {1500000, -2000000, 12000000, 0, 0, 0}}, second{2, 14, 0x80020000, {}};
  target.seeds = {text_of(netft::bytes_of(first)) + text_of(netft::bytes_of(second)),
                  text_of(netft::bytes_of(first))};
  target.tokens = {std::string("\xff\xff\xff\xff", 4), std::string("\x80\x00\x00\x00", 4),
                   std::string(4, '\0')};
  target.run = [](const std::string& input) {
    netft::Session session(netft::gamma(), Duration{}, false);
    Time last{};
    for (std::size_t at = 0; at < input.size(); at += netft::kRecord) {
      session.take(bytes_in(input).subspan(at, std::min(netft::kRecord, input.size() - at)),
                   Time(Duration(1'000'000 * static_cast<std::int64_t>(at))));
      expect(session.newest().t >= last, "time goes back");
      last = session.newest().t;
      expect(session.newest().health == Health::absent || session.newest().value.force.finite(),
             "a force is no number");
    }
    return session.counts().records > 0;
  };
  return target;
}

Target page() {
  Target target;
  target.seeds = {
      netft::xml_of(netft::gamma()),
      "<netft><prodname>Net F/T</prodname><cfgcpf>1e6</cfgcpf><cfgcpt>1e6</cfgcpt><scfgfu>lbf</scfgfu>"
      "<scfgtu>lbf-in</scfgtu><comrdtrate>7000</comrdtrate></netft>"};
  target.tokens = {"<cfgcpf>", "</cfgcpf>", "<!DOCTYPE a [<!ENTITY b \"c\">]>",
                   "&amp;",    "&#x41;",    "<![CDATA[",
                   "]]>",      "<!--",      "-->",
                   "<?xml ",   "?>",        "scfgfu",
                   "N-mm",     "1e999",     "nan",
                   ";",        "130;130"};
  target.run = [](const std::string& input) {
    netft::Configuration of;
    if (!netft::read_xml(input, of).empty()) return false;
    expect(of.per_newton > 0 && of.per_newton_metre > 0, "counts that are none");
    return true;
  };
  target.bound = {64, 4U << 20U};
  return target;
}

Target http() {
  Target target;
  target.seeds = {
      netft::http_answer(200, "text/xml", "<netft/>"), netft::http_request("[::1]:80", "/netftapi2.xml"),
      "HTTP/1.0 200 OK\r\n\r\n<netft/>", netft::http_answer(404, "text/plain", ""),
      std::string(79'000, '\r')};  // catches a reader that scans the whole text again for each piece
  target.tokens = {"\r\n",
                   "\r\n\r\n",
                   "HTTP/1.1 ",
                   "Content-Length: ",
                   "99999999999999999999",
                   "Transfer-Encoding: chunked"};
  target.run = [](const std::string& input) {
    netft::HttpAnswer answer;
    for (std::size_t at = 0; at < input.size(); at += 3) answer.take(std::string_view(input).substr(at, 3));
    answer.closed();
    expect(answer.complete(), "an answer has no end");
    expect(answer.body().size() <= input.size(), "more came out than in");
    static_cast<void>(netft::requested_path(input));
    return answer.wrong().empty();
  };
  return target;
}

Target box() {
  struct StillSensor final : ForceSensor {
    Measurement<Wrench> read(Time now) noexcept override {
      return {{Vec<'F'>::zero(), Vec<'F'>::zero()}, now, Health::ok};
    }
  };
  Target target;
  target.seeds = {text_of(netft::bytes_of(netft::Request{netft::Command::start, 0})) +
                  text_of(netft::bytes_of(netft::Request{netft::Command::bias, 0}))};
  target.tokens = {std::string("\x12\x34", 2), std::string("\x00\x42", 2),
                   std::string("\xff\xff\xff\xff", 4)};
  target.run = [](const std::string& input) {
    StillSensor still;
    netft::Box box(still, netft::gamma());
    bool known = false;
    std::uint32_t last = 0;
    for (std::size_t at = 0; at < input.size(); at += netft::kRequest) {
      known = box.take(bytes_in(input).subspan(at, std::min(netft::kRequest, input.size() - at))) || known;
      const std::uint32_t sample = box.record(Time(Duration(1'000'000))).sample;
      expect(at == 0 || sample > last, "its counter stands");
      last = sample;
    }
    return known;
  };
  return target;
}

Target command() {
  Target target;
  target.seeds = {text_of(netft::bytes_of(netft::Ask{})),
                  text_of(netft::bytes_of(netft::Ask{.question = netft::Question::calibration})),
                  text_of(netft::bytes_of(netft::Calibration{2, 3, 1000000, 1000000, {}}))};
  target.tokens = {std::string("\x12\x34", 2), std::string("\xff\xff\xff\xff", 4)};
  target.run = [](const std::string& input) {
    netft::Ask ask;
    netft::Reading reading;
    netft::Calibration calibration;
    bool refused = false;
    try {
      netft::agree(bytes_in(input), netft::gamma(), {});
    } catch (const Error&) {
      refused = true;
    }
    const bool known = netft::read(bytes_in(input), ask) || netft::read(bytes_in(input), reading);
    const bool says = netft::read(bytes_in(input), calibration);
    expect(says || refused, "what is no calibration agrees");
    return known || says;
  };
  return target;
}

const Offer kCommand("netft_command", &command);
const Offer kRecords("netft_records", &records);
const Offer kPage("netft_page", &page);
const Offer kHttp("netft_http", &http);
const Offer kBox("netft_box", &box);

// ---- The driver's input from a server of tool data.

// Corrects length and checksum of the header, so that the driver reads the body, too.
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
  target.seeds = {
      text_of(igtl::OutgoingMessage("TRANSFORM", "stylusToTracker", 1'500'000'000, 7, content).bytes()),
      text_of(igtl::OutgoingMessage("STATUS", "Server", 1'500'000'000, 8, igtl::status(1)).bytes())};
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
    Measurement<TrackedTool> newest;
    const bool news = reception.take(std::as_bytes(std::span(input)), Time(Duration(1'000'000)), newest);
    expect(!news || newest.value.X_CT.valid(), "what was taken is no pose");
    expect(news == (newest.health == Health::ok), "news that is none");
    return reception.heard();
  };
  return target;
}

// Corrects the checksums of consecutive messages, as far as their lengths lead.
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

// A stream of messages in pieces; the first byte gives the length of the pieces.
Target stream() {
  Target target;
  const Pose<'C', 'T'> X_CT = Pose<'C', 'T'>::shift(0.1, 0.2, 0.9);
  std::vector<std::byte> two;
  for (const char* name : {"hammer", "stylusToTracker"}) {
    const auto one = igtl::element(name, X_CT);
    two.insert(two.end(), one.begin(), one.end());
  }
  const std::string transform = text_of(
      igtl::OutgoingMessage("TRANSFORM", "stylusToTracker", 1'500'000'000, igtl::transform(X_CT)).bytes());
  const std::string tdata = text_of(igtl::OutgoingMessage("TDATA", "Tracker", 1'510'000'000, two).bytes());
  const std::string exact =
      text_of(igtl::OutgoingMessage("TDATA", "Tracker", 1'520'000'000, 9, igtl::element("stylus", X_CT),
                                    igtl::kPoseKey, igtl::pose_text(X_CT))
                  .bytes());
  std::array<std::byte, 28> place{};  // 0, 0, 1000 mm, not turned
  net::put(std::span<std::byte>(place), 8, std::bit_cast<std::uint32_t>(1000.0F));
  net::put(std::span<std::byte>(place), 24, std::bit_cast<std::uint32_t>(1.0F));
  const std::string position =
      text_of(igtl::OutgoingMessage("POSITION", "stylusToTracker", 1'530'000'000, place).bytes());
  const std::string three =
      text_of(igtl::OutgoingMessage("POSITION", "stylusToTracker", 1'540'000'000, std::span(place).first(24))
                  .bytes());
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
    Measurement<TrackedTool> newest;
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
