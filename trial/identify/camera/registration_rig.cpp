#include "trial/identify/camera/registration_rig.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"

namespace enc::trial {

namespace {

constexpr std::size_t kTargets = 240;

}  // namespace

RegistrationRig registration_rig(const models::Setup& setup) {
  if (setup.rig.arm.driver == "none")
    throw Error(
        fmt::format("{}:1:1: this rig has no arm; expected [arm] with a driver, because the arm carries the "
                    "tip through the camera's view; name another rig, such as vishap",
                    setup.rig_path));
  if (setup.rig.arm.driver != "sim")
    throw Error(
        fmt::format("{}: this rig's arm is driven by '{}', and the guided procedure moves a simulated one; "
                    "expected driver "
                    "\"sim\"; of a real arm record the places and give them as POINTS.csv",
                    models::place_of(setup, "rig.arm.driver"), setup.rig.arm.driver));
  if (!setup.twin.arm.there)
    throw Error(fmt::format(
        "{}: the rig's arm is simulated and nothing says what it is; expected [truth.arm]; add it",
        models::place_of(setup, "rig.arm")));
  RegistrationRig rig;
  rig.camera = setup.twin.camera;
  rig.believed = setup.rig.arm.machine;
  rig.arm = setup.twin.arm;
  rig.least_dexterity = setup.rig.arm.least_dexterity;
  rig.X_WC = {rotation_xyz(setup.twin.frames.W_C.rotation), setup.twin.frames.W_C.position};
  return rig;
}

RegistrationPlaces places_of(const RegistrationRig& rig, std::size_t most_pairs) {
  const Arm arm(rig.believed);
  const std::vector<Point<'W'>> all = places_in_view(arm, rig.least_dexterity, rig.X_WC, rig.camera);
  RegistrationPlaces places;
  places.visited = well_spread(all, most_pairs);
  Vec3 middle = Vec3::Zero();
  for (const Point<'W'>& p : all) middle += p.e() / static_cast<double>(all.size());
  const std::size_t step = std::max<std::size_t>(1, all.size() / kTargets);
  for (std::size_t i = 0; i < all.size(); i += step) places.targets.push_back(all[i]);
  // From the middle outwards, so that both are at an end of the list.
  const auto distance = [&](const Point<'W'>& p) { return (p.e() - middle).norm(); };
  std::stable_sort(places.targets.begin(), places.targets.end(),
                   [&](const Point<'W'>& a, const Point<'W'>& b) { return distance(a) < distance(b); });
  for (const Point<'W'>& p : places.targets) places.distance.push_back(distance(p));
  return places;
}

}  // namespace enc::trial
