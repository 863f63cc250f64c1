// The certificates of an arm: stiff is what is hard. A whole one takes a millisecond, and a scene may have
// hundreds of objects. So of those that are equally stiff and of one class only the one that is nearest to
// its bounds has a whole one, at the worst of a few places; one look at the eigenvalues tells which that is.
#include <cmath>
#include <map>
#include <tuple>

#include "core/control/task/meet/arm_loop.h"
#include "trial/certificates.h"
#include "trial/limits.h"

namespace enc::trial {
namespace {

using certificate::Class;

constexpr double kBeside = 0.05;  // m: so far beside the first place others are tried. A hand's breadth

struct Place {
  Point<'W'> at;
  bool pressed = false;
  ArmLoopAt loop;
  double radius = kUnset;  // of the eigenvalues, at the stiffness that all are compared at
};

struct Candidate {
  double asked = 0.0;                     // N/m
  Interaction kind = Interaction::slide;  // or hit, or passive: of these the law is another one
  Place worst;
  Class look = Class::unknown;
};

certificate::Hand hand_of(const RigSpec& rig) {
  return {0.0, rig.contact.hand_damping, rig.contact.hand_stiffness};
}

// Where it is touched; and, but where the plan of a simulated user presses it or it is met in its middle,
// four places of its surface beside that, if the arm gets there.
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
    const Nearest near =
        object.surface.nearest(object.X_OW * (touched.at.point + Vec<'W'>(Vec3(kBeside * way))));
    const Point<'W'> at = object.X_WO * near.point;
    PerJoint q = touched.joints;
    if (law.arm.reaches(X_RW * at, law.rig.least_dexterity, q))
      add(at, q, X_RW * (object.X_WO * near.normal));
  }
  return places;
}

// The stiffness at which all that ask for as much are compared: where the first is at its bound. What has
// eigenvalues outside of the circle there has a lower one.
double compared_at(const Place& first, double asked) {
  const double critical = certificate::critical_stiffness(first.loop.loop, first.loop.asked.damper);
  return critical > 0.0 && std::isfinite(critical) ? critical : asked;
}

Certified certified(const std::string& object, const Place& place, double asked) {
  Certified found{object, asked, certificate::certify(place.loop.loop, place.loop.steps, place.loop.asked)};
  found.place = place.at;
  found.pressed = place.pressed;
  return found;
}

// The matrix of all directions is large where many periods are under way: there the normal alone is looked
// at.
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

std::vector<Certified> arm_certificates(const models::Setup& setup, const Scene& scene, bool /*whole*/) {
  const Impedance& law = impedance_of(scene);
  Place home;
  home.at = Point<'W'>(0, 0, 0);
  home.loop = loop_at(law, hand_of(setup.rig), scene.dt, law.arm.zero(),
                      scene.X_WR.inverse() * Vec<'W'>(0, 0, 1), law.rig.stiffness, Interaction::slide);
  std::vector<Certified> found{certified("", home, law.rig.stiffness)};
  const std::vector<Candidate> all = candidates_of(setup, scene);
  std::map<std::tuple<double, Interaction, Class>, std::size_t> worst;
  const auto alike = [](const Candidate& one) { return std::tuple(one.asked, one.kind, one.look); };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [at, fresh] = worst.try_emplace(alike(all[i]), i);
    if (!fresh && all[i].worst.radius > all[at->second].worst.radius) at->second = i;
  }
  std::map<std::size_t, Certified> whole;
  for (const auto& [key, i] : worst)
    whole.emplace(i, certified(setup.scene.objects[i].name, all[i].worst, all[i].asked));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t of = worst.at(alike(all[i]));
    Certified& one = found.emplace_back(whole.at(of));
    if (of != i) one.like = std::exchange(one.object, setup.scene.objects[i].name);
  }
  return found;
}

}  // namespace enc::trial
