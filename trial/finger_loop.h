// The core alone under a finger at given positions: no physics, no noise, and an arm that stays at home.
#pragma once

#include "core/control/scene/scene.h"
#include "core/control/step.h"
#include "trial/certificates.h"

namespace enc::trial {

class FingerLoop {
 public:
  explicit FingerLoop(Scene made) : scene(std::move(made)) {
    const Arm& arm = impedance_of(scene).arm;
    in.arm.value = {arm.zero(), {}, arm.tip(arm.zero()), Vec<'R'>::zero()};
    tick_.dt = from_seconds(scene.dt);
    tick_.index = -1;
    tick_.t = Time(-tick_.dt);
    in.withheld = true;  // the machine gets no commands
  }

  // One tick with the finger at p.
  const Outputs& tick(const Point<'W'>& p) {
    put(p);
    return go();
  }
  // One tick with a new picture of a finger that was at p `age` ago; and one without a picture.
  const Outputs& see(const Point<'W'>& p, Duration age) {
    put(p);
    in.tool.t -= age;
    return go();
  }
  const Outputs& tick() {
    go_on();
    return go();
  }
  // The two parts of tick(p), for code that times the second one: place the finger, then call step().
  void put(const Point<'W'>& p) {
    go_on();
    const Vec3 origin = p.e() - scene.tools[0].tip.centre.e();
    in.tool = {{0, scene.X_WC.inverse() * Pose<'W', 'T'>(Quat::Identity(), origin)}, tick_.t, Health::ok};
  }
  const Outputs& go() {
    step(scene, tick_, in, state, out);
    return out;
  }

  Scene scene;
  Inputs in;
  State state;
  Outputs out;

 private:
  void go_on() {
    ++tick_.index;
    tick_.t += tick_.dt;
    in.arm.t = tick_.t;
    in.arm.health = Health::ok;
  }
  Tick tick_;
};

}  // namespace enc::trial
