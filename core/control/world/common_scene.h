// What every task needs of a scene that is made ready: objects, tools, where the devices stand, and what is
// believed of them. A part of scene.h.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "core/base/tip.h"
#include "core/control/world/object.h"
#include "core/machine/reach.h"
#include "core/machine/servo.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc {

struct Tool {
  Tip<'T'> tip;
  double length = 0.0;  // of its shaft: from the tip's centre to the middle of the markers, m
};

struct CommonScene {
  std::vector<Object> objects;
  std::vector<Tool> tools;
  bool has_manipulator = false, has_force = false, has_tracker = false, has_display = false;

  std::int32_t clamped_tool = -1;  // held by the gripper; -1: there is none
  double grip_force = kUnset;      // N

  Pose<'W', 'R'> X_WR;  // from "H is W at the machine's zero" [VHMR 2]
  Pose<'W', 'C'> X_WC;
  Pose<'W', 'S'> X_WS;
  Pose<'G', 'L'> X_GL;
  Pose<'H', 'F'> X_HF;
  Reach reach;
  ServoModel servo;  // of the machine, as it is believed

  FollowSpec follow;
  ForceRig force;
  TrackerRig tracker;
  DisplayRig display;
  ContactRig contact;
  LoopRig loop;
  double tip_radius = kUnset;    // of the haptic-tip or the probe, m
  double dt = kUnset;            // s, one tick
  double filter_gain = kUnset;   // of the force low-pass, per tick
  double lowest_slope = kUnset;  // N/m: softest object that is accepted (loop_model.h)
  double strength = kUnset;      // N: pressing force that the machine carries beside its own load
};

}  // namespace enc
