#include "hw_drivers/netft/drive/inspect.h"

#include <array>
#include <span>

#include <fmt/format.h>

#include "core/error.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/net/steady.h"
#include "hw_drivers/netft/wire/http.h"

namespace enc::netft {
namespace {

[[noreturn]] void refuse(const std::string& words) { throw Error(words, {}, ErrorKind::device); }

// Words of another device on one line, whatever bytes it sent.
std::string shown(std::string text) {
  text.resize(std::min<std::size_t>(text.size(), 100));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

}  // namespace

std::string fetch(const NetftSettings& settings, const std::string& path) {
  const auto port = static_cast<std::uint16_t>(settings.http_port);
  const std::string page = "http://" + net::place(settings.address, port) + path;
  constexpr Duration kTurn{10'000'000};
  const Duration timeout = from_seconds(settings.timeout);
  net::Socket socket = net::connect_tcp(settings.address, port, timeout);
  const std::string request = http_request(net::place(settings.address, port), path);
  std::span<const std::byte> unsent = std::as_bytes(std::span(request));
  std::array<char, 4096> bytes{};
  HttpAnswer answer;
  for (const Duration until = net::steady_now() + timeout; !answer.complete();) {
    if (!unsent.empty()) unsent = unsent.subspan(socket.send(unsent));
    socket.wait(kTurn);
    const std::size_t got = socket.receive(std::as_writable_bytes(std::span(bytes)));
    answer.take({bytes.data(), got});
    if (got == 0 && socket.closed()) answer.closed();
    if (!answer.complete() && net::steady_now() > until)
      refuse(fmt::format("{}: no whole answer within {:.0f} ms; see that it is a Net F/T, and ready", page,
                         1e3 * settings.timeout));
  }
  if (!answer.wrong().empty())
    refuse(fmt::format("{} {}; see that it is a Net F/T, and driver.netft.http_port", page, answer.wrong()));
  return std::string(answer.body());
}

Configuration inspect(const std::string& xml, const NetftSettings& settings, Duration period) {
  Configuration found;
  const std::string place = settings.place();
  if (const std::string wrong = read_xml(xml, found); !wrong.empty())
    refuse(fmt::format("{}: its netftapi2.xml {}; see that it is a Net F/T", place, shown(wrong)));
  if (found.product.find(settings.product) == std::string::npos)
    refuse(
        fmt::format("{} is another device: it says '{}', expected '{}'; correct driver.netft.address or "
                    "driver.netft.product",
                    place, shown(found.product), settings.product));
  if (!found.streams)
    refuse(
        fmt::format("{} sends no records: RDT is switched off; enable it on its page Communications", place));
  const double needed = 1.0 / seconds(period);
  if (!(found.rate >= needed * (1 - 1e-9)))
    refuse(fmt::format(
        "{} sends {:g} records a second, and the loop makes {:g}; set the RDT output rate to {:g} Hz or "
        "more on its page Communications",
        place, found.rate, needed, needed));
  for (std::size_t i = 0; i < 6; ++i) {
    const bool force = i < 3;
    const double least = force ? settings.range : settings.torque_range;
    if (found.ratings[i] >= least * (1 - 1e-9)) continue;
    constexpr std::array<const char*, 6> kAxes{"Fx", "Fy", "Fz", "Tx", "Ty", "Tz"};
    refuse(fmt::format(
        "{} can do less than the rig file promises: {} to {:g} of {:g} {}; choose another configuration "
        "on its page, or lower driver.netft.{}",
        place, kAxes[i], found.ratings[i], least, force ? "N" : "N m",
        force ? "range_N" : "torque_range_Nm"));
  }
  return found;
}

}  // namespace enc::netft
