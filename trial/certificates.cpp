#include "trial/certificates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "core/control/scene/steadiness.h"
#include "core/control/task/impedance/impedance.h"
#include "trial/assemble/assemble.h"

namespace enc::trial {
namespace {

using certificate::Class;

// Ramp time of the scene's own hand; a person may push as quickly as they like.
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

// Softens the object until the loop oscillates. If the search reaches its end, or the object oscillates
// unchanged, the row gives only one side.
void add_large_signal(ObjectCertificate& at, const Steadiness& loop, const Object& object, double ramp) {
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

std::vector<ObjectCertificate> hexapod_certificates(const models::Setup& setup, const Scene& scene,
                                                    bool whole) {
  if (!scene.has_force) return {};
  const Steadiness loop(setup.rig);
  const double ramp = ramp_of(setup), linear = lowest_stable_stiffness(loop_of(setup.rig));
  const bool damped = setup.rig.admittance.damping == Damping::observed;
  std::vector<ObjectCertificate> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (std::isnan(object.limit)) continue;  // a real object
    ObjectCertificate at{setup.scene.objects[i].name, softest_of(object.response, object.limit), {}};
    const Steadiness::WorstDepth worst = loop.worst(object.response, object.limit, ramp);
    at.depth = worst.depth;
    at.swing = worst.swing;
    at.ramp = ramp;
    // Without a push the machine measures no force and does not move.
    const bool small = damped || at.asked >= linear * (1.0 - 1e-9);
    at.certificate.verdict = small ? worst.swing > 0.0 ? Class::local : Class::alone : Class::unstable;
    add_row(at.certificate.rows, "admittance", "1 + Z G H e^{-s t_d}/K = 0 has no root to the right", linear,
            at.asked, !damped, "[VHMR Fig 3], docs/reference/model.md");
    if (whole) add_large_signal(at, loop, object, ramp);
    found.push_back(std::move(at));
  }
  return found;
}

// The certificates of an arm, for which stiff objects are hard to render. A complete certificate takes a
// millisecond, and a scene may have hundreds of objects. So only one of several equally stiff objects of one
// class gets a complete certificate: the one nearest to its bounds, at the worst of a few places. One
// evaluation of the eigenvalues finds that object.
namespace {

// Place at which an arm touches an object: the user's press, or the point nearest to home. Includes the
// joints there and the outward normal in R.
struct TouchedPlace {
  PressPoint at;
  PerJoint joints{};
  Vec<'R'> way;
  bool pressed = false;  // the place is from the user's plan
};

bool is_pressed(const models::Setup& setup, std::size_t i) {
  const std::optional<UserSpec>& user = setup.scene.user;
  return user && user->kind == UserKind::press_release &&
         pressed_object(setup.scene.objects, user->object, "user") == i;
}

PressPoint touched_point(const models::Setup& setup, const Scene& scene, std::size_t i) {
  if (is_pressed(setup, i)) return press_point(setup.scene, *setup.scene.user);
  const Object& object = scene.objects[i];
  const SurfacePoint near = object.surface.nearest(object.X_OW * Point<'W'>(0, 0, 0));
  return {object.X_WO * near.point, object.X_WO * near.normal};
}

TouchedPlace touched_place(const models::Setup& setup, const Scene& scene, std::size_t i) {
  TouchedPlace found{touched_point(setup, scene, i), {}, {}, is_pressed(setup, i)};
  const Arm& arm = impedance_of(scene).arm;
  found.joints = arm.zero();
  static_cast<void>(arm.inverse(scene.X_WR.inverse() * found.at.point, found.joints));
  found.way = scene.X_WR.inverse() * found.at.normal;
  return found;
}

// N/m: highest stiffness that an object requests from an arm.
double stiffest_asked(const Impedance& law, const Object& object) {
  const double floor = object.interaction.kind == Interaction::click ? object.interaction.floor : 0.0;
  return std::max(std::isnan(object.stiffness) ? law.rig.stiffness : object.stiffness, floor);
}

constexpr double kBeside = 0.05;  // m: distance of further places from the first one, a hand's breadth

struct Place {
  Point<'W'> at;
  bool pressed = false;
  ArmLoopAt loop;
  double radius = kUnset;  // spectral radius at the common stiffness
};

struct Candidate {
  double asked = 0.0;                     // N/m
  Interaction kind = Interaction::slide;  // hit and passive objects follow other laws
  Place worst;
  Class look = Class::unknown;
};

certificate::Hand hand_of(const RigSpec& rig) {
  return {0.0, rig.contact.hand_damping, rig.contact.hand_stiffness};
}

// The place of the touch, plus four places of the surface around it that the arm reaches. A simulated user's
// planned press, and an object touched in its middle, have only the first place.
std::vector<Place> places_of(const models::Setup& setup, const Scene& scene, std::size_t i,
                             const Candidate& of) {
  const Impedance& law = impedance_of(scene);
  const Object& object = scene.objects[i];
  const Pose<'R', 'W'> X_RW = scene.X_WR.inverse();
  const TouchedPlace touched = touched_place(setup, scene, i);
  const bool planned = touched.pressed && setup.rig.tracker.driver == "sim";
  std::vector<Place> places;
  const auto add = [&](const Point<'W'>& at, const PerJoint& q, const Vec<'R'>& way) {
    places.push_back(
        {at, planned, loop_at(law, hand_of(setup.rig), scene.dt, q, way, of.asked, of.kind), kUnset});
  };
  add(touched.at.point, touched.joints, touched.way);
  if (planned || object.met_in_its_middle()) return places;
  const Vec3 normal = touched.at.normal.e(), across = normal.unitOrthogonal();
  for (const Vec3& way : {across, Vec3(-across), Vec3(normal.cross(across)), Vec3(across.cross(normal))}) {
    const SurfacePoint near =
        object.surface.nearest(object.X_OW * (touched.at.point + Vec<'W'>(Vec3(kBeside * way))));
    const Point<'W'> at = object.X_WO * near.point;
    PerJoint q = touched.joints;
    if (law.arm.reaches(X_RW * at, law.rig.least_dexterity, q))
      add(at, q, X_RW * (object.X_WO * near.normal));
  }
  return places;
}

// The common stiffness for comparing equal requests: the critical stiffness of the first place. A place with
// eigenvalues outside of the circle at this stiffness has a lower critical one.
double compared_at(const Place& first, double asked) {
  const double critical = certificate::critical_stiffness(first.loop.loop, first.loop.asked.damper);
  return critical > 0.0 && std::isfinite(critical) ? critical : asked;
}

ObjectCertificate certified(const std::string& object, const Place& place, double asked) {
  ObjectCertificate found{object, asked,
                          certificate::certify(place.loop.loop, place.loop.steps, place.loop.asked)};
  found.place = place.at;
  found.pressed = place.pressed;
  return found;
}

// The matrix of all directions is large if many periods are under way. In that case use only the normal
// direction.
double radius_at(const certificate::SampledLoop& loop, double stiffness, double damper) {
  constexpr int kMany = 16;
  const bool large = certificate::late(loop).whole + loop.ticks > kMany;
  return certificate::spectral_radius(large ? loop.along() : loop, stiffness, damper);
}

std::vector<Candidate> candidates_of(const models::Setup& setup, const Scene& scene) {
  std::map<std::pair<double, Interaction>, double> compared;
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    Candidate& one = all.emplace_back();
    one.asked = stiffest_asked(impedance_of(scene), object);
    const Interaction kind = object.interaction.kind;
    if (kind == Interaction::hit || kind == Interaction::passive) one.kind = kind;
    std::vector<Place> places = places_of(setup, scene, i, one);
    const auto [at, fresh] = compared.try_emplace({one.asked, one.kind});
    if (fresh) at->second = compared_at(places.front(), one.asked);
    for (Place& place : places) {
      place.radius = radius_at(place.loop.loop, at->second, place.loop.asked.damper.at(at->second));
      if (&place == &places.front() || place.radius > one.worst.radius) one.worst = place;
    }
    const ArmLoopAt& loop = one.worst.loop;
    one.look = certificate::linear_class(loop.loop, loop.steps, loop.asked);
  }
  return all;
}

}  // namespace

std::vector<ObjectCertificate> arm_certificates(const models::Setup& setup, const Scene& scene,
                                                bool /*whole*/) {
  const Impedance& law = impedance_of(scene);
  Place home;
  home.at = Point<'W'>(0, 0, 0);
  home.loop = loop_at(law, hand_of(setup.rig), scene.dt, law.arm.zero(),
                      scene.X_WR.inverse() * Vec<'W'>(0, 0, 1), law.rig.stiffness, Interaction::slide);
  std::vector<ObjectCertificate> found{certified("", home, law.rig.stiffness)};
  const std::vector<Candidate> all = candidates_of(setup, scene);
  std::map<std::tuple<double, Interaction, Class>, std::size_t> worst;
  const auto alike = [](const Candidate& one) { return std::tuple(one.asked, one.kind, one.look); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [at, fresh] = worst.try_emplace(alike(all[i]), i);
    if (!fresh && all[i].worst.radius > all[at->second].worst.radius) at->second = i;
  }
  std::map<std::size_t, ObjectCertificate> whole;
  for (const auto& [key, i] : worst)
    whole.emplace(i, certified(setup.scene.objects[i].name, all[i].worst, all[i].asked));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t of = worst.at(alike(all[i]));
    ObjectCertificate& one = found.emplace_back(whole.at(of));
    if (of != i) one.like = std::exchange(one.object, setup.scene.objects[i].name);
  }
  return found;
}

namespace {

// The largest force on the way to a depth, N.
double asked_at(const Impedance& law, const Object& object, double depth) {
  constexpr int kSteps = 50;
  double most = 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const double d = depth * i / kSteps;
    const RenderedStiffness felt = felt_at(object.interaction, object.stiffness, law.rig.stiffness, d);
    most = std::max(most, felt.stiffness * (d - felt.sunk));
  }
  return most;
}

ArmStrength strength_at(const models::Setup& setup, const Scene& scene, std::size_t i) {
  const Impedance& law = impedance_of(scene);
  const Object& object = scene.objects[i];
  const std::optional<UserSpec>& user = setup.scene.user;
  const bool pressed = is_pressed(setup, i);
  const TouchedPlace at = touched_place(setup, scene, i);
  const PerJoint& q = at.joints;
  const PerJoint held = law.arm.gravity(q, law.prop_mass, Payload::exact);
  const Vec<'R'>& out = at.way;
  const Motors::Strength strength = law.motors.strength(law.arm, q, held, out);
  ArmStrength found{setup.scene.objects[i].name, strength.peak, strength.lasting};
  if (!pressed || object.interaction.kind == Interaction::passive) return found;
  const double deepest =
      user->depths.empty() ? user->depth : *std::max_element(user->depths.begin(), user->depths.end());
  found.asked = std::isnan(user->push) ? asked_at(law, object, deepest) : user->push;
  found.asked_for = user->hold_time + 0.5 * (user->press_time + user->release_time);
  found.holds_for = law.motors.holds_for(law.arm, q, held, out, found.asked);
  found.presses = static_cast<std::int64_t>(user->approach.size()) * user->repeats;
  const double fastest = *std::max_element(user->approach.begin(), user->approach.end());
  const double pause = user->rest_time + user->approach_from / fastest;
  found.gives_way_in =
      law.motors.gives_way_in(law.arm, q, held, out, found.asked, {found.asked_for, pause, found.presses});
  return found;
}

}  // namespace

std::vector<ArmStrength> arm_strengths(const models::Setup& setup, const Scene& scene) {
  std::vector<ArmStrength> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) found.push_back(strength_at(setup, scene, i));
  return found;
}

std::string beyond_text(const ArmStrength& at) {
  if (at.asked > at.peak)
    return fmt::format(
        "object '{}' is pressed with {:.2f} N, and there the motors push with at most {:.2f} N; press "
        "less deep, or make it softer",
        at.object, at.asked, at.peak);
  if (at.gives_way_in > 0)
    return fmt::format(
        "object '{}' is pressed with {:.2f} N for {:.0f} s{}, and cold motors hold that for {:.0f} s (for "
        "hours {:.2f} N); press less deep, or shorter{}",
        at.object, at.asked, at.asked_for,
        at.presses > 1 ? fmt::format(", press {} of {}", at.gives_way_in, at.presses) : "", at.holds_for,
        at.lasting, at.presses > 1 ? ", or rest longer" : "");
  return {};
}

bool ObjectCertificate::beyond() const {
  const Class verdict = certificate.verdict;
  if (free_tip()) return verdict == Class::held || verdict == Class::local || verdict == Class::unstable;
  return verdict == Class::unheld || verdict == Class::local || verdict == Class::unstable;
}

std::string name_of(const ObjectCertificate& certified) {
  return certified.object.empty() ? "the tip that nobody touches" : "object '" + certified.object + "'";
}

namespace {

// A text with a colon, as "delay: more than 600 periods", already states the problem.
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

std::string class_text(const ObjectCertificate& certified) {
  const certificate::Certificate& of = certified.certificate;
  const std::string words(word_of(of.verdict));
  if (certified.unknown()) return words + ": " + missing_text(of);
  std::string text = fmt::format("{}, at {:.3g} N/mm", words, 1e-3 * certified.asked);
  if (std::isnan(certified.ramp))
    text += fmt::format("; let go 0.1 mm beside its target: {}, 1 mm: {}", word_of(of.small.rest),
                        word_of(of.large.rest));
  return text;
}

std::string refusal_text(const models::Setup& setup, const ObjectCertificate& certified) {
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

std::string key_of(const ObjectCertificate& certified) {
  if (certified.unknown() && !certified.certificate.missing.starts_with("what")) return "rig.arm.loop";
  return certified.free_tip() ? "rig.arm.stiffness" : "object." + certified.object + ".behaviour";
}

}  // namespace enc::trial
