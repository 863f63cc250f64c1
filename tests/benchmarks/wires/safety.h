// Fault x device x mode: what a run comes to, and how soon after the fault was injected. In virtual time; the
// table of docs/reference/safety.md is this one.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "core/devices/mode.h"
#include "tests/benchmarks/wires/wired_trial.h"

namespace enc::bench::wires {

// What becomes of a run.
enum class End : std::uint8_t {
  unharmed,  // it does not hold
  holds,     // while the fault lasts, and goes on
  link_lost  // it holds, and needs a new run
};

struct Fault {
  const char *device, *name;
  void (*inject)(WiredTrial& at);
  void (*cure)(WiredTrial& at);  // after 0.7 s
  End end;
  double hold = 0.0;      // ms after it, at most: held by then
  std::uint32_t why = 0;  // among the reasons
  // Of what does no harm: what the driver has counted says that it was there ("missing", "old").
  const char* counted = nullptr;
  bool over = false;  // when the loop is back: the machine stands by then, and it goes on
  // Where no tool is in view, and the machine waits: another time and reason; 0: the same.
  double hold_away = 0.0;
  std::uint32_t why_away = 0;
  bool streams = false;  // the tracker's own server over TCP, in place of datagrams
  [[nodiscard]] double hold_in(Mode mode) const {
    return mode == Mode::away && hold_away > 0 ? hold_away : hold;
  }
  [[nodiscard]] std::uint32_t why_in(Mode mode) const {
    return mode == Mode::away && why_away != 0 ? why_away : why;
  }
};
[[nodiscard]] std::span<const Fault> faults();

inline constexpr Mode kInjectedIn[] = {Mode::away, Mode::follow, Mode::contact, Mode::restore};

inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct Reaction {
  double hold = kNever, rest = kNever;  // ms after it; rest: below 0.1 mm/s from then on, for 0.7 s
  Mode in = Mode::hold;                 // when it was injected
  double speed = 0.0;  // of the tip, or of where it is told to be, m/s: the greatest from then until it holds
  double way = 0.0;    // of the tip from then on, m, for 0.7 s
  std::uint32_t why = 0;    // of the first hold
  bool held = false;        // in the 0.7 s
  bool linked = true;       // all, 0.5 s after it was cured
  bool goes_on = false;     // was in another mode than hold in those 0.5 s
  std::string end{};        // why it holds at the end
  double counted = kUnset;  // what the driver says that it has counted
  double simulated = 0.0;   // s
};
// Bounds that hold for every cell, from how fast the tip was, the points that the controller still has, and
// the machine's dead time, servo and acceleration.
[[nodiscard]] double rest_bound(const Fault& fault, const Reaction& of, const models::Setup& setup);  // ms
[[nodiscard]] double way_bound(const Fault& fault, const Reaction& of, const models::Setup& setup);   // m
// What of it does not hold; empty: all does.
[[nodiscard]] std::string wrong_with(const Fault& fault, Mode mode, const Reaction& of,
                                     const models::Setup& setup);

// A short press of the tennis ball on the rig `fakes`, with the times of silence that ship for real devices.
struct ShortPress {
  models::Setup datagrams, stream;  // as tool data come
  explicit ShortPress(const std::string& models);
  [[nodiscard]] const models::Setup& of(const Fault& fault) const {
    return fault.streams ? stream : datagrams;
  }
};
// Injects it in that mode, at a moment of it by the seed.
[[nodiscard]] Reaction react(const models::Setup& setup, const Fault& fault, Mode mode, std::uint64_t seed);
// The same, and nothing happens: how far it would have gone.
[[nodiscard]] const Fault& no_fault();

}  // namespace enc::bench::wires
