#include "trial/steered/steering.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/record/record.h"
#include "models/tables/csv_reader.h"

namespace enc::trial {

void Faults::apply(Inputs& in) {
  if (in.tool.health != Health::absent && in.tool.t != tool_.t) {  // else the core already has it
    if (in.tool.t != read_) ++samples_;
    read_ = in.tool.t;
    const bool told = tool_.health != Health::absent;
    const bool lost = (bits_ & kFrozenTracker) != 0 || ((bits_ & kDroppedPackets) != 0 && samples_ % 4 != 0);
    if (lost && told)
      in.tool = tool_;
    else if ((bits_ & kLateClock) != 0)
      in.tool.t -= from_seconds(kLate);
    tool_ = in.tool;
  }
  if ((bits_ & kSaturated) == 0 || in.wrench.health != Health::ok) return;
  for (double& one : in.wrench.value.force.xyz) {
    if (std::abs(one) <= kRange) continue;
    one = std::clamp(one, -kRange, kRange);
    in.wrench.health = Health::saturated;
  }
}

std::optional<HandWord> SteeringLog::at(std::int64_t tick) {
  std::optional<HandWord> all;
  for (; next_ < steps_.size() && steps_[next_].tick <= tick; ++next_) {
    const HandWord& word = steps_[next_].word;
    if (!all) all.emplace();
    if (word.place) all->place = word.place;
    all->changes_tool = all->changes_tool || word.changes_tool;
    all->faults = word.faults;
  }
  return all;
}

std::string SteeringLog::text() const {
  std::string text = "tick,steered,x_m,y_m,z_m,changes_tool,faults\n";
  for (const Step& step : steps_) {
    const Point<'W'> place = step.word.place.value_or(Point<'W'>(0, 0, 0));
    text += fmt::format("{},{},{},{},{},{},{}\n", step.tick, step.word.place ? 1 : 0, place.xyz[0],
                        place.xyz[1], place.xyz[2], step.word.changes_tool ? 1 : 0, step.word.faults);
  }
  return text;
}

SteeringLog SteeringLog::read(const std::string& text, const std::string& record) {
  constexpr double kMostTicks = 1e12, kFarthest = 10.0;  // ticks; m
  models::CsvReader rows(text, record + " (hand)");
  rows.header({"tick", "steered", "x_m", "y_m", "z_m", "changes_tool", "faults"});
  const auto whole = [&](std::size_t column, double most, const char* what) {
    const double number = rows.number(column);
    if (!(number >= 0.0 && number <= most && number == std::floor(number)))
      rows.fail(column, std::string(what) + "; record the run again");
    return number;
  };
  SteeringLog log;
  while (rows.next()) {
    const double tick = whole(0, kMostTicks, "a tick is a whole number");
    if (!log.empty() && tick < static_cast<double>(log.steps_.back().tick))
      rows.fail(0, "a tick is not below the one before; record the run again");
    HandWord word;
    const bool steered = whole(1, 1, "steered is 0 or 1") == 1.0;
    const Vec3 place(rows.number(2), rows.number(3), rows.number(4));
    if (!(place.cwiseAbs().maxCoeff() <= kFarthest))
      rows.fail(2, "a hand is within 10 m of the origin of W; record the run again");
    if (steered) word.place = Point<'W'>(place);
    word.changes_tool = whole(5, 1, "changes_tool is 0 or 1") == 1.0;
    word.faults = static_cast<std::uint8_t>(whole(6, 15, "faults are a number from 0 to 15"));
    log.add(static_cast<std::int64_t>(tick), word);
  }
  return log;
}

SteeredRun steered_run(const std::string& record) {
  RecordReader reader(record);
  const auto hand = reader.end_texts().find("hand");
  if (hand == reader.end_texts().end())
    throw Error(record +
                ": nobody steered the hand in this record; expected one of `encounter view SCENE --record "
                "FILE`; leave --hand out, and the scene's own hand moves");
  SteeredRun run;
  run.log = SteeringLog::read(hand->second, record);
  RecordedTick tick;
  Time first{}, last{};
  for (bool any = false; reader.next(tick); any = true) {
    if (!any) first = tick.tick.t;
    last = tick.tick.t;
    run.period = seconds(tick.tick.dt);
  }
  const auto seed = reader.texts().find("seed");
  run.seed = seed == reader.texts().end() ? "" : seed->second;
  run.duration = seconds(last - first);
  return run;
}

}  // namespace enc::trial
