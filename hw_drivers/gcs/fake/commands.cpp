#include "hw_drivers/gcs/fake/commands.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace enc::gcs {
namespace {

std::array<double, 3> in_millimetres(const Vec3& p) {
  return {millimetres(p.x()), millimetres(p.y()), millimetres(p.z())};
}

std::array<bool, kAxes> same(bool value) { return {value, value, value, value, value, value}; }

constexpr std::array<std::string_view, kAxes> kUnits{"MM", "MM", "MM", "DEG", "DEG", "DEG"};

}  // namespace

std::span<const Commands::Entry> Commands::all() noexcept {
  using ControllerRef = Controller&;
  using Rest = std::string_view;
  static constexpr std::array kAll = std::to_array<Entry>({
      {"*IDN?", "Get Device Identification", [](ControllerRef of, Rest) { of.say(of.settings_.identity); }},
      {"CST?", "[{<AxisID>}] Get Assignment Of Stages To Axes",
       [](ControllerRef of, Rest rest) {
         std::array<std::string_view, kAxes> names;
         names.fill(of.settings_.stage);
         of.say_axes(rest, kAxisNames, names);
       }},
      {"CSV?", "Get Current Syntax Version", [](ControllerRef of, Rest) { of.say("2.0"); }},
      {"ERR?", "Get Error Number", error},
      {"FRF", "[{<AxisID>}] Fast Reference Move To Reference Switch", reference},
      {"FRF?", "[{<AxisID>}] Get Referencing Result",
       [](ControllerRef of, Rest rest) { of.say_flags(rest, same(of.referenced_)); }},
      {"HLP?", "Get List Of Available Commands", help},
      {"HLT", "[{<AxisID>}] Halt Motion Smoothly", halt},
      {"KEN?", "[{<CSName>}] Get Enabled Coordinate Systems", [](ControllerRef of, Rest) { of.say("ZERO=KSD"); }},
      {"MOV", "{<AxisID> <Position>} Set Target Position", move},
      {"MOV?", "[{<AxisID>}] Get Target Position",
       [](ControllerRef of, Rest rest) { of.say_axes(rest, kAxisNames, of.shown(of.profile_.aim())); }},
      {"MVR", "{<AxisID> <Distance>} Set Target Relative To Current Position", move_by},
      {"ONT?", "[{<AxisID>}] Get On-Target State",
       [](ControllerRef of, Rest rest) { of.say_flags(rest, of.on_target()); }},
      {"POS?", "[{<AxisID>}] Get Real Position",
       [](ControllerRef of, Rest rest) { of.say_axes(rest, kAxisNames, of.shown(of.measured_)); }},
      {"PUN?", "[{<AxisID>}] Get Axis Unit",
       [](ControllerRef of, Rest rest) { of.say_axes(rest, kAxisNames, std::span<const std::string_view>(kUnits)); }},
      {"SAI?", "[ALL] Get List Of Current Axis Identifiers",
       [](ControllerRef of, Rest rest) {
         if (const Rest word = next_word(rest); of.wrong(!word.empty() && word != "ALL", kSyntax)) return;
         of.answer_ += "X \nY \nZ \nU \nV \nW\n";
       }},
      {"SCT", "T <Time> Set Cycle Time, ms", cycle_time},
      {"SCT?", "[T] Get Cycle Time, ms",
       [](ControllerRef of, Rest) {
         Text text;
         of.say(text.add("T=").add(1e3 * of.points_cycle_).view());
       }},
      {"SPA", "{<ItemID> <PamID> <PamValue>} Set Volatile Memory Parameters", set_parameter},
      {"SPA?", "[{<ItemID> <PamID>}] Get Volatile Memory Parameters", parameter},
      {"SPI", "{<PPCoordinate> <Position>} Set Pivot Point", pivot},
      {"SPI?", "[{<PPCoordinate>}] Get Pivot Point",
       [](ControllerRef of, Rest rest) {
         of.say_axes(rest, kPivotNames, in_millimetres(of.stand_.pivot));
       }},
      {"SSN?", "Get Device Serial Number", [](ControllerRef of, Rest) { of.say("119000000"); }},
      {"STP", "Stop All Axes", [](ControllerRef of, Rest) { of.stop(kAbrupt); }},
      {"SVO", "{<AxisID> <ServoState>} Set Servo Mode", servo},
      {"SVO?", "[{<AxisID>}] Get Servo Mode", [](ControllerRef of, Rest rest) { of.say_flags(rest, of.servo_); }},
      {"TMN?", "[{<AxisID>}] Get Minimum Commandable Position",
       [](ControllerRef of, Rest rest) { of.say_axes(rest, kAxisNames, to_wire_units(of.travel_.low)); }},
      {"TMX?", "[{<AxisID>}] Get Maximum Commandable Position",
       [](ControllerRef of, Rest rest) { of.say_axes(rest, kAxisNames, to_wire_units(of.travel_.high)); }},
      {"VER?", "Get Versions Of Firmware And Drivers", [](ControllerRef of, Rest) { of.say("FW: fake"); }},
      {"VLS", "<SystemVelocity> Set System Velocity", velocity},
      {"VLS?", "Get System Velocity",
       [](ControllerRef of, Rest) {
         Text text;
         of.say(text.add(millimetres(of.velocity_)).view());
       }},
      {"VMO?", "{<AxisID> <Position>} Virtual Move", possible},
  });
  return kAll;
}

void Commands::help(Controller& of, std::string_view) {
  of.answer_ += "The following commands are valid: \n";
  for (const std::string_view byte :
       {"#3 Get Real Position \n", "#4 Request Status Register \n", "#5 Request Motion Status \n",
        "#6 Query If Position Has Changed Since Last #6 \n", "#7 Request Controller Ready Status \n",
        "#8 Query If Macro Is Running \n", "#9 Get Wave Generator Status \n",
        "#11 Get Memory Space Of Trajectory Points \n", "#24 Stop All Axes \n", "#27 System Abort \n"})
    of.answer_ += byte;
  for (const Entry& one : all()) of.answer_.append(one.word).append(" ").append(one.help).append(" \n");
  of.say("end of help");
}

void Commands::move(Controller& of, std::string_view rest) { go(of, rest, false); }
void Commands::move_by(Controller& of, std::string_view rest) { go(of, rest, true); }

void Commands::go(Controller& of, std::string_view rest, bool relative) {
  ++of.told_;
  const Coordinates aim = to_wire_units(of.profile_.aim());
  Coordinates to = relative ? Coordinates{} : aim;
  if (!of.read_pairs(rest, kAxisNames, to)) return;
  for (std::size_t i = 0; relative && i < kAxes; ++i) to[i] += aim[i];
  if (of.wrong(of.referencing_, kNotInMotion) || of.wrong(!of.referenced_ || !of.all_on(), kNotReady)) return;
  if (of.wrong(!of.within(from_wire_units(to)), kOutOfLimits)) return;
  of.go(from_wire_units(to));
}

void Commands::possible(Controller& of, std::string_view rest) {
  Coordinates to = to_wire_units(of.profile_.aim());
  if (of.read_pairs(rest, kAxisNames, to)) of.say(of.within(from_wire_units(to)) ? "1" : "0");
}

bool Commands::names_axes(Controller& of, std::string_view rest) {
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
    if (of.is_none(word, kAxisNames)) return false;
  return true;
}

// Any axis references all. The fake's reference move is a move to zero.
void Commands::reference(Controller& of, std::string_view rest) {
  ++of.told_;
  if (!names_axes(of, rest)) return;
  if (of.wrong(!of.at_rest(), kNotInMotion)) return;
  of.referenced_ = false;
  of.referencing_ = true;
  of.servo_ = same(true);
  of.by_points_ = false;
  of.profile_.go(Coordinates{});
}

void Commands::servo(Controller& of, std::string_view rest) {
  Coordinates values{};
  for (std::size_t i = 0; i < kAxes; ++i) values[i] = of.servo_[i] ? 1.0 : 0.0;
  if (!of.read_pairs(rest, kAxisNames, values)) return;
  for (const double value : values)
    if (of.wrong(value != 0.0 && value != 1.0, kOutOfRange)) return;
  for (std::size_t i = 0; i < kAxes; ++i) of.servo_[i] = values[i] == 1.0;
  if (of.all_on()) return;
  of.profile_.halt(kAbrupt);
  of.points_.clear();
}

void Commands::velocity(Controller& of, std::string_view rest) {
  const std::string_view word = next_word(rest);
  double value = 0.0;
  if (of.wrong(word.empty(), kMissing) || of.wrong(!read_number(word, value), kNoNumber)) return;
  if (of.wrong(!next_word(rest).empty(), kWrongCount)) return;
  if (of.wrong(!(value > 0.0) || metres(value) > of.settings_.most_velocity, kVelocityOutOfLimits)) return;
  if (!of.wrong(!of.at_rest(), kNotInMotion)) of.velocity_ = metres(value);
}

void Commands::pivot(Controller& of, std::string_view rest) {
  std::array<double, 3> values = in_millimetres(of.stand_.pivot);
  if (!of.read_pairs(rest, kPivotNames, values)) return;
  const Coordinates& at = of.profile_.aim();
  if (of.wrong(at[3] != 0.0 || at[4] != 0.0 || at[5] != 0.0, kPivotWhileTurned)) return;
  constexpr double kFarthest = 1000.0;  // mm
  for (const double value : values)
    if (of.wrong(std::abs(value) > kFarthest, kOutOfRange)) return;
  if (!of.wrong(!of.at_rest(), kNotInMotion))
    of.stand_.pivot = {metres(values[0]), metres(values[1]), metres(values[2])};
}

// The fake has one parameter: the source of the path.
bool Commands::names_parameter(Controller& of, std::string_view axis, std::string_view number) {
  constexpr std::string_view kPathSource = "0x19001900";
  if (of.wrong(number.empty(), kMissing) || of.is_none(axis, kAxisNames)) return false;
  return !of.wrong(number != kPathSource, kUnknownParameter);
}

void Commands::parameter(Controller& of, std::string_view rest) {
  const std::string_view axis = next_word(rest), number = next_word(rest);
  if (names_parameter(of, axis, number))
    of.say(std::string(axis).append(" ").append(number).append(of.by_points_ ? "=1" : "=0"));
}

void Commands::set_parameter(Controller& of, std::string_view rest) {
  const std::string_view axis = next_word(rest), number = next_word(rest), value = next_word(rest);
  if (!names_parameter(of, axis, number)) return;
  if (of.wrong(value.empty(), kMissing) || of.wrong(value != "0" && value != "1", kOutOfRange)) return;
  if (!of.wrong(!of.at_rest(), kNotInMotion)) of.by_points_ = value == "1";
}

void Commands::cycle_time(Controller& of, std::string_view rest) {
  constexpr double kShortest = 1.0, kLongest = 1000.0;  // ms
  double value = 0.0;
  if (of.wrong(next_word(rest) != "T", kSyntax) || of.wrong(!read_number(next_word(rest), value), kNoNumber))
    return;
  if (of.wrong(!(value >= kShortest && value <= kLongest), kOutOfRange)) return;
  if (!of.wrong(!of.at_rest(), kNotInMotion)) of.points_cycle_ = 1e-3 * value;
}

void Commands::halt(Controller& of, std::string_view rest) {
  if (names_axes(of, rest)) of.stop(kSmooth);
}

void Commands::error(Controller& of, std::string_view) {
  Text text;
  of.say(text.add(of.error_).view());
  of.error_ = kNoError;
}

}  // namespace enc::gcs
