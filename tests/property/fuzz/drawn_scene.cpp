#include "tests/property/fuzz/drawn_scene.h"

#include <map>
#include <vector>

#include "models/shapes/hare.h"
#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "trial/assemble/prepare.h"

namespace enc::test {
namespace {

Mesh wedge(double half_angle) {
  const double half = 0.08 * std::tan(half_angle);
  return prism({{-half, -0.05}, {half, -0.05}, {0.0, 0.03}}, 0.06);
}

SceneSpec hexapod_scene(Random& random, std::string& what) {
  const BehaviourSpec behaviour =
      random.once_in(2) ? lossy_ball() : spring(random.in(500.0, 20'000.0), random.in(0.002, 0.006));
  const Vec3 turn = random.vec(3.0);
  switch (random.of(8)) {
    case 0: {
      what = "two balls, display";
      return two_balls(behaviour);
    }
    case 1:
      what = "plane";
      return plane_scene(behaviour);
    case 2: {
      what = "plane without a tracker";
      SceneSpec spec = plane_scene(behaviour);
      spec.tracker.reset();
      spec.tools.clear();
      return spec;
    }
    case 3:
      what = "cube";
      return mesh_scene(box(0.06, 0.06, 0.06), -0.022, Vec3::Zero(), behaviour);
    case 4:
      what = "turned cube";
      return mesh_scene(box(0.06, 0.06, 0.06), -0.022, turn, behaviour);
    case 5:
      what = "wedge";
      return mesh_scene(wedge(random.in(0.25, 0.8)), -0.02, Vec3(0, 0, turn.z()), behaviour);
    case 6:
      what = "groove";
      return mesh_scene(groove(), -0.01, Vec3(0, 0, turn.z()), behaviour);
    default: {
      static const Mesh hare = models::hare_mesh();
      what = "hare";
      return mesh_scene(hare, -0.018, Vec3(0, 0, turn.z()), behaviour);
    }
  }
}

RigSpec drawn_rig(Random& random) {
  RigSpec rig;
  constexpr std::array kPredictions{Prediction::hold, Prediction::constant_velocity,
                                    Prediction::constant_acceleration};
  rig.tracker.prediction = kPredictions[random.of(3)];
  constexpr std::array kTares{Tare::start, Tare::free, Tare::window};
  rig.force.tare = kTares[random.of(3)];
  rig.force.filter = random.in(2.0, 50.0);
  rig.manipulator.speed = random.in(0.02, 0.2);
  rig.manipulator.acceleration = random.in(0.2, 3.0);
  rig.contact.softest = 0.0;
  if (random.once_in(4)) rig.admittance.damping = Damping::observed;
  return rig;
}

const std::vector<std::string> kArmScenes{"wall", "button", "keypad", "room", "hit_ball", "drum"};

}  // namespace

Drawn draw_scene(std::uint64_t seed, Random& random) {
  Drawn drawn;
  if (seed % 4 == 3) {
    static std::map<std::string, models::Setup> setups;
    const std::string name = kArmScenes[random.of(kArmScenes.size())];
    if (!setups.contains(name))
      setups[name] = models::load(tests::source_dir() + "/models/scenes/" + name + ".toml", "", {});
    drawn.what = "arm, " + name;
    drawn.scene = trial::prepare_setup(setups[name]);
    return drawn;
  }
  const SceneSpec spec = hexapod_scene(random, drawn.what);
  SceneSpec with = spec;
  with.follow.inset = random.in(20e-6, 0.5e-3);
  if (with.tracker && with.tools.size() == 1) {
    ToolSpec other = with.tools.front();
    other.name = "other";
    for (Vec3& marker : other.markers) marker *= 1.3;
    with.tools.push_back(other);
  }
  drawn.scene = prepare(with, drawn_rig(random));
  return drawn;
}

}  // namespace enc::test
