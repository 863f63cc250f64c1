#include "hw_drivers/gcs/drive/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"
#include "hw_drivers/net/socket.h"

namespace enc::gcs {
namespace {

[[noreturn]] void refuse(const std::string& words) { throw Error(words, {}, ErrorKind::device); }

std::string shown(std::string_view answer) { return net::printable(trimmed(answer)); }

struct Inspector {
  const Ask& ask;
  const GcsSettings& settings;
  const Reach& promised;
  std::string name = settings.place();  // later: the controller's identity

  template <std::size_t kCount>
  [[nodiscard]] std::array<double, kCount> axes(std::string_view line, std::string_view names) const {
    std::array<double, kCount> values{};
    const std::string answer = ask(line);
    if (!read_axes(answer, names, values))
      refuse(fmt::format("{} answered '{}' to {}; expected a number for each of {}: is a hexapod connected?",
                         name, shown(answer), line, names));
    return values;
  }
  [[nodiscard]] int error() const {
    int number = 0;
    if (const std::string answer = ask("ERR?"); !read_error(answer, number))
      refuse(fmt::format("{} answered '{}' to ERR?; expected a number", name, shown(answer)));
    return number;
  }
  // Names of the axes whose value is not 1.
  [[nodiscard]] std::string without(std::string_view line) const {
    const auto values = axes<kAxes>(line, kAxisNames);
    std::string names;
    for (std::size_t i = 0; i < kAxes; ++i)
      if (values[i] != 1.0) names.append(names.empty() ? "" : " ").push_back(kAxisNames[i]);
    return names;
  }

  void identify(ControllerInfo& found);
  void plain() const;
  void ready() const;
  void able(ControllerInfo& found) const;
  Travel far_enough(const Stand& stand) const;
};

// Expects "X=MM \n ... W=DEG\n".
bool has_units(std::string_view answer) {
  for (const char axis : kAxisNames) {
    const std::size_t at = answer.find(std::string{axis, '='});
    if (at == std::string_view::npos) return false;
    const std::string_view unit = answer.substr(at + 2, answer.find('\n', at) - at - 2);
    if (trimmed(unit) != (kAxisNames.find(axis) < 3 ? "MM" : "DEG")) return false;
  }
  return true;
}

// Compares two versions: -1: older, 1: newer; parts that are not numbers count as 0.
int compared(std::string_view is, std::string_view least) {
  const auto part = [](std::string_view& text) {
    const std::size_t end = std::min(text.find('.'), text.size());
    int number = 0;
    static_cast<void>(read_number(text.substr(0, end), number));
    text.remove_prefix(std::min(end + 1, text.size()));
    return number;
  };
  while (!is.empty() || !least.empty())
    if (const int a = part(is), b = part(least); a != b) return a < b ? -1 : 1;
  return 0;
}

// The answer looks like "(c)2019 Physik Instrumente (PI) GmbH & Co. KG, C-887.53, 119012345, 2.10.0.1".
void Inspector::identify(ControllerInfo& found) {
  const std::string answer = ask("*IDN?");
  if (answer.find(settings.identity) == std::string::npos)
    refuse(
        fmt::format("{} is another device: it says '{}', expected '{}'; correct driver.gcs.address or "
                    "driver.gcs.identity",
                    settings.place(), shown(answer), settings.identity));
  std::array<std::string, 4> fields;
  std::string_view rest = answer;
  for (std::string& field : fields) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    field = shown(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  found.identity = fields[1].empty() ? shown(answer) : fields[1] + " " + fields[2];
  found.firmware = fields[3];
  found.fake = answer.find(kFakeName) != std::string::npos;
  found.lockstep = answer.find(kLockstep) != std::string::npos;
  name = found.identity + " at " + settings.place();
  if (!settings.firmware.empty() && compared(found.firmware, settings.firmware) < 0)
    refuse(fmt::format("{} has firmware '{}', older than {}; update it or lower driver.gcs.firmware", name,
                       found.firmware, settings.firmware));
  double version = kUnset;
  if (const std::string said = ask("CSV?"); !read_single(said, version) || version != 2.0)
    refuse(fmt::format("{} speaks GCS '{}', not 2.0; another driver is needed", name, shown(said)));
}

// Requires units of mm and degrees, the default coordinate system, and the controller's own profile
// generator.
void Inspector::plain() const {
  if (const std::string said = ask("CST?"); said.find(settings.stage) == std::string::npos)
    refuse(
        fmt::format("{} drives another machine: it answered '{}' to CST?, expected '{}'; correct "
                    "driver.gcs.address or driver.gcs.stage",
                    name, shown(said), settings.stage));
  if (const std::string said = ask("PUN?"); !has_units(said))
    refuse(
        fmt::format("{} has other units: it answered '{}' to PUN?, expected MM for X Y Z and DEG for U V "
                    "W; set them so",
                    name, shown(said)));
  if (const std::string said = ask("KEN?"); !trimmed(said).starts_with("ZERO="))
    refuse(
        fmt::format("{} works in another coordinate system: it answered '{}' to KEN?, expected ZERO; send "
                    "KEN ZERO",
                    name, shown(said)));
  constexpr std::string_view kSource = "SPA? X 0x19001900";
  const std::string said = ask(kSource);
  const std::size_t equals = said.find('=');
  double source = kUnset;
  if (equals == std::string::npos || !read_single(std::string_view(said).substr(equals + 1), source) ||
      (source != 0.0 && source != 1.0))
    refuse(
        fmt::format("{} takes its path from elsewhere: it answered '{}' to {}, expected 0 or 1; send SPA "
                    "X 0x19001900 0",
                    name, shown(said), kSource));
  if (const std::string moving = ask("\x05"); trimmed(moving) != "0")
    refuse(fmt::format("{} moves: it answered '{}' to #5, expected 0; stop it (STP), and see who told it",
                       name, shown(moving)));
}

void Inspector::ready() const {
  if (const std::string axes = without("FRF?"); !axes.empty())
    refuse(
        fmt::format("{} is not referenced ({}); clear the room round the platform and send FRF once, as "
                    "docs/guide/laboratory.md says: this moves it",
                    name, axes));
  if (const std::string axes = without("SVO?"); !axes.empty())
    refuse(fmt::format("{}: the servo of {} is off; switch it on (SVO {} 1)", name, axes, axes.substr(0, 1)));
}

// Compares the controller's range on each axis, in both directions, with the range of the rig's machine. A
// limit that is not a number fails.
Travel Inspector::far_enough(const Stand& stand) const {
  const Travel can{from_wire_units(axes<kAxes>("TMN?", kAxisNames)),
                   from_wire_units(axes<kAxes>("TMX?", kAxisNames))};
  const Coordinates promises = travel_of(promised, stand).both_sides();
  constexpr double kShare = 0.03;  // a rig's geometry is derived from a catalogue's round numbers
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double least = promises[i] * (1 - kShare);
    if (can.high[i] >= least && can.low[i] <= -least) continue;
    refuse(
        fmt::format("{} can do less than the rig file promises: {} from {:.6g} to {:.6g} {}, not {:.6g} to "
                    "both sides; lower rig.manipulator.geometry.{}",
                    name, kAxisNames[i], to_wire_units(can.low)[i], to_wire_units(can.high)[i],
                    i < 3 ? "mm" : "degrees", to_wire_units(promises)[i],
                    i < 3    ? "stroke_mm"
                    : i == 5 ? "yaw_limit_deg"
                             : "tilt_limit_deg"));
  }
  return can;
}

void Inspector::able(ControllerInfo& found) const {
  const auto pivot = axes<3>("SPI?", kPivotNames);
  found.stand.origin = {0, 0, settings.origin_height};
  found.stand.pivot = {metres(pivot[0]), metres(pivot[1]), metres(pivot[2])};
  found.stand.tip = promised.machine.zero().p();
  if (!found.stand.pivot.allFinite()) refuse(fmt::format("{}: its pivot is no number (SPI?)", name));
  found.travel = far_enough(found.stand);
  if (const std::string answer = ask("VLS?"); read_single(answer, found.velocity))
    found.velocity = metres(found.velocity);
  else
    refuse(fmt::format("{} answered '{}' to VLS?; expected a number", name, shown(answer)));
  if (settings.velocity > 0.0) found.velocity = settings.velocity;
  if (!(found.velocity >= promised.speed * (1 - 1e-9)))
    refuse(
        fmt::format("{} can do less than the rig file promises: velocity {:g} of {:g} mm/s; set "
                    "driver.gcs.velocity_mm_s, or lower rig.manipulator.speed_mm_s",
                    name, millimetres(found.velocity), millimetres(promised.speed)));
  found.at = from_wire_units(axes<kAxes>("POS?", kAxisNames));
}

}  // namespace

ControllerInfo inspect(const Ask& ask, const GcsSettings& settings, const Reach& promised) {
  ControllerInfo found;
  Inspector inspector{ask, settings, promised};
  inspector.identify(found);
  found.left_over = inspector.error();
  inspector.plain();
  inspector.ready();
  inspector.able(found);
  if (const int number = inspector.error(); number != kNoError)
    refuse(fmt::format("{} met {}", inspector.name, error_words(number)));
  return found;
}

}  // namespace enc::gcs
