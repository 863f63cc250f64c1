#include "app/check/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <encounter_version.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "app/built.h"
#include "app/common/options.h"
#include "app/common/words.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "app/stability_text.h"
#include "core/base/error.h"
#include "core/base/words.h"
#include "core/control/scene/press_check.h"
#include "core/control/scene/scene.h"
#include "core/control/scene/steadiness.h"
#include "models/schema/wording.h"
#include "models/setup/scene_sizes.h"
#include "trial/assemble/assemble.h"
#include "trial/certificates.h"
#include "trial/precision/precision.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

// ---- frames

std::string in_mm(const Vec3& p) {
  const auto rounded = [](double metres) { return std::round(metres * 1e6) * 1e-3 + 0.0; };  // avoids -0
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}] mm", rounded(p.x()), rounded(p.y()), rounded(p.z()));
}
std::string constant(const char* name, const Vec3& p, const std::string& what) {
  return fmt::format("  X_{}  constant  {}  {}\n", name, in_mm(p), what);
}
std::string variable(const char* name, const char* what) {
  return fmt::format("  X_{}  variable  {}\n", name, what);
}

std::string object_frames(const models::Setup& setup, const Scene& scene) {
  constexpr std::size_t kMost = 4;  // lines
  const std::size_t count = scene.objects.size(), shown = count > kMost ? 1 : count;
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const std::string more = shown < count ? fmt::format(", and of {} more", count - shown) : "";
    text += constant("WO", scene.objects[i].X_WO.p(),
                     fmt::format("object '{}'{}", setup.scene.objects[i].name, more));
  }
  return text;
}

// The edges of [VHMR Fig 4] in this scene.
std::string frames_text(const models::Setup& setup, const Scene& scene) {
  const SceneSpec& s = setup.scene;
  const FramesRig& rig = setup.rig.frames;
  std::string text = constant("WR", scene.X_WR.p(), "machine base; H is W at the machine's zero") +
                     variable("RH", words_of(s).tip);
  if (s.force) text += constant("HF", rig.H_F.position, "force sensor");
  if (s.tracker)
    text += constant("WC", rig.W_C.position, "tracker camera") + variable("CT", words_of(s).tracked);
  if (s.display)
    text += constant("WS", rig.W_S.position, "headset server") + variable("SG", "headset") +
            constant("GL", rig.G_L.position, "hand tracker on the headset");
  text += object_frames(setup, scene);
  if (!s.objects.empty()) text += variable("WN", "nearest surface point, z outward");
  return text + fmt::format("  every chain closes to {:.1e} m\n", chain_residual(s, setup.rig, scene));
}

// ---- limits

std::string objects_named(const std::vector<std::string>& names) {
  if (names.size() == 1) return fmt::format("object '{}'", names.front());
  std::vector<std::string> quoted;
  quoted.reserve(names.size());
  for (const std::string& name : names) quoted.push_back("'" + name + "'");
  return "objects " + listed(quoted);
}

std::string lines_of(const Statements& said) {
  std::string text;
  for (const SharedStatement& group : grouped(said))
    text += fmt::format("  {}: {}\n", objects_named(group.names), group.what);
  return text;
}

// Reports thin parts of an object, where the tip does not fit under the surface and waits as near as it can.
std::string thin_text(const Scene& scene, const Object& object) {
  const double margin = room_margin(scene);
  const Room room = room_in(object, margin, true);
  if (room.thin == 0.0) return {};
  const Point<'W'> at = object.X_WO * room.thin_at;
  return fmt::format(
      "{:.2g} % of its surface lies over what is thinner than the haptic-tip and its inset, "
      "{:.1f} mm; thinnest, {:.2f} mm, at ({:.1f}, {:.1f}, {:.1f}) mm; there the tip waits as near as it has "
      "room",
      room.thin * 100.0, 2e3 * margin, room.thinnest * 1e3, at.xyz[0] * 1e3, at.xyz[1] * 1e3,
      at.xyz[2] * 1e3);
}

std::string softest_text(const models::Setup& setup, const Scene& scene) {
  const Steadiness loop(setup.rig);
  const auto softest = [&](double ramp) {
    return std::max(scene.lowest_slope, loop.softest(0.015, 30.0, ramp)) * 1e-3;
  };
  return fmt::format(
      "  softest spring that stands still: {:.3f} N/mm when it is pushed in {:g} s, {:.3f} N/mm in {:g} s\n"
      "  (a hand of {:g} N/mm pushes it up to 15 mm deep or by 30 N)\n",
      softest(Steadiness::kSlow), Steadiness::kSlow, softest(Steadiness::kQuick), Steadiness::kQuick,
      setup.rig.contact.hand_stiffness * 1e-3);
}

std::string hexapod_limits(const models::Setup& setup, const Scene& scene) {
  Statements said;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const std::string& name = setup.scene.objects[i].name;
    const Object& object = scene.objects[i];
    if (std::isnan(object.limit)) {
      said.emplace_back(name, "real, pressed by the machine and not rendered");
      continue;
    }
    said.emplace_back(
        name,
        fmt::format("deflection up to {:g} mm, at most {:.2f} N; softest stable slope {:.3f} N/mm",
                    object.limit * 1e3, object.response.press(object.limit), scene.lowest_slope * 1e-3));
    const std::string thin = thin_text(scene, object);
    if (!thin.empty()) said.emplace_back(name, thin);
  }
  return lines_of(said) + (scene.has_force ? softest_text(setup, scene) : "") + weak_text(setup, scene) +
         fmt::format("  commands up to {:g} mm/s and {:g} mm/s^2\n", scene.reach.speed * 1e3,
                     scene.reach.acceleration * 1e3);
}

std::string strength_text(const trial::ArmStrength& at) {
  std::string text = fmt::format("force at most {:.2f} N, for hours {:.2f} N", at.peak, at.lasting);
  if (!std::isnan(at.asked))
    text +=
        fmt::format("; the user asks for {:.2f} N for {:.1f} s, it can be held {}", at.asked, at.asked_for,
                    std::isinf(at.holds_for) ? "for hours" : fmt::format("for {:.0f} s", at.holds_for));
  return text;
}

// Many objects: only the least of each value, with its object.
std::string least_text(const std::vector<trial::ArmStrength>& strengths) {
  const auto least = [&](double trial::ArmStrength::*of) {
    const auto at = std::min_element(strengths.begin(), strengths.end(),
                                     [&](const auto& a, const auto& b) { return a.*of < b.*of; });
    return fmt::format("{:.2f} N ('{}')", (*at).*of, at->object);
  };
  return fmt::format("  the weakest object: up to {}, for hours {}\n", least(&trial::ArmStrength::peak),
                     least(&trial::ArmStrength::lasting));
}

// One line for each object with a requested depth, or beyond the arm's strength. A few objects all get a
// line.
std::string strengths_text(const std::vector<trial::ArmStrength>& strengths) {
  constexpr std::size_t kMost = 4;
  const bool few = strengths.size() <= kMost;
  Statements said;
  std::string beyond;
  for (const trial::ArmStrength& at : strengths) {
    const std::string too_much = trial::beyond_text(at);
    if (few || !std::isnan(at.asked) || !too_much.empty()) said.emplace_back(at.object, strength_text(at));
    if (!too_much.empty()) beyond += "  BEYOND: " + too_much + "\n";
  }
  return (few ? "" : least_text(strengths)) + lines_of(said) + beyond;
}

// An arm has no deflection limit: its motors limit its force.
std::string arm_limits(const models::Setup& setup, const Scene& scene) {
  const Impedance& law = trial::impedance_of(scene);
  Statements said;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const double stiffness = std::isnan(object.stiffness) ? law.rig.stiffness : object.stiffness;
    said.emplace_back(
        setup.scene.objects[i].name,
        fmt::format("{}, {:g} N/mm when it is touched, {:.3g} times the gain in free space",
                    word_of(object.interaction.kind), stiffness * 1e-3, stiffness / law.rig.stiffness));
  }
  return lines_of(said) + strengths_text(trial::strengths_of(setup, scene)) +
         fmt::format(
             "  law: {:g} N/m, {:g} N s/m, damping ratio {:.2f} for the {:.1f} g that are felt at the tip\n"
             "  pushes with up to {:g} N, for hours {:g} N\n"
             "  target up to {:g} mm/s and {:g} m/s^2\n",
             law.rig.stiffness, law.rig.damping, damping_ratio(law.rig, law.home_mass), law.home_mass * 1e3,
             law.rig.peak, law.rig.continuous, law.rig.speed * 1e3, law.rig.acceleration);
}

constexpr std::array kLimits{hexapod_limits, arm_limits};  // indexed by MachineWords::row

// ---- costs

constexpr double kRun = 0.25;  // s of experiment time

// The parts of the engine that are off because this scene does not need them.
std::string not_looked_for(const mjModel& model) {
  constexpr std::array<std::pair<int, const char*>, 3> kOff{
      {{mjDSBL_CONTACT, "contacts"}, {mjDSBL_CONSTRAINT, "constraints"}, {mjDSBL_ISLAND, "islands"}}};
  std::vector<std::string> off;
  for (const auto& [flag, word] : kOff)
    if ((model.opt.disableflags & flag) != 0) off.emplace_back(word);
  return off.empty() ? "" : fmt::format("; not looked for: {}", fmt::join(off, ", "));
}

std::string physics_text(const sim::Physics& physics) {
  const mjModel& m = *physics.model();
  return fmt::format("  physics   {} MuJoCo elements: {} bodies, {} joints, {} geoms, {} sensors{}\n",
                     physics.elements(), m.nbody, m.njnt, m.ngeom, m.nsensor, not_looked_for(m));
}

bool among(const std::vector<std::string>& libraries, const std::string& part) {
  return std::any_of(libraries.begin(), libraries.end(),
                     [&](const std::string& name) { return name.find(part) != std::string::npos; });
}

// The process as the kernel reports it.
std::string process_text() {
  const std::vector<std::string> libraries = mapped_libraries();
  std::vector<std::string> loaded, left;
  for (const std::string& library : libraries)  // the folder does not matter
    if (const std::string name = module_name(library); !name.empty()) loaded.push_back(name);
  for (const std::string& name : modules_there())
    if (std::find(loaded.begin(), loaded.end(), name) == loaded.end()) left.push_back(name);
  const bool gl = among(libraries, "libGL") || among(libraries, "libEGL") || among(libraries, "libOSMesa");
  const int threads = thread_count();
  return fmt::format(
      "  process   {}, {} libraries, {:.0f} MiB at most so far; OpenGL {}; modules {}; not loaded "
      "{}\n",
      counted(threads, "thread"), libraries.size(), peak_memory_mb(), gl ? "loaded" : "not loaded",
      loaded.empty() ? "none" : fmt::format("{}", fmt::join(loaded, ", ")),
      left.empty() ? "none" : fmt::format("{}", fmt::join(left, ", ")));
}

// Some lines of text. Runs the first quarter of a second of a fully simulated scene. Empty for any other
// scene, because no device may be moved or waited for, and if a camera's modules are not built. `ready` is
// the CPU time of the process so far, s.
std::string costs_text(const models::Setup& setup, std::uint64_t seed, double ready) {
  const trial::Slots slots = trial::slots_of(setup);
  if (slots.real || !slots.simulated)
    return "\ncosts       not measured: not all devices of this rig are simulated\n";
  for (const char* module : {"camera", "vision"})
    if (setup.scene.camera && !module_there(module))
      return fmt::format("\ncosts       not measured: the module {} is not built\n", module);
  trial::TrialOptions options;
  options.seed = seed;
  options.seconds = kRun;
  options.drivers = load_module;
  const double before = cpu_seconds();
  trial::Trial trial(setup, options);
  const double built = cpu_seconds();
  const trial::TrialResult result = trial.run();
  const double tick = (cpu_seconds() - built) / static_cast<double>(result.ticks);
  return fmt::format(
             "\ncosts       ready after {:.0f} ms of CPU time; a tick takes {:.1f} us: {:.3g} x real time "
             "(its first {:g} s)\n",
             (ready + built - before) * 1e3, tick * 1e6, 1.0 / (tick * setup.rig.loop.rate), kRun) +
         physics_text(trial.world().physics()) + process_text();
}

// ---- advice

std::string settings_text(const trial::Precision& all, const trial::PrecisionPoint& point) {
  std::string text;
  for (const std::string& set : all.settings(point)) text += fmt::format(" --set {}", set);
  return text;
}

std::string row(const trial::PrecisionPoint& point) {
  const std::string name = fmt::format("  {:<12} {:>6g} us ", point.integrator, point.step * 1e6);
  if (!point.failure.empty()) return fmt::format("{}  failed: {}\n", name, point.failure);
  return fmt::format("{} {:>7.4f} N {:>8.2f} um {:>7.0f} x real time{}\n", name, point.error, point.way * 1e6,
                     1.0 / point.cpu, point.shipped ? "  as it is" : "");
}

// Joins the requested values: "0.0518 N", "12.30 um", or both.
std::string both(const trial::Accuracy& asked, const std::string& force, const std::string& way) {
  if (std::isnan(asked.way)) return force;
  return std::isnan(asked.force) ? way : force + " and " + way;
}
std::string errs_by(const trial::PrecisionPoint& point, const trial::Accuracy& asked) {
  return both(asked, fmt::format("{:.4f} N", point.error), fmt::format("{:.2f} um", point.way * 1e6));
}
// The range in which another converged run may put the error.
std::string spread_of(const trial::Precision& all, const trial::PrecisionPoint& point,
                      const trial::Accuracy& asked) {
  const trial::Spread force = all.error_spread(point), way = all.way_spread(point);
  return both(asked, fmt::format("{:.4f} to {:.4f} N", force.least, force.most),
              fmt::format("{:.2f} to {:.2f} um", way.least * 1e6, way.most * 1e6));
}
bool may_be_more(const trial::Precision& all, const trial::PrecisionPoint& point,
                 const trial::Accuracy& asked) {
  return all.error_spread(point).most > asked.force || all.way_spread(point).most > asked.way;
}
std::string words(const trial::Accuracy& asked) {
  return both(asked, fmt::format("{:g} N", asked.force), fmt::format("{:g} um", asked.way * 1e6));
}

std::string advised(const trial::Precision& all, const trial::Accuracy& asked) {
  const trial::PrecisionPoint* best = cheapest(all.points, asked);
  if (best == nullptr) return fmt::format("advice      none of these errs by less than {}\n", words(asked));
  std::string text = fmt::format(
      "advice     {}\n            errs by {}, allowed {}, {:.0f} x real time\n            by another "
      "converged run {}{}\n",
      (best->shipped ? " as it is:" : "") + settings_text(all, *best), errs_by(*best, asked), words(asked),
      1.0 / best->cpu, spread_of(all, *best, asked),
      may_be_more(all, *best, asked) ? ": that may be more than allowed" : "");
  if (const trial::PrecisionPoint* next = next_cheaper(all.points, *best))
    text += fmt::format("            the next cheaper, {} at {:g} us, errs by {}, {:.0f} x real time\n",
                        next->integrator, next->step * 1e6, errs_by(*next, asked), 1.0 / next->cpu);
  else
    text += "            nothing cheaper was found: no step is longer than the haptic period\n";
  return text;
}

}  // namespace

std::string advice_text(const trial::Precision& all, const trial::Accuracy& asked) {
  std::string text = fmt::format(
      "\nprecision   of the true force on what is held, rms while it touches; and of the tip's path\n"
      "            {:g} s of the scene, {:.1f} s touched, judged by {} at {:g} us and another one; floor "
      "about {:.4f} N, {:.2f} um\n",
      all.seconds, static_cast<double>(all.touched) * all.tick, all.converged.integrator,
      all.converged.step * 1e6, all.second.error, all.second.way * 1e6);
  for (const trial::PrecisionPoint& point : all.points) text += row(point);
  return text + advised(all, asked) +
         "            judged by these errors alone: what is stable, `encounter bench stability` says\n";
}

void refuse_below_floor(const trial::Precision& all, const trial::Accuracy& asked) {
  if (all.second.meets(asked) || cheapest(all.points, asked) != nullptr) return;
  throw Error(fmt::format("an error of {} is below what this scene can tell, {}: two converged runs "
                          "({} at {:g} us, {} at {:g} us) differ by that, as counts of its sensors fall "
                          "the other way; expected at least that",
                          words(asked), errs_by(all.second, asked), all.converged.integrator,
                          all.converged.step * 1e6, all.second.integrator, all.second.step * 1e6),
              all.second.error > asked.force ? "--error-N" : "--error-um");
}

namespace {

trial::Accuracy accuracy_of(const CheckOptions& options) {
  const auto refuse_unless_above_0 = [](const std::optional<double>& error, const char* what,
                                        const char* option, const char* example) {
    if (!error || (*error > 0.0 && std::isfinite(*error))) return;
    throw Error(fmt::format("how much may it err? expected {} above 0, such as --advise {} {}", what, option,
                            example),
                option);
  };
  if (!options.error_N && !options.error_um)
    throw Error("how much may it err? expected a force or a length, such as --advise --error-N 0.05",
                "--error-N");
  refuse_unless_above_0(options.error_N, "a force in N", "--error-N", "0.05");
  refuse_unless_above_0(options.error_um, "a length in um", "--error-um", "20");
  return {options.error_N.value_or(kUnset), options.error_um.value_or(kUnset) * 1e-6};
}

int advise(const CheckOptions& options, const trial::Accuracy& asked) {
  std::fflush(stdout);  // print so far: this takes a while
  trial::PrecisionOptions how;
  how.seed = options.seed;
  how.cpu = cpu_seconds;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) how.progress = show_progress;
  const trial::Precision all = trial::precision_of(
      [&](const std::vector<std::string>& set) {
        CheckOptions with = options;
        with.set.insert(with.set.end(), set.begin(), set.end());
        return load_setup(with);
      },
      how);
  if (terminal) fmt::print(stderr, "\r        \r");
  fmt::print("{}", advice_text(all, asked));
  std::fflush(stdout);
  refuse_below_floor(all, asked);
  return cheapest(all.points, asked) != nullptr ? 0 : 1;
}

}  // namespace

int check(const CheckOptions& options) {
  const models::Setup setup = load_setup(options);
  const double ready = cpu_seconds();
  const Scene scene = trial::prepare_setup(setup);
  print_notes(setup.notes);
  std::optional<trial::Accuracy> asked;
  if (options.advise) asked = accuracy_of(options);  // refuse wrong options before the long work
  if (options.resolved) {
    std::string made =
        fmt::format("# Encounter {}: {}, rig {}", ENCOUNTER_VERSION, options.scene, setup.rig_path);
    if (!setup.calibration.empty()) made += ", camera by " + setup.calibration;
    for (const std::string& set : options.set) made += fmt::format(", --set '{}'", set);
    fmt::print("{}\n{}", models::printable(made), models::built_scene(setup));
    return 0;
  }
  fmt::print("{}\n{}{}\nframes\n{}\nlimits\n{}{}", setup.scene.title,
             parts_text(setup) + models::sizes_text(setup),
             devices_text(trial::ask_drivers(setup, load_module)) + questionnaire_text(setup),
             frames_text(setup, scene), kLimits.at(words_of(setup.scene).row)(setup, scene),
             stability_text(setup, trial::certificates_of(setup, scene, true)));
  fmt::print("{}", costs_text(setup, options.seed, ready));
  return asked ? advise(options, *asked) : 0;
}

}  // namespace enc::app
