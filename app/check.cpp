#include <array>
#include <cmath>

#include <fmt/format.h>

#include "app/built.h"
#include "app/modules/modules.h"
#include "app/options.h"
#include "core/machine/steadiness.h"
#include "core/safety/room.h"
#include "core/task/meet/arm_scene.h"
#include "trial/limits.h"
#include "trial/prepare.h"

namespace enc::app {
namespace {

// Where an object has no room for the tip under its surface, the tip waits as near as it has room.
std::string thin_text(const std::string& name, const Scene& scene, const Object& object) {
  const double margin = room_margin(scene);
  const Room room = room_in(object, margin, true);
  if (room.thin == 0.0) return {};
  const Point<'W'> at = object.X_WO * room.thin_at;
  return fmt::format(
      "  object '{}': {:.2g} % of its surface lies over what is thinner than the haptic-tip and its inset, "
      "{:.1f} mm; thinnest, {:.2f} mm, at ({:.1f}, {:.1f}, {:.1f}) mm; there the tip waits as near as it has "
      "room\n",
      name, room.thin * 100.0, 2e3 * margin, room.thinnest * 1e3, at.xyz[0] * 1e3, at.xyz[1] * 1e3,
      at.xyz[2] * 1e3);
}

std::string softest_text(const models::Setup& setup, const Scene& scene) {
  const Steadiness loop(setup.rig);
  const auto softest = [&](double ramp) {
    return std::max(scene.lowest_slope, loop.softest(0.015, 30.0, ramp)) * 1e-3;
  };
  return fmt::format(
      "  a spring stands still from {:.3f} N/mm on, under a hand of {:g} N/mm that pushes it up to 15 mm "
      "deep "
      "or by 30 N in {:g} s; from {:.3f} N/mm on in {:g} s\n",
      softest(Steadiness::kSlow), setup.rig.contact.hand_stiffness * 1e-3, Steadiness::kSlow,
      softest(Steadiness::kQuick), Steadiness::kQuick);
}

std::string limits(const models::Setup& setup, const Scene& scene) {
  std::string text;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const std::string& name = setup.scene.objects[i].name;
    if (std::isnan(scene.objects[i].limit)) {
      text += fmt::format("  object '{}': real, pressed by the machine and not rendered\n", name);
      continue;
    }
    text += fmt::format(
        "  object '{}': deflection up to {:g} mm, at most {:.2f} N; softest stable slope {:.3f} N/mm\n", name,
        scene.objects[i].limit * 1e3, scene.objects[i].response.press(scene.objects[i].limit),
        scene.lowest_slope * 1e-3);
    text += thin_text(setup.scene.objects[i].name, scene, scene.objects[i]);
  }
  const trial::Limits beyond = trial::limits_of(setup, scene);
  for (const trial::Unsteady& object : beyond.unsteady)
    text += "  UNSTEADY: " + trial::unsteady_text(setup, object) + "\n";
  if (scene.has_force) text += softest_text(setup, scene);
  return text + weak_text(setup, scene) +
         fmt::format("  commands up to {:g} mm/s and {:g} mm/s^2\n", scene.reach.speed * 1e3,
                     scene.reach.acceleration * 1e3);
}

// An arm has no deflection limit: it pushes with what it has.
std::string arm_limits(const models::Setup& setup, const Scene& scene) {
  constexpr std::array<const char*, 7> kKinds{"press", "slide", "click", "passive", "hit", "shift", "spin"};
  const Impedance& law = *scene.impedance();
  std::string text;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const double stiffness = std::isnan(object.stiffness) ? law.rig.stiffness : object.stiffness;
    text +=
        fmt::format("  object '{}': {}, {:g} N/mm when it is touched, {:.3g} of the gain in free space\n",
                    setup.scene.objects[i].name, kKinds[static_cast<std::size_t>(object.interaction.kind)],
                    stiffness * 1e-3, stiffness / law.rig.stiffness);
  }
  const trial::Limits can = trial::limits_of(setup, scene);
  for (const trial::ArmStrength& at : can.strengths) {
    text += fmt::format(
        "  object '{}': pushes back with up to {:.2f} N, for hours {:.2f} N; stiffest {:.2f} N/mm", at.object,
        at.peak, at.lasting, at.stiffest * 1e-3);
    if (!std::isnan(at.asked))
      text += fmt::format("; asked for {:.2f} N for {:.1f} s, held {}", at.asked, at.asked_for,
                          std::isinf(at.holds_for) ? "for ever" : fmt::format("for {:.0f} s", at.holds_for));
    text += "\n";
    const std::string beyond = trial::beyond_text(at);
    if (!beyond.empty()) text += "  BEYOND: " + beyond + "\n";
  }
  return text +
         fmt::format(
             "  law: {:g} N/m, {:g} N s/m, damping ratio {:.2f} for the {:.1f} g that are felt at the tip\n"
             "  pushes with up to {:g} N, for hours {:g} N\n"
             "  target up to {:g} mm/s and {:g} m/s^2\n",
             law.rig.stiffness, law.rig.damping, damping_ratio(law.rig, law.home_mass), law.home_mass * 1e3,
             law.rig.peak, law.rig.continuous, law.rig.speed * 1e3, law.rig.acceleration);
}

}  // namespace

int check(const SceneOptions& options) {
  const models::Setup setup = load_setup(options);
  const Scene scene = trial::prepare_setup(setup);
  print_notes(setup.notes);
  fmt::print("{}\n{}{}{}\nframes\n{}  every chain closes to {:.1e} m\n\nlimits\n{}\nresolved scene\n{}",
             setup.scene.title, parts_text(setup), devices_text(trial::ask_drivers(setup, load_module)),
             questionnaire_text(setup), frame_graph(scene), chain_residual(setup.scene, setup.rig, scene),
             scene.impedance() ? arm_limits(setup, scene) : limits(setup, scene), models::resolved(setup));
  return 0;
}

}  // namespace enc::app
