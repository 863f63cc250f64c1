#include "trial/certificates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/control/scene/steadiness.h"
#include "trial/assemble/assemble.h"

namespace enc::trial {
namespace {

using certificate::Class;

// How quickly the scene's own hand pushes; a person pushes as quickly as they like.
double ramp_of(const models::Setup& setup) {
  const double slowest = meets_person(setup) ? Steadiness::kQuick : Steadiness::kSlow;
  const std::optional<UserSpec>& user = setup.scene.user;
  if (setup.scene.pusher) return std::min(slowest, setup.scene.pusher->ramp_time);
  if (user && !user->session && !user->reaches) return std::min(slowest, user->press_time);
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

using Side = certificate::Row::Side;
void add_row(std::vector<certificate::Row>& rows, const char* name, const char* formula, double low,
             double asked, bool applies, const char* source, Side side = Side::at) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  rows.push_back({name, formula, kNone, low > 0.0 ? asked / low : kNone, applies, source, low, side});
}

// The same object, softer, until it swings. Where the search ends, or it swings itself, one side is known.
void add_large_signal(Certified& at, const Steadiness& loop, const Object& object, double ramp) {
  const bool swings = at.swing > 0.0;
  const double share = swings ? 1.0 : loop.least_share(object.response, object.limit, ramp);
  add_row(at.certificate.rows, "large_signal",
          "all of it softer, down to half: pushed as this scene does, with all limits, it stands still",
          at.asked * share, at.asked, true, "docs/notes/stiffness.md",
          swings                             ? Side::above
          : share <= Steadiness::kLeastShare ? Side::below
                                             : Side::at);
}

}  // namespace

std::vector<Certified> hexapod_certificates(const models::Setup& setup, const Scene& scene, bool whole) {
  if (!scene.has_force) return {};
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
    if (whole) add_large_signal(at, loop, object, ramp);
    found.push_back(std::move(at));
  }
  return found;
}

bool Certified::beyond() const {
  const Class verdict = certificate.verdict;
  if (free_tip()) return verdict == Class::held || verdict == Class::local || verdict == Class::unstable;
  return verdict == Class::unheld || verdict == Class::local || verdict == Class::unstable;
}

std::string name_of(const Certified& certified) {
  return certified.object.empty() ? "the tip that nobody touches" : "object '" + certified.object + "'";
}

namespace {

// "delay: more than 600 periods" says what is wrong with it.
std::string missing_text(const certificate::Certificate& of) {
  return (of.missing.find(':') == std::string::npos ? "no " : "") + of.missing;
}

std::string mend_of(const models::Setup& setup, const std::string& missing) {
  if (!setup.rig.arm.loop) return "write [arm.loop] into the rig, as models/rigs/vishap.toml has it";
  if (missing.starts_with("hand"))
    return "write 'hand_stiffness_N_per_mm' and 'hand_damping_Ns_per_m' into its [contact]";
  if (missing.starts_with("delay")) return "correct 'delay_ms' in its [arm.loop]";
  if (missing == "damping") return "correct 'viscous_Nms' in its [arm.loop]";
  if (missing == "friction") return "correct 'friction_Nm' in its [arm.loop]";
  if (missing == "encoder step") return "correct 'counts' in its [arm.loop]";
  if (missing == "mass") return "correct the masses in its [arm.machine]";
  if (missing.starts_with("what a release does")) return "make it stiffer, so that it swings sooner";
  return "correct its [arm]";
}

}  // namespace

std::string class_text(const Certified& certified) {
  const certificate::Certificate& of = certified.certificate;
  const std::string words(word_of(of.verdict));
  if (certified.unknown()) return words + ": " + missing_text(of);
  std::string text = fmt::format("{}, at {:.3g} N/mm", words, 1e-3 * certified.asked);
  if (std::isnan(certified.ramp))
    text += fmt::format("; let go 0.1 mm beside its target: {}, 1 mm: {}", word_of(of.small.rest),
                        word_of(of.large.rest));
  return text;
}

std::string refusal_text(const models::Setup& setup, const Certified& certified) {
  const certificate::Certificate& of = certified.certificate;
  if (certified.unknown())
    return fmt::format("whether {} is stable is not known: {}; {}", name_of(certified), missing_text(of),
                       mend_of(setup, of.missing));
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
  if (certified.free_tip()) {
    const certificate::Row& alone = certificate::row_of(of, "exact_alone");
    return fmt::format(
        "{} is held by {:.3g} N/mm and is {}: the loop without a hand is stable from {:.3g} to {:.3g} N/mm; "
        "make "
        "it {}",
        name_of(certified), 1e-3 * certified.asked, word_of(of.verdict), 1e-3 * alone.low, 1e-3 * alone.bound,
        certified.asked < alone.low ? "stiffer" : "softer");
  }
  const certificate::Row& held = certificate::row_of(of, "exact_with_hand");
  return fmt::format(
      "{} asks for {:.3g} N/mm and is {}: under the hand that the rig expects the loop is stable from {:.3g} "
      "to {:.3g} N/mm; make it {}",
      name_of(certified), 1e-3 * certified.asked, word_of(of.verdict), 1e-3 * held.low, 1e-3 * held.bound,
      certified.asked < held.low ? "stiffer" : "softer");
}

std::string key_of(const Certified& certified) {
  if (certified.unknown() && !certified.certificate.missing.starts_with("what")) return "rig.arm.loop";
  return certified.free_tip() ? "rig.arm.stiffness" : "object." + certified.object + ".behaviour";
}

}  // namespace enc::trial
