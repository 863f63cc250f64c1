#include "hw_drivers/gcs/fake/controller.h"

#include <algorithm>
#include <cmath>

#include "hw_drivers/gcs/fake/commands.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {
namespace {

constexpr Duration kCycle{1'000'000};
constexpr Duration kCaughtUp{100'000'000};  // a longer backlog is not made up for

}  // namespace

Controller::Controller(Manipulator& machine, const ControllerSettings& settings)
    : machine_(machine),
      settings_(settings),
      reach_(machine.reach()),
      referenced_(settings.referenced),
      velocity_(settings.velocity) {
  stand_.origin = {0, 0, settings.origin_height};
  stand_.tip = reach_.machine.zero().p();
  travel_ = travel_of(reach_, stand_);
  if (settings_.advance)
    settings_.identity.insert(settings_.identity.rfind(", "), std::string(" ").append(kLockstep));
}

std::string_view Controller::take(std::string_view bytes) {
  answer_.clear();
  for (const char c : bytes) {
    const bool start = line_.empty() && !long_;
    if (c == '\n') {
      if (!wrong(long_, kTooLong)) line(line_.view());
      forget_line();
    } else if (start && static_cast<unsigned char>(c) < ' ' && c != '\r' && c != '\t') {
      byte(c);
    } else if (!(start && c == '\r')) {
      long_ = line_.add(c).cut() || long_;
    }
  }
  return answer_;
}

void Controller::forget_line() noexcept {
  line_.clear();
  long_ = false;
}

// An unknown command sets an error and gets no answer. Lower case is accepted.
void Controller::line(std::string_view text) {
  std::string_view rest = text;
  std::string word(next_word(rest));
  for (char& c : word)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  if (word.empty()) return;
  for (const Commands::Entry& one : Commands::all())
    if (one.word == word) return one.run(*this, rest);
  wrong(true, kUnknownCommand);
}

void Controller::byte(char command) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  const auto hex = [&](unsigned value) {
    std::string text;
    for (; value != 0 || text.empty(); value /= 16) text.insert(text.begin(), kHex[value % 16]);
    return text;
  };
  constexpr unsigned kAll = 0x3f;
  switch (command) {
    case 3:
      return say_axes({}, kAxisNames, shown(measured_));
    case 4:
      return say("0x" + hex(status()));
    case 5:
      return say(hex(at_rest() ? 0 : kAll));
    case 6: {
      unsigned changed = 0;
      for (std::size_t i = 0; i < kAxes; ++i) changed |= measured_[i] != seen_[i] ? 1U << i : 0U;
      seen_ = measured_;
      return say(hex(changed));
    }
    case 7:
      return say(referencing_ ? "\xB0" : "\xB1");
    case 8:
    case 9:
      return say("0");
    case 11:
      return say(std::to_string(points_.free()));
    case 24:
    case 27:
      return stop(kAbrupt);
    default:
      wrong(true, kUnknownCommand);
  }
}

bool Controller::wrong(bool bad, int error) noexcept {
  if (bad) error_ = error;
  return bad;
}

bool Controller::is_none(std::string_view word, std::string_view names) noexcept {
  return wrong(word.size() != 1 || names.find(word[0]) == std::string_view::npos, kNoSuchAxis);
}

void Controller::mend() noexcept {
  error_ = kNoError;
  servo_.fill(true);
}

void Controller::fail(int error) noexcept {
  error_ = error;
  servo_ = {};
  profile_.halt(kAbrupt);
  points_.clear();
}

void Controller::stop(double hardness) noexcept {
  ++stops_;
  profile_.halt(hardness);
  points_.clear();
  referencing_ = false;
  error_ = kStopped;
}

void Controller::cycle(Time now) noexcept {
  if (!begun_ || now < now_) {  // the simulation was restarted
    if (begun_) error_ = kNoError;
    begun_ = true;
    now_ = now - kCycle;
    Coordinates at{};
    if (coordinates_of(machine_.read(now).value.X_RH, stand_, at)) profile_.reset(at);
    measured_ = seen_ = profile_.at();
    points_.clear();
    by_points_ = false;
  }
  now_ = std::max(now_, now - kCaughtUp);
  if (settings_.advance) return;
  for (; now_ + kCycle <= now; now_ += kCycle) {
    if (by_points_)
      profile_.reset(points_.step(profile_.at(), seconds(kCycle), points_cycle_, velocity_));
    else
      profile_.step(seconds(kCycle), {velocity_, reach_.acceleration});
    machine_.command(pose_of(profile_.at(), stand_));
    measure(now_ + kCycle);
    if (referencing_ && !profile_.moving()) {
      referencing_ = false;
      referenced_ = true;
    }
  }
}

void Controller::measure(Time now) noexcept {
  Coordinates at{};
  if (coordinates_of(machine_.read(now).value.X_RH, stand_, at)) measured_ = at;
}

void Controller::go(const Coordinates& to) {
  if (!settings_.advance && by_points_) {
    // The client must send points that are at most one cycle apart at the set velocity.
    constexpr double kRounding = 1.0 + 1e-6;
    const double way = distance(points_.last(profile_.at()), to);
    if (wrong(way > velocity_ * points_cycle_ * kRounding, kVelocityOutOfLimits)) return;
    if (!wrong(points_.free() == 0, kOutOfRange)) points_.add(to);
    return;
  }
  if (!settings_.advance) return profile_.go(to);
  profile_.reset(to);
  machine_.command(pose_of(to, stand_));
  settings_.advance();
  measure(now_);
}

bool Controller::within(const Coordinates& to) const noexcept {
  constexpr double kRounding = 1e-9;  // m or rad: rounding of numbers with twelve digits
  for (std::size_t i = 0; i < kAxes; ++i)
    if (!(to[i] >= travel_.low[i] - kRounding && to[i] <= travel_.high[i] + kRounding)) return false;
  return reach_.contains(pose_of(to, stand_));
}

Coordinates Controller::shown(const Coordinates& at) const noexcept {
  return referenced_ ? to_wire_units(at) : Coordinates{};
}

bool Controller::all_on() const noexcept {
  return std::all_of(servo_.begin(), servo_.end(), [](bool on) { return on; });
}

std::array<bool, kAxes> Controller::on_target() const noexcept {
  constexpr double kNear = 10e-6;  // m, and rad
  std::array<bool, kAxes> on{};
  for (std::size_t i = 0; i < kAxes; ++i)
    on[i] = referenced_ && servo_[i] && at_rest() && std::abs(measured_[i] - profile_.aim()[i]) < kNear;
  return on;
}

// Status bits: 12 servo on, 13 in motion, 14 referencing, 15 on target.
unsigned Controller::status() const noexcept {
  return (all_on() ? 1U << 12U : 0U) | (at_rest() ? 0U : 1U << 13U) | (referencing_ ? 1U << 14U : 0U) |
         (on_target()[0] ? 1U << 15U : 0U);
}

void Controller::say_axes(std::string_view words, std::string_view names,
                          std::span<const std::string_view> values) {
  std::string list;
  for (std::string_view word = next_word(words); !word.empty(); word = next_word(words)) {
    if (is_none(word, names)) return;
    if (wrong(list.find(word[0]) != std::string::npos, kAxisTwice)) return;
    list += word;
  }
  if (list.empty()) list = names;
  for (std::size_t i = 0; i < list.size(); ++i)
    answer_.append(1, list[i])
        .append("=")
        .append(values[names.find(list[i])])
        .append(i + 1 < list.size() ? " \n" : "\n");
}

void Controller::say_axes(std::string_view words, std::string_view names, std::span<const double> values) {
  std::array<Text, kAxes> texts;
  std::array<std::string_view, kAxes> views;
  for (std::size_t i = 0; i < names.size(); ++i) views[i] = texts[i].add(values[i]).view();
  say_axes(words, names, views);
}

void Controller::say_flags(std::string_view words, std::span<const bool> values) {
  std::array<std::string_view, kAxes> views;
  for (std::size_t i = 0; i < kAxes; ++i) views[i] = values[i] ? "1" : "0";
  say_axes(words, kAxisNames, views);
}

bool Controller::read_pairs(std::string_view words, std::string_view names,
                            std::span<double> values) noexcept {
  unsigned seen = 0;
  std::string_view word = next_word(words);
  if (wrong(word.empty(), kMissing)) return false;
  for (; !word.empty(); word = next_word(words)) {
    if (is_none(word, names)) return false;
    const std::size_t axis = names.find(word[0]);
    if (wrong(((seen >> axis) & 1U) != 0, kAxisTwice)) return false;
    seen |= 1U << axis;
    const std::string_view number = next_word(words);
    if (wrong(number.empty(), kWrongCount)) return false;
    if (wrong(!read_number(number, values[axis]), kNoNumber)) return false;
  }
  return true;
}

}  // namespace enc::gcs
