// The two ends of a Net F/T: what the driver takes from a box, and what the fake takes from anybody.
#include "core/base/error.h"
#include "core/devices/force_sensor.h"
#include "hw_drivers/netft/drive/inspect.h"
#include "hw_drivers/netft/drive/session.h"
#include "hw_drivers/netft/fake/box.h"
#include "hw_drivers/netft/wire/command.h"
#include "hw_drivers/netft/wire/http.h"
#include "tests/fuzz/machine/target.h"

namespace enc::fuzz {
namespace {

std::span<const std::byte> bytes_in(const std::string& input) { return std::as_bytes(std::span(input)); }

// Records one behind the other, of 36 bytes each: times only grow, forces are numbers.
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
      std::string(79'000, '\r')};  // a reader that looks through all of it at each piece is caught
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
  struct Still final : ForceSensor {
    Stamped<Wrench> read(Time now) noexcept override {
      return {{Vec<'F'>::zero(), Vec<'F'>::zero()}, now, Health::ok};
    }
  };
  Target target;
  target.seeds = {text_of(netft::bytes_of(netft::Request{netft::Command::start, 0})) +
                  text_of(netft::bytes_of(netft::Request{netft::Command::bias, 0}))};
  target.tokens = {std::string("\x12\x34", 2), std::string("\x00\x42", 2),
                   std::string("\xff\xff\xff\xff", 4)};
  target.run = [](const std::string& input) {
    Still still;
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

}  // namespace
}  // namespace enc::fuzz
