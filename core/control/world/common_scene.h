// The part of a prepared scene that every task needs: objects, tools, poses of the devices, and models of the
// devices. A part of scene.h.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "core/base/tip.h"
#include "core/control/world/object.h"
#include "core/machine/hexapod.h"
#include "core/machine/servo.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc {

struct Tool {
  Tip<'T'> tip;
  // Shaft length from the tip's centre to the middle of the markers, m.
  double length = 0.0;
};

struct CommonScene {
  std::vector<Object> objects;
  std::vector<Tool> tools;
  bool has_manipulator = false, has_force = false, has_tracker = false, has_display = false;

  std::int32_t clamped_tool = -1;  // held by the gripper; -1: no tool
  double grip_force = kUnset;      // N

  // X_WR follows from "H is W at the machine's zero" [VHMR 2].
  Pose<'W', 'R'> X_WR;
  Pose<'W', 'C'> X_WC;
  Pose<'W', 'S'> X_WS;
  Pose<'G', 'L'> X_GL;
  Pose<'H', 'F'> X_HF;
  Reach reach;
  ServoModel servo;  // the machine's servo model

  FollowSpec follow;
  ForceRig force;
  TrackerRig tracker;
  DisplayRig display;
  ContactRig contact;
  LoopRig loop;
  double tip_radius = kUnset;    // radius of the haptic-tip or the probe, m
  double dt = kUnset;            // s, one tick
  double filter_gain = kUnset;   // force low-pass, per tick
  double lowest_slope = kUnset;  // N/m: softest object accepted (loop_model.h)
  // N: pressing force that the machine can carry beside its own load.
  double strength = kUnset;
};

}  // namespace enc
