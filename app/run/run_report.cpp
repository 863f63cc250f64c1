#include "app/run/run_report.h"

#include <algorithm>
#include <cmath>

#include <encounter_version.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/built.h"
#include "app/process.h"
#include "app/run/percentiles.h"
#include "app/stability_text.h"
#include "core/base/words.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;

std::string modes_line(const trial::TrialResult& result) {
  std::string text;
  for (int i = 0; i < kModes; ++i) {
    const double time = result.mode_time[static_cast<std::size_t>(i)];
    if (time > 0.0)
      text += fmt::format("{}{} {:.2f} s", text.empty() ? "" : ", ", mode_name(static_cast<Mode>(i)), time);
  }
  return text;
}

// The inputs that repeat this run and its report.
std::string made_line(const RunReport& r) {
  const bool wall = r.result.keeps_wall_time;
  std::string text =
      fmt::format("made by     {}, {} {}: {}, rig {}, seed {}", trial::program_words(),
                  wall ? "started" : "on", wall ? trial::time_text(r.begun) : trial::day_text(r.begun),
                  r.setup.scene_path, r.setup.rig_path, r.asked.seed);
  if (!r.asked.hand.empty()) text += ", --hand " + r.asked.hand;
  if (r.steered && r.asked.hand.empty()) text += ", steered by hand";
  if (r.asked.armed) text += ", --armed";
  if (r.asked.lockstep) text += ", --lockstep";
  if (r.asked.seconds) text += fmt::format(", --for-s {}", *r.asked.seconds);
  for (const std::string& set : r.asked.set) text += ", --set " + set;
  return models::printable(text) + "\n";
}

// Prints the first three holds, and the number of further ones.
std::string hold_lines(const trial::TrialResult& result) {
  constexpr std::size_t kShown = 3;
  std::string text;
  const std::size_t shown = std::min(kShown, result.holds.size());
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("hold        at {:.3f} s: {}\n", seconds(result.holds[i].first.time_since_epoch()),
                        why_text(result.holds[i].second));
  const std::int64_t more = result.times_held - static_cast<std::int64_t>(shown);
  if (more <= 0) return text;
  return text + fmt::format("hold        and {} more; {:.3f} s in all\n", counted(more, "time"),
                            result.mode_time[static_cast<std::size_t>(Mode::hold)]);
}

// Only a run that keeps the wall clock has these lines.
std::string loop_line(const trial::TrialResult& result) {
  std::string text;
  if (!result.real_time.empty()) text += "real time   " + result.real_time + "\n";
  if (result.period_ns.empty()) return text;
  return text + fmt::format("loop        from tick to tick {} ms\n",
                            text_of(percentiles_of(result.period_ns), 1e-6, 3, 3));
}

std::string late_line(const trial::TrialResult& result) {
  if (result.missed > 0)
    return fmt::format("late        cycles lost to the wall clock: {}; stalls: {}, the longest {:.3f} s\n",
                       result.missed, result.lateness.times, result.lateness.longest);
  if (result.lateness.times == 0) return "";
  return fmt::format("late        {:.3f} s behind the wall clock; stalls: {}; nothing was lost\n",
                     result.lateness.total, result.lateness.times);
}

// Rates and jitter of the two loops. The haptic loop's are by the wall clock, if the run keeps it.
std::string vision_lines(const trial::TrialResult& result) {
  const trial::FrameTimes& vision = result.vision;
  if (vision.frames == 0) return "";
  if (vision.intervals.empty()) return "vision      1 frame: too few for a rate\n";
  const auto ms = [](const std::vector<double>& s) { return text_of(percentiles_of(s), 1e3, 1, 1); };
  return fmt::format("vision      {:.2f} frames/s {}; from frame to frame {} ms; old when told {} ms\n",
                     vision.rate(), vision.threaded ? "in a thread of its own" : "within the loop",
                     ms(vision.intervals), ms(vision.ages));
}

// ---- JSON, which has null for NaN

Json rows_json(const std::vector<certificate::Row>& rows) {
  Json all = Json::array();
  for (const certificate::Row& row : rows)
    all.push_back({{"name", row.name},
                   {"from_N_per_m", row.low},
                   {"to_N_per_m", row.bound},
                   {"from_is", word_of(row.side)},
                   {"margin", row.margin},
                   {"applies", row.applies}});
  return all;
}

Json stability_json(const std::vector<trial::ObjectCertificate>& certificates) {
  Json all = Json::array();
  for (const trial::ObjectCertificate& one : certificates) {
    const certificate::Certificate& of = one.certificate;
    Json json{{"object", one.object},
              {"class", word_of(of.verdict)},
              {"beyond", one.beyond()},
              {"asked_N_per_m", one.asked},
              {"rows", rows_json(of.rows)}};
    if (one.unknown()) json["missing"] = of.missing;
    if (one.place.finite())
      json["place_mm"] = {one.place.xyz[0] * 1e3, one.place.xyz[1] * 1e3, one.place.xyz[2] * 1e3};
    if (!one.like.empty()) json["bounds_of"] = one.like;
    if (std::isnan(one.ramp)) {
      json["let_go_0.1_mm"] = word_of(of.small.rest);
      json["let_go_1_mm"] = word_of(of.large.rest);
    } else {
      json["swings_mm"] = one.swing * 1e3;
    }
    all.push_back(std::move(json));
  }
  return all;
}

// A percentile with too few values is null.
template <class T>
Json times_json(const std::vector<T>& times, double scale) {
  const Percentiles of = percentiles_of(times);
  return {{"p50", of.p50 * scale},
          {"p99", of.p99 * scale},
          {"p99_9", of.p99_9 * scale},
          {"max", of.most * scale}};
}

Json vision_json(const trial::FrameTimes& vision) {
  return {{"threaded", vision.threaded},
          {"frames", vision.frames},
          {"rate_hz", vision.rate()},
          {"interval_ms", times_json(vision.intervals, 1e3)},
          {"age_ms", times_json(vision.ages, 1e3)}};
}

// The run's inputs: program, scene, rig and options.
void add_origin(Json& json, const RunReport& r) {
  json["encounter"] = ENCOUNTER_VERSION;
  json["commit"] = trial::built_commit().name;
  json["commit_date"] = trial::built_commit().day;
  json["date"] = trial::day_text(r.begun);
  if (r.result.keeps_wall_time) json["started"] = trial::time_text(r.begun);
  json["scene"] = r.setup.scene_path;
  json["rig"] = r.setup.rig_path;
  json["seed"] = r.asked.seed;
  json["set"] = r.asked.set;
  json["for_s"] = r.asked.seconds ? Json(*r.asked.seconds) : Json(nullptr);
  json["title"] = r.setup.scene.title;
}

// The parts built, and the course of the run.
void add_course(Json& json, const RunReport& r) {
  json["built"] = Json::object();
  json["left_out"] = Json::object();
  for (const Part& part : parts_of(r.setup)) json[part.built ? "built" : "left_out"][part.name] = part.what;
  for (const trial::DeviceWords& device : r.result.devices) json["devices"][device.role] = device.words;
  for (int i = 0; i < kModes; ++i)
    json["modes_s"][std::string(mode_name(static_cast<Mode>(i)))] =
        r.result.mode_time[static_cast<std::size_t>(i)];
  json["contacts"] = r.result.contacts;
  json["holds"] = Json::array();
  for (const auto& [t, why] : r.result.holds)
    json["holds"].push_back({{"time_s", seconds(t.time_since_epoch())}, {"why", why_text(why)}});
  for (const trial::LostLink& link : r.result.links)
    json["lost_links"].push_back(
        {{"role", link.role}, {"time_s", seconds(link.t.time_since_epoch())}, {"by_hand", link.by_hand}});
  if (!r.result.log.empty()) json["log"] = r.result.log;
}

// The run's computing time, and its certificates.
void add_cost(Json& json, const RunReport& r) {
  json["step_ns"] = times_json(r.result.step_ns, 1.0);
  if (!r.result.period_ns.empty()) json["period_ns"] = times_json(r.result.period_ns, 1.0);
  if (r.result.vision.frames > 0) json["vision"] = vision_json(r.result.vision);
  json["stability"] = stability_json(r.certificates);
  if (!r.measured.felt.truth) {
    json["felt_peak_N"] = r.measured.felt.peak;
    json["felt_depth_mm"] = 1e3 * r.measured.felt.deepest;
  }
  if (!r.result.real_time.empty()) json["real_time"] = r.result.real_time;
  json["simulated_s"] = r.result.simulated;
  json["wall_s"] = r.result.wall;
  json["times_real_time"] = r.result.simulated / r.result.wall;
  json["withheld_commands"] = r.result.withheld;
  json["missed_cycles"] = r.result.missed;
  json["late_s"] = r.result.lateness.total;
  json["limits_crossed"] = r.crossed;
  json["stopped"] = r.result.interrupted;
  json["ticks"] = r.result.ticks;
  json["diverged_at_tick"] = r.result.diverged_at;
  json["started_cpu_ms"] = r.started * 1e3;
  json["peak_memory_MiB"] = peak_memory_mb();
  json["threads"] = thread_count();
  json["mujoco_elements"] = r.elements;
  json["mujoco_steps"] = r.steps;
  json["unsolved_steps"] = r.unsolved;
  json["libraries"] = mapped_libraries();
  json["state_hash"] = fmt::format("{:016x}", r.result.hash);
}

}  // namespace

std::string speed_text(double simulated, double wall) {
  const double speed = wall > 0.0 ? simulated / wall : 0.0;
  return speed < 10.0 ? fmt::format("{:.2g}", speed) : fmt::format("{:.0f}", speed);
}

std::string last_notice(const trial::TrialResult& result) {
  return "last notice of the core: " + (result.last_why == 0 ? "none" : why_text(result.last_why));
}

std::string run_text(const RunReport& r) {
  std::string text =
      r.setup.scene.title + "\n" + made_line(r) + parts_text(r.setup) + devices_text(r.result.devices);
  text += fmt::format("modes       {}; {}\n", modes_line(r.result), counted(r.result.contacts, "contact"));
  text += hold_lines(r.result);
  if (r.result.withheld > 0)
    text += fmt::format("dry         {} {} withheld from the machine; --armed sends them\n",
                        counted(r.result.withheld, "command"), r.result.withheld == 1 ? "was" : "were");
  for (const trial::LostLink& link : r.result.links)
    text += fmt::format("link        {} {} at {:.3f} s\n", link.role,
                        link.by_hand ? "stopped by hand" : "lost", seconds(link.t.time_since_epoch()));
  for (const std::string& line : r.result.log) text += "log         " + line + "\n";
  text += loop_line(r.result);
  text += late_line(r.result);
  if (r.result.interrupted) text += "stopped     by a signal or by q, before its end\n";
  text += weak_text(r.setup, r.scene);
  text += stability_lines(r.certificates);
  for (const trial::ObjectCertificate& one : r.certificates)
    if (one.beyond()) text += "beyond      " + trial::refusal_text(r.setup, one) + "\n";
  for (const trial::ArmStrength& at : r.strengths)
    if (const std::string beyond = trial::beyond_text(at); !beyond.empty())
      text += "beyond      " + beyond + "\n";
  text += measured_text(r);
  if (r.result.contacts == 0 && r.setup.scene.user && !r.whole)
    text += fmt::format("note        the user has not touched anything yet; {}\n", last_notice(r.result));
  for (const std::string& line : r.crossed) text += "LIMIT       " + line + "\n";
  text += questionnaire_text(r.setup);
  text += vision_lines(r.result);
  text += fmt::format("tick        step() {} us\n", text_of(percentiles_of(r.result.step_ns), 1e-3, 2, 1));
  text += fmt::format(
      "time        {:.2f} s simulated in {:.3f} s: {} x real time; started in {:.0f} ms, {:.0f} MiB\n",
      r.result.simulated, r.result.wall, speed_text(r.result.simulated, r.result.wall), r.started * 1e3,
      peak_memory_mb());
  text += fmt::format("state hash  {:016x} after {}\n", r.result.hash, counted(r.result.ticks, "tick"));
  return text;
}

std::string run_json(const RunReport& r) {
  Json json;
  add_origin(json, r);
  add_course(json, r);
  json.update(measured_json(r));
  add_cost(json, r);
  return json.dump(2) + "\n";
}

}  // namespace enc::app
