// The devices of a rig: what each reports, whatever its role, and what each role adds.
#pragma once

#include <string>
#include <vector>

#include "core/base/hand_sample.h"
#include "core/base/image.h"
#include "core/base/sample.h"
#include "core/devices/signals.h"
#include "core/machine/hexapod.h"
#include "core/spec/rendering_rig.h"

namespace enc {

class Device {
 public:
  virtual ~Device() = default;
  // The device and its state in one line: "sample 127.0.0.1:4711, answered". Never called within the loop.
  [[nodiscard]] virtual std::string describe() const { return {}; }
  // True if the peer is a fake and has said so in its protocol (kFakeName). An address proves nothing: a
  // relay on this PC can lead to a real machine. Called once, before anything moves.
  [[nodiscard]] virtual bool is_fake() const { return false; }
  // False while no data come from the device or none can be sent to it. The run then holds until the user
  // resumes it, even if the link comes back before. Called in every cycle; never blocks.
  [[nodiscard]] virtual bool linked() const noexcept { return true; }
  // Remarks for the user after a run, one line each.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
  // Reasons for refused data, with counts; empty if the driver accepts all data. `devices` prints this when
  // it ends.
  [[nodiscard]] virtual std::string refused() const { return {}; }
};

// A position-controlled machine that carries the haptic-tip: the hexapod [VHMR 2].
class Manipulator : public Device {
 public:
  [[nodiscard]] virtual Reach reach() const = 0;               // called once, before anything moves
  virtual Measurement<TipSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Set-point for the coming period, computed from the last read().
  virtual void command(const Pose<'R', 'H'>& X_RH) noexcept = 0;
  // Brings the machine to rest where it is. The run calls this when it ends, however it ends, and maybe more
  // than once; a command afterwards starts anew.
  virtual void stop() noexcept = 0;
};

struct PropCommand {
  double surface_speed = 0.0;  // of the object's surface relative to the prop, m/s
  Vec<'R'> facing;             // commanded direction of the prop's front, unit; unset: keep it
};

// A force-controlled arm that carries a prop to where a finger will touch: the PHANToM [VisHap 2.3].
class HapticArm : public Device {
 public:
  [[nodiscard]] virtual ArmAbility ability() const = 0;        // called once, before anything moves
  virtual Measurement<ArmSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Commanded force of the tip on its surroundings, including gravity compensation; valid until the next
  // command. The device converts it to joint torques (J^T F) and limits these to its motors.
  virtual void command(const Vec<'R'>& force) noexcept = 0;
  virtual void stop() noexcept = 0;  // Ends all force and stops every driven part; see Manipulator.
  // Only for a prop with its own motors; other props do nothing.
  virtual void move_prop([[maybe_unused]] const PropCommand& prop) noexcept {}
};

// A six-axis force/torque sensor between the machine and its haptic-tip [VHMR 2].
class ForceSensor : public Device {
 public:
  // The newest sample; never blocks. It is raw: weight, inertia and zero error are still in it.
  virtual Measurement<Wrench> read(Time now) noexcept = 0;
};

// Any source of tool or fingertip poses: optical tracker, stereo vision, a script, a recording [VHMR 3.3].
class PoseTracker : public Device {
 public:
  // Returns true for a new pose; otherwise does not change `newest`.
  virtual bool poll(Time now, Measurement<TrackedTool>& newest) noexcept = 0;
};

// A raw pair of equal size. The camera keeps its pixels until the next poll().
struct StereoFrame {
  ImageView left, right;
};

// Two cameras with the same view and the same exposure time [VisHap 2]. The loop never polls them: they
// belong to the tracker that uses them.
class StereoCamera : public Device {
 public:
  // Size of each image; empty if it is known only from a frame.
  [[nodiscard]] virtual ImageSize size() const { return {}; }
  // Returns true for a newer pair, stamped with its exposure time; otherwise does not change `newest`.
  virtual bool poll(Time now, Measurement<StereoFrame>& newest) noexcept = 0;
};

// The headset or window that shows the scene to the user. It also reports, late, which deformed surface it
// drew [VHMR 3.5].
class Display : public Device {
 public:
  virtual void show(const View& view) noexcept = 0;  // newest only; never blocks
  // Returns true if a new drawn surface came back.
  virtual bool poll(Time now, Measurement<DentSample>& newest) noexcept = 0;
};

// A gripper between force sensor and tip that clamps a tool [VHMR 4.1].
class Gripper : public Device {
 public:
  virtual Measurement<GripSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Valid until the next command; the device limits the force to its range.
  virtual void command(const Grip& grip) noexcept = 0;
  virtual void stop() noexcept = 0;  // Keeps its grip and opens nothing; see Manipulator.
};

// A tracker of the user's hand, for what is drawn of it [VHMR 3.2]. The core never sees it.
class HandTracker : public Device {
 public:
  // Returns true for a newer sample, stamped with its exposure; otherwise leaves `newest` alone.
  virtual bool poll(Time now, Measurement<HandSample>& newest) noexcept = 0;
};

}  // namespace enc
