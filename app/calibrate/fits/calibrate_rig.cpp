// `encounter calibrate rig RIG`: the poses of a hexapod rig's tracker and force sensor, and the weight on the
// sensor. The machine carries a tool from pose to pose, in the twin or over real devices.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <encounter_version.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/common/words.h"
#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/time.h"
#include "core/base/units.h"
#include "models/files.h"
#include "models/identify/rig/turn.h"
#include "models/schema/wording.h"
#include "models/setup/calibration_files.h"
#include "models/setup/scene_file.h"
#include "trial/identify/rig/machine_calibration.h"
#include "trial/operator/operator.h"
#include "trial/operator/terminal.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;
using models::RigCalibration;
using trial::MachineCalibration;

// The result, in the form of the rig file.
struct CalibrationOutput {
  const models::Setup& setup;
  const MachineCalibration& made;
  RigCalibration file;
};

std::string today() {
  const auto day = std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now());
  const std::chrono::year_month_day date{day};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

RigCalibration file_of(const models::Setup& setup, const MachineCalibration& made) {
  RigCalibration file{setup.rig.title, today(), models::identity_of(setup.rig), {}, {}, {}};
  if (made.hand_eye) file.W_C = PoseSpec{made.hand_eye->X_WC.p(), angles_xyz(Quat(made.hand_eye->X_WC.q()))};
  if (made.weight) {
    file.H_F = angles_xyz(made.weight->R_HF);
    file.mass = made.weight->mass.value - made.tool_mass;
  }
  return file;
}

// Number of decimals that shows two significant digits of the interval.
int digits_of(double half) {
  if (!(half > 0.0) || !std::isfinite(half)) return 4;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 4);
}
std::string with(double value, double half) {
  const int digits = digits_of(half);
  return fmt::format("{:.{}f} +- {:.{}f}", value, digits, half, digits);
}
std::string list(const Vec3& v, int digits) {
  return fmt::format("[{:.{}f}, {:.{}f}, {:.{}f}]", v.x(), digits, v.y(), digits, v.z(), digits);
}
std::string with(const Vec3& value, const Vec3& half) {
  const int digits = digits_of(half.minCoeff());
  return list(value, digits) + " +- " + list(half, digits);
}

// Angle between the result and the rig file's orientation, about the parent's axes, deg.
double turned(const Quat& found, const Vec3& believed) {
  return found.angularDistance(rotation_xyz(believed)) * kDegPerRad;
}

std::string weight_text(const CalibrationOutput& found) {
  const models::WeightFit& fit = *found.made.weight;
  const RigSpec& rig = found.setup.rig;
  return fmt::format(
      "force       mass_kg = {}, without the tool's {:g} kg; the rig believes {:g}\n"
      "            sensor turned by [{}] deg about x, then y, then z of H, known to {} deg about its own "
      "axes; that is {:.2f} deg from what the rig believes\n"
      "            zero {} N at the end; it walks by {:.4f} N in a second\n"
      "            middle of the weight at {} mm in F; {:.4f} N rms left over, {:.4f} at most\n",
      with(*found.file.mass, fit.mass.half), found.made.tool_mass, rig.force.mass,
      fmt::format("{:.3f}, {:.3f}, {:.3f}", kDegPerRad * found.file.H_F->x(),
                  kDegPerRad * found.file.H_F->y(), kDegPerRad * found.file.H_F->z()),
      list(kDegPerRad * fit.turn_half, digits_of(kDegPerRad * fit.turn_half.minCoeff())),
      turned(fit.R_HF, rig.frames.H_F.rotation), with(fit.zero.value, fit.zero.half), fit.walk,
      list(kMmPerM * fit.middle.e(), 1), fit.rms, fit.most);
}

std::string tracker_text(const CalibrationOutput& found) {
  const models::HandEyeFit& fit = *found.made.hand_eye;
  const RigSpec& rig = found.setup.rig;
  const PoseSpec& W_C = *found.file.W_C;
  std::string text = fmt::format(
      "tracker     position_mm = {} of C in W; {:.3f} mm from what the rig believes\n"
      "            rotation_deg = {} about x, then y, then z of W, known to {} deg about W's axes; {:.3f} "
      "deg from "
      "what the rig believes\n"
      "            so that what is seen at W's origin is known to {} mm\n"
      "            {:.4f} mm and {:.4f} deg rms left over, {:.4f} mm at most\n",
      with(kMmPerM * W_C.position, kMmPerM * fit.place_half),
      kMmPerM * (W_C.position - rig.frames.W_C.position).norm(),
      list(kDegPerRad * W_C.rotation, digits_of(kDegPerRad * fit.turn_half.minCoeff())),
      list(kDegPerRad * fit.turn_half, digits_of(kDegPerRad * fit.turn_half.minCoeff())),
      turned(Quat(fit.X_WC.q()), rig.frames.W_C.rotation),
      list(kMmPerM * fit.origin_half, digits_of(kMmPerM * fit.origin_half.minCoeff())), kMmPerM * fit.rms,
      kDegPerRad * fit.rms_turn, kMmPerM * fit.most);
  const ToolSpec& tool = found.setup.scene.tools[static_cast<std::size_t>(found.made.clamped_tool)];
  return text + fmt::format(
                    "tool        tip_mm = {} of {} in T, if it stands at the haptic-tip's middle; the "
                    "scene has {}\n",
                    with(kMmPerM * fit.tip.value, kMmPerM * fit.tip.half), tool.name,
                    list(kMmPerM * tool.tip, 3));
}

std::string found_text(const CalibrationOutput& found) {
  const MachineCalibration& made = found.made;
  std::string text =
      fmt::format("{} poses in {:.1f} s of experiment{}\n", made.stands.size(), made.time,
                  made.unseen > 0 ? fmt::format("; the tracker did not see {} of them", made.unseen) : "");
  if (made.weight) text += weight_text(found);
  if (made.hand_eye) text += tracker_text(found);
  return text +
         "note        weight is taken for straight down in W: see that the machine's base is level\n"
         "note        a constant error of the tracker's places is in its position, so that it sees the tip "
         "where the machine has it\n"
         "intervals   99 % for each number\n";
}

Json list_of(const Vec3& v, double unit) { return {v.x() * unit, v.y() * unit, v.z() * unit}; }

Json found_json(const CalibrationOutput& found) {
  const MachineCalibration& made = found.made;
  Json json;
  json["poses"] = made.stands.size();
  json["time_s"] = made.time;
  json["unseen"] = made.unseen;
  json["date"] = found.file.date;
  if (made.weight) {
    const models::WeightFit& fit = *made.weight;
    json["force"] = {{"mass_kg", *found.file.mass},
                     {"mass_half_kg", fit.mass.half},
                     {"tool_mass_kg", made.tool_mass},
                     {"zero_N", list_of(fit.zero.value, 1.0)},
                     {"zero_half_N", list_of(fit.zero.half, 1.0)},
                     {"rotation_deg", list_of(*found.file.H_F, kDegPerRad)},
                     {"turn_half_deg", list_of(fit.turn_half, kDegPerRad)},
                     {"middle_mm", list_of(fit.middle.e(), kMmPerM)},
                     {"walk_N_per_sqrt_s", fit.walk},
                     {"residual_rms_N", fit.rms},
                     {"residual_max_N", fit.most}};
  }
  if (made.hand_eye) {
    const models::HandEyeFit& fit = *made.hand_eye;
    json["tracker"] = {{"position_mm", list_of(found.file.W_C->position, kMmPerM)},
                       {"position_half_mm", list_of(fit.place_half, kMmPerM)},
                       {"rotation_deg", list_of(found.file.W_C->rotation, kDegPerRad)},
                       {"turn_half_deg", list_of(fit.turn_half, kDegPerRad)},
                       {"origin_half_mm", list_of(fit.origin_half, kMmPerM)},
                       {"residual_rms_mm", kMmPerM * fit.rms},
                       {"residual_rms_deg", kDegPerRad * fit.rms_turn},
                       {"residual_max_mm", kMmPerM * fit.most},
                       {"tip_mm", list_of(fit.tip.value, kMmPerM)},
                       {"tip_half_mm", list_of(fit.tip.half, kMmPerM)}};
  }
  return json;
}

// Only the force sensor detects a person in the way of the machine.
void refuse_unwatched(const models::Setup& setup, const RigOptions& options) {
  const std::string &force = setup.rig.force.driver, &tracker = setup.rig.tracker.driver;
  if (force == "none" && tracker == "none")
    throw Error(
        fmt::format("{}: this rig has neither a force sensor nor a tracker; expected one that is to be "
                    "calibrated; name its driver",
                    models::place_of(setup, "rig.force.driver")));
  if (trial::slots_of(setup).machine && !options.lockstep && (force == "none" || force == "sim"))
    throw Error(fmt::format(
        "{}: a machine that moves for minutes needs a force sensor that feels what is in its way; expected a "
        "real one, and here it is {}; connect it and name its driver",
        models::place_of(setup, "rig.force.driver"), models::quoted(force)));
}

// Lockstep runs have only fakes, so no question is needed.
bool asks(const models::Setup& setup, const RigOptions& options) {
  return options.armed && !options.lockstep && trial::moves_device(setup);
}

models::Setup setup_for(const RigOptions& options) {
  const std::string scene =
      options.scene.empty() ? models::models_dir() + "/scenes/clamped_tool.toml" : options.scene;
  // Ignore an earlier calibration, because it may be the error.
  std::vector<std::string> set = options.set;
  set.emplace_back("rig.calibration.file=\"\"");
  models::Setup setup = models::load(scene, options.rig, set);
  if (trial::slots_of(setup).machine && !options.armed)
    throw Error(
        fmt::format("{}: a machine that is not armed does not move, and only a machine that moves can be "
                    "calibrated; expected --armed; clear its way, clamp the tool and add it",
                    models::place_of(setup, "rig.manipulator.driver")));
  refuse_unwatched(setup, options);
  if (asks(setup, options) && !options.yes) trial::refuse_unasked();
  return setup;
}

trial::TrialOptions trial_options(const RigOptions& options, const trial::DriverSource& modules) {
  trial::TrialOptions how;
  how.seed = options.seed.value_or(1);
  how.drivers = modules;
  how.armed = options.armed;
  how.lockstep = options.lockstep;
  how.calibrates = true;
  how.real_time = true;
  how.needs_real_time = !options.not_real_time;
  how.stop = options.stop;
  return how;
}

// Ends the run in every case: stops all motion, then prints the devices' messages, with the reason for a lost
// link.
void end(std::optional<trial::CarriedTool>& tool) {
  std::vector<std::string> lines = tool->trial().said();
  if (const std::string& words = tool->trial().result().real_time; !words.empty())
    lines.push_back("real time   " + words);
  tool.reset();
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r        \r");
  for (const std::string& line : lines) fmt::print(stderr, "{}\n", models::printable(line));
}

// Thrown if the person does not let the machine move.
struct StartRefusal {};

// The question before the first motion; empty: no real machine moves.
std::string question_for(const trial::Trial& trial, const RigOptions& options) {
  if (!asks(trial.setup(), options)) return {};
  return trial::motion_question(trial.setup(), trial.scene(), trial.result().devices);
}

MachineCalibration made_with(const models::Setup& setup, const RigOptions& options,
                             const trial::DriverSource& modules) {
  const trial::StandardError error;  // a moving machine does not wait for a terminal
  const auto progress = [&error](double share) {
    if (error.terminal()) error.write(fmt::format("\r{:3.0f} %", 100.0 * share));
  };
  std::optional<trial::CarriedTool> tool;
  tool.emplace(setup, trial_options(options, modules));
  if (options.confirm && !options.confirm(question_for(tool->trial(), options))) throw StartRefusal();
  try {
    MachineCalibration made =
        trial::calibrate_machine(*tool, options.poses.value_or(trial::kUsualPoses), progress);
    end(tool);
    return made;
  } catch (...) {
    if (tool) end(tool);
    throw;
  }
}

// Refuses what is no rig with a hexapod.
void refuse_other(const RigOptions& options) {
  if (!is_rig(options.rig))
    throw Error(fmt::format("{}: is no rig; expected a name in models/rigs or a TOML file; see to its name",
                            options.rig));
  if (models::load_rig(options.rig).arm.driver != "none")
    throw Error(
        fmt::format("{}: has an arm; expected a rig with a hexapod that carries a tool; run: encounter "
                    "calibrate camera {}",
                    options.rig, shell_word(options.rig)));
}

// The head of the written file: the command that made it, and the printed result.
std::string remarks_for(const RigOptions& options, const models::Setup& setup, const std::string& text) {
  std::string remarks =
      fmt::format("# Encounter {}: encounter calibrate rig {}{}{} --scene {} --seed {}", ENCOUNTER_VERSION,
                  options.rig, options.armed ? " --armed" : "", options.lockstep ? " --lockstep" : "",
                  setup.scene_path, options.seed.value_or(1));
  for (const std::string& set : options.set) remarks += " --set " + set;
  remarks = models::printable(remarks) + "\n";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    remarks += "# " + text.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return remarks;
}

}  // namespace

int calibrate_rig(const RigOptions& options, const trial::DriverSource& modules) {
  refuse_other(options);
  const models::Setup setup = setup_for(options);
  std::optional<models::OutFile> file;  // refuse it before anything moves
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  if (options.catch_signals) options.catch_signals();
  MachineCalibration made;
  try {
    made = made_with(setup, options, modules);
  } catch (const StartRefusal&) {
    fmt::print(stderr, "\nencounter: not begun; nothing has moved\n");
    return 2;  // a signal sets its own exit code
  } catch (const trial::MotionInterrupt&) {
    if (!options.stop || !options.stop())
      throw Error("the devices ended the run; nothing was written; see `encounter devices`", {},
                  ErrorKind::device);
    fmt::print(stderr, "stopped by hand: the machine stands, and nothing was written\n");
    return 4;  // a signal sets its own exit code
  }
  const CalibrationOutput found{setup, made, file_of(setup, made)};
  const std::string text = found_text(found);
  fmt::print("{}", options.json ? found_json(found).dump(2) + "\n" : text);
  std::fflush(stdout);  // before writing the file, which may fail
  if (options.stop && options.stop()) {
    fmt::print(stderr, "stopped by hand: nothing was written\n");
    return 4;
  }
  if (file) {
    file->write(remarks_for(options, setup, text) + "\n" + models::rig_calibration_text(found.file));
    file->keep();
  }
  return 0;
}

}  // namespace enc::app
