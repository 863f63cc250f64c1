#include "trial/steered/steering_log.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/record/record.h"
#include "models/csv_reader.h"

namespace enc::trial {

std::optional<Point<'W'>> SteeringLog::at(std::int64_t tick) {
  std::optional<Point<'W'>> place;
  for (; next_ < steps_.size() && steps_[next_].tick <= tick; ++next_) place = steps_[next_].place;
  return place;
}

std::string SteeringLog::text() const {
  std::string text = "tick,x_m,y_m,z_m\n";
  for (const Step& step : steps_)
    text += fmt::format("{},{},{},{}\n", step.tick, step.place.xyz[0], step.place.xyz[1], step.place.xyz[2]);
  return text;
}

SteeringLog SteeringLog::read(const std::string& text, const std::string& record) {
  constexpr double kMostTicks = 1e12, kFarthest = 10.0;  // m
  models::CsvReader rows(text, record + " (hand)");
  rows.header({"tick", "x_m", "y_m", "z_m"});
  SteeringLog log;
  while (rows.next()) {
    const double tick = rows.number(0);
    const Vec3 place(rows.number(1), rows.number(2), rows.number(3));
    const bool after = log.empty() || tick >= static_cast<double>(log.steps_.back().tick);
    if (!(after && tick >= 0.0 && tick <= kMostTicks && tick == std::floor(tick)))
      rows.fail(0, "a tick is a whole number, not below the one before; record the run again");
    if (!(place.cwiseAbs().maxCoeff() <= kFarthest))
      rows.fail(1, "a hand is within 10 m of the origin of W; record the run again");
    log.add(static_cast<std::int64_t>(tick), Point<'W'>(place));
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
