#include "trial/certificates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/machine/steadiness.h"
#include "core/task/meet/arm_loop.h"
#include "trial/limits.h"

namespace enc::trial {
namespace {

using certificate::Class;

certificate::Hand hand_of(const RigSpec& rig) {
  return {0.0, rig.contact.hand_damping, rig.contact.hand_stiffness};
}

// ---- an arm: stiff is what is hard
// ---------------------------------------------------------------------------------------------

Certified of_arm(const models::Setup& setup, const Scene& scene, const TouchedPlace& at,
                 const std::string& object, double stiffness, bool hit) {
  const ArmLoopAt loop =
      loop_at(*scene.impedance(), hand_of(setup.rig), scene.dt, at.joints, at.way, stiffness, hit);
  return {object, stiffness, certificate::certify(loop.loop, loop.steps, loop.asked)};
}

std::vector<Certified> of_arm(const models::Setup& setup, const Scene& scene) {
  const Impedance& law = *scene.impedance();
  const TouchedPlace home{{}, law.arm.zero(), scene.X_WR.inverse() * Vec<'W'>(0, 0, 1)};
  std::vector<Certified> found{of_arm(setup, scene, home, "", law.rig.stiffness, false)};
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    found.push_back(of_arm(setup, scene, touched_place(setup, scene, i), setup.scene.objects[i].name,
                           stiffest_asked(law, scene.objects[i]),
                           scene.objects[i].interaction.kind == Interaction::hit));
  return found;
}

// ---- a machine that measures force: soft is what is hard
// ---------------------------------------------------------------------------------------------

// How quickly the scene's own hand pushes; a real one pushes as quickly as it likes.
double ramp_of(const models::Setup& setup) {
  const std::optional<UserSpec>& user = setup.scene.user;
  if (setup.scene.pusher) return std::min(Steadiness::kSlow, setup.scene.pusher->ramp_time);
  if (user && !user->session && !user->reaches) return std::min(Steadiness::kSlow, user->press_time);
  return Steadiness::kQuick;
}

double softest_of(const Response& response, double limit) {
  constexpr int kSteps = 100;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    const double a = limit * i / kSteps, b = limit * (i + 1) / kSteps;
    least = std::min({least, (response.press(b) - response.press(a)) / (b - a),
                      (response.release(b) - response.release(a)) / (b - a)});
  }
  return least;
}

void add_row(std::vector<certificate::Row>& rows, const char* name, const char* formula, double low,
             double asked, bool applies, const char* source) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  rows.push_back({name, formula, kNone, low > 0.0 ? asked / low : kNone, applies, source, low});
}

std::vector<Certified> of_admittance(const models::Setup& setup, const Scene& scene, bool whole) {
  const Steadiness loop(setup.rig);
  const double ramp = ramp_of(setup), linear = lowest_stable_stiffness(loop_of(setup.rig));
  const bool damped = setup.rig.admittance.damping == Damping::observed;
  std::vector<Certified> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (std::isnan(object.limit)) continue;  // real
    Certified at{setup.scene.objects[i].name, softest_of(object.response, object.limit), {}};
    const Steadiness::Worst worst = loop.worst(object.response, object.limit, ramp);
    at.depth = worst.depth;
    at.swing = worst.swing;
    at.ramp = ramp;
    // Where nobody pushes nothing is measured, and nothing moves.
    const bool small = damped || at.asked >= linear * (1.0 - 1e-9);
    at.certificate.verdict = small ? worst.swing > 0.0 ? Class::local : Class::alone : Class::unstable;
    add_row(at.certificate.rows, "admittance", "1 + Z G H e^{-s t_d}/K = 0 has no root to the right", linear,
            at.asked, !damped, "[VHMR Fig 3], docs/reference/model.md");
    if (whole)  // the same object, softer, until it swings
      add_row(at.certificate.rows, "large_signal",
              "all of it softer, down to half: pushed as this scene does, with all limits, it stands still",
              worst.swing == 0.0 ? at.asked * loop.least_share(object.response, object.limit, ramp) : kUnset,
              at.asked, true, "docs/notes/stiffness.md");
    found.push_back(std::move(at));
  }
  return found;
}

}  // namespace

bool Certified::beyond() const {
  const Class verdict = certificate.verdict;
  return verdict == Class::unheld || verdict == Class::local || verdict == Class::unstable;
}

std::vector<Certified> certificates_of(const models::Setup& setup, const Scene& scene, bool whole) {
  if (scene.impedance()) return of_arm(setup, scene);
  if (!scene.has_force) return {};
  return of_admittance(setup, scene, whole);
}

std::string name_of(const Certified& certified) {
  return certified.object.empty() ? "the tip that nobody touches" : "object '" + certified.object + "'";
}

std::string class_text(const Certified& certified) {
  const certificate::Certificate& of = certified.certificate;
  const std::string words(word_of(of.verdict));
  if (certified.unknown()) return words + ": no " + of.missing;
  std::string text = fmt::format("{}, at {:.3g} N/mm", words, 1e-3 * certified.asked);
  if (std::isnan(certified.ramp))
    text += fmt::format("; let go 0.1 mm beside its target: {}, 1 mm: {}", word_of(of.small.rest),
                        word_of(of.large.rest));
  return text;
}

std::string refusal_text(const models::Setup& setup, const Certified& certified) {
  const certificate::Certificate& of = certified.certificate;
  if (certified.unknown())
    return fmt::format(
        "whether {} is stable is not known: no {}; write [arm.loop] into the rig, as "
        "models/rigs/vishap.toml has it",
        name_of(certified), of.missing);
  if (!certified.beyond()) return {};
  if (certified.swing > 0.0)
    return fmt::format(
        "{}, pushed {:.1f} mm deep in {:g} s by a hand of {:g} N/mm, swings by {:.1f} mm: it is softer "
        "than this machine holds still; make it stiffer, or set rig.admittance.damping=observed",
        name_of(certified), certified.depth * 1e3, certified.ramp, setup.rig.contact.hand_stiffness * 1e-3,
        certified.swing * 1e3);
  if (!std::isnan(certified.ramp))
    return fmt::format(
        "{} is {} under a hand of {:g} N/mm: {:.3g} N/mm, and the loop needs {:.3g}; make it "
        "stiffer, or set rig.admittance.damping=observed",
        name_of(certified), word_of(of.verdict), setup.rig.contact.hand_stiffness * 1e-3,
        1e-3 * certified.asked, 1e-3 * certificate::row_of(of, "admittance").low);
  const certificate::Row& held = certificate::row_of(of, "exact_with_hand");
  return fmt::format(
      "{} asks for {:.3g} N/mm and is {}: under the hand that the rig expects the loop is stable from {:.3g} "
      "to {:.3g} N/mm; make it {}",
      name_of(certified), 1e-3 * certified.asked, word_of(of.verdict), 1e-3 * held.low, 1e-3 * held.bound,
      certified.asked < held.low ? "stiffer" : "softer");
}

std::string key_of(const Certified& certified) {
  return certified.object.empty() ? "rig.arm.stiffness" : "object." + certified.object + ".behaviour";
}

}  // namespace enc::trial
