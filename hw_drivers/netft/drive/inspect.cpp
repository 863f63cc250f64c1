#include "hw_drivers/netft/drive/inspect.h"

#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/net/steady.h"
#include "hw_drivers/netft/wire/command.h"
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

std::vector<std::byte> ask_calibration(const NetftSettings& settings) {
  const Duration timeout = from_seconds(settings.timeout);
  net::Socket socket;
  try {
    socket = net::connect_tcp(settings.address, static_cast<std::uint16_t>(settings.command_port), timeout);
  } catch (const Error&) {
    return {};
  }
  const auto question = bytes_of(Ask{.question = Question::calibration});
  std::vector<std::byte> answer;
  std::size_t sent = 0;
  for (const Duration until = net::steady_now() + timeout; answer.size() < kCalibrationSize;) {
    sent += socket.send(std::span(question).subspan(sent));
    constexpr Duration kTurn{10'000'000};
    socket.wait(kTurn);
    std::array<std::byte, kCalibrationSize> bytes{};
    const std::size_t got = socket.receive(std::span(bytes).first(kCalibrationSize - answer.size()));
    answer.insert(answer.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(got));
    if ((got == 0 && socket.closed()) || net::steady_now() > until)
      refuse(fmt::format(
          "{}: its command interface takes READCALINFO and says nothing; see driver.netft.command_port "
          "(0: not asked)",
          net::place(settings.address, static_cast<std::uint16_t>(settings.command_port))));
  }
  return answer;
}

void agree(std::span<const std::byte> answer, const Configuration& page, const NetftSettings& settings) {
  Calibration says;
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * b; };  // NaN is like nothing
  if (read(answer, says) && same(says.per_force / force_of_code(says.force_unit), page.per_newton) &&
      same(says.per_torque / torque_of_code(says.torque_unit), page.per_newton_metre))
    return;
  refuse(fmt::format(
      "{}: its page says {:g} counts for a newton and {:g} for a newton metre, its command interface {} for "
      "unit {} and {} for unit {}; save its page Configurations again, and switch it off and on",
      settings.place(), page.per_newton, page.per_newton_metre, says.per_force, says.force_unit,
      says.per_torque, says.torque_unit));
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
  if (found.turned)
    refuse(
        fmt::format("{} turns or moves its axes itself (tool transform, cfgtfx); set it to 0 on its page "
                    "Configurations: where the sensor stands is the rig's to say (frames.H_F)",
                    place));
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
    constexpr std::array<const char*, kAxes> kNames{"Fx", "Fy", "Fz", "Tx", "Ty", "Tz"};
    refuse(fmt::format(
        "{} can do less than the rig file promises: {} to {:g} of {:g} {}; choose another configuration "
        "on its page, or lower driver.netft.{}",
        place, kNames[i], found.ratings[i], least, force ? "N" : "N m",
        force ? "range_N" : "torque_range_Nm"));
  }
  return found;
}

}  // namespace enc::netft
