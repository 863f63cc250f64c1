#include "trial/identify/shadow/shadow.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/words.h"
#include "trial/assemble/assemble.h"
#include "trial/identify/shadow/channels.h"

namespace enc::trial {
namespace {

// Share of a bound that a 95 % interval may fill. With normal errors 1 % are then beyond the bound.
constexpr double kTold = 0.75;

bool known_to(const models::Interval& off, double bound) { return off.known() && off.half <= kTold * bound; }

// Limits the length, because the twin runs from time 0 to the last tick, however few ticks the record holds.
void check_length(const Tape& tape, std::int64_t ticks, const std::string& path) {
  constexpr std::int64_t kLost = 100'000;  // allowed lost cycles, in addition to the number of ticks
  const std::int64_t most = 2 * ticks + kLost;
  if (tape.last < most && in_seconds(tape.begin) <= static_cast<double>(most) * tape.scene.dt) return;
  throw Error(
      fmt::format("{}: begins at {:g} s and ends with cycle {}, but holds {} ticks; expected at most as many "
                  "lost cycles, and {}; record it again",
                  path, in_seconds(tape.begin), tape.last, ticks, kLost));
}

}  // namespace

bool Divergence::diverges() const {
  if (!off.known() || !(std::abs(off.value) > bound)) return false;
  return known_to(off, bound) || std::abs(off.value) - off.half > bound;
}

bool Divergence::vague() const { return !known_to(off, bound) && !diverges(); }

bool Shadow::diverges() const {
  return !gross.empty() ||
         std::any_of(found.begin(), found.end(), [](const Divergence& one) { return one.diverges(); });
}

models::Setup twin_of(const RecordReader& record, const std::string& path,
                      const std::vector<std::string>& overrides) {
  models::Setup twin = models::setup_of(record.texts(), path);
  if (overrides.empty()) return twin;
  const double rate = twin.rig.loop.rate;
  for (const std::string& text : overrides) models::set(twin, text);
  if (twin.rig.loop.rate != rate)
    throw Error(
        fmt::format("--set rig.loop.rate_hz: the ticks of {} are those of {:g} Hz; expected the rate that it "
                    "was recorded with; leave it out",
                    path, rate));
  models::check(twin);
  models::note_unread(twin);
  models::fill_curves(twin, models::models_dir());
  models::check(twin);
  models::round_to_text(twin);
  return twin;
}

Shadow shadow(RecordReader& record, const std::string& path, const models::Setup& twin) {
  if (record.ticks() == 0)
    throw Error(fmt::format("{}: holds no whole tick; expected a record of a run; record it again", path));
  const Scene scene = prepare_setup(twin);
  if (record.layout() != layout_hash(scene))
    throw Error(
        fmt::format("{}: is of another version, whose frames have other fields; expected a record of "
                    "this one; use the version that wrote it",
                    path));
  Shadow result;
  if (!twin.scene.manipulator)
    throw Error(
        fmt::format("{}: is of a scene without [manipulator]; expected a machine that is sent to "
                    "places, whose twin shadow mode has; record a run of another scene",
                    path));
  const Tape tape(record, twin, scene);
  result.ticks = record.ticks();
  result.seconds = tape.seconds();
  check_length(tape, result.ticks, path);
  if (tape.tip.empty())
    throw Error(
        fmt::format("{}: its machine never said where it was; expected a record of a machine that "
                    "answers; see `encounter devices`",
                    path));
  try {
    for (const auto see : {see_machine, see_tool, see_probed, see_rendered, see_sensor}) see(tape, result);
  } catch (const Error& e) {  // a number that no plant accepts
    if (e.key().empty()) throw;
    throw Error(models::place_of(twin, e.key()) + ": " + e.what());
  }
  if (tape.missed > 0)
    result.facts.push_back({Channel::clock, fmt::format("{} {} lost", counted(tape.missed, "cycle"),
                                                        tape.missed == 1 ? "was" : "were")});
  return result;
}

// ---- channels.h ------------------------------------------------------------------------------------------

models::Interval of_twins(const std::vector<double>& values) {
  double sum = 0.0, n = 0.0, squares = 0.0;
  for (const double x : values)
    if (std::isfinite(x)) sum += x, ++n;
  if (n < 3.0) return {};
  for (const double x : values)
    if (std::isfinite(x)) squares += std::pow(x - sum / n, 2);
  const double scatter = std::sqrt(squares / (n - 1.0) * (1.0 + 1.0 / n));
  return {sum / n, models::student(n - 1.0) * scatter};
}

models::Interval beside_twins(const models::Interval& recorded, const std::vector<double>& values) {
  const models::Interval twins = of_twins(values);
  return {recorded.value - twins.value, std::hypot(recorded.half, twins.half)};
}

void add(Shadow& shadow, Channel channel, Quantity quantity, const models::Interval& off, double bound,
         const std::string& axis) {
  shadow.found.push_back({channel, quantity, axis, off, bound});
}

void diverges_grossly(Shadow& shadow, Channel channel, std::string how) {
  shadow.gross.push_back({channel, std::move(how)});
}

void cannot_judge(Shadow& shadow, Channel channel, std::string why) {
  shadow.unjudged.push_back({channel, std::move(why)});
}

}  // namespace enc::trial
