// Plants of the small devices beside a machine: display, force sensor and gripper.
#pragma once

#include <array>

#include "core/base/sample.h"
#include "core/control/scene/scene.h"
#include "core/devices/signals.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

// The headset as the core sees it: it draws the newest view at its own rate and deforms the shown object by
// the tracked tool. It sends the drawn surface back over UDP [VHMR 3.5, 4.3].
class DisplayPlant {
 public:
  struct Packet {
    Measurement<DentSample> sample;
    Time due{};
    bool waiting = false;
  };
  struct State {
    DueTimes frame;
    View view;  // newest shown
    std::array<Packet, 64> on_wire;
    std::size_t head = 0;
    Measurement<DentSample> arrived;
    bool news = false;
  };
  DisplayPlant(const DisplayTruth& truth, const Scene& scene, std::uint64_t seed);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void show(const View& view) noexcept { state_.view = view; }
  void advance(Time t);
  bool poll(Measurement<DentSample>& newest) noexcept;

 private:
  [[nodiscard]] DentSample draw() const;

  DisplayTruth truth_;
  const Scene& scene_;
  State state_;
};

// Readings of the force/torque sensor: MuJoCo's sensor pair plus the inertia that a placed body does not
// show, zero error and drift, noise, quantisation and range. [VHMR 2, sources/force_sensor 1]
class ForcePlant {
 public:
  struct State {
    Stream noise;
    Vec<'F'> zero = Vec<'F'>::zero();      // N
    Vec<'F'> shifted = Vec<'F'>::zero();   // N, in this push
    Vec<'F'> shifting = Vec<'F'>::zero();  // N/s, during the next
    double shift_left = 0.0;               // remaining s
    Measurement<Wrench> sample;
  };
  ForcePlant(const ForceTruth& truth, std::uint64_t seed);

  [[nodiscard]] const Measurement<Wrench>& sample() const { return state_.sample; }
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void begin_push() noexcept;  // the zero differs from that of the last push
  [[nodiscard]] Vec<'F'> zero() const { return state_.zero + state_.shifted; }
  // raw: force and torque on the sensor in its true axes; inertia: m a of the mass behind it, in those axes.
  // Once a tick.
  void measure(Time t, double dt, const Wrench& raw, const Vec<'F'>& inertia);

 private:
  ForceTruth truth_;
  Quat turned_;  // rotation from the true sensor axes to the rig's
  State state_;
};

// Motion of the gripper: jaws that close at constant speed until they meet an object or each other, then
// press with the set force. [VHMR 4.1, sources/force_sensor 4] The clamped tool is part of the tip's body
// from the start: until the jaws are closed, a person holds it there.
class GripperPlant {
 public:
  struct State {
    Stream noise;
    Grip wanted;
    double play = 0.0;  // m: position error of this closing
    Measurement<GripSample> sample;
  };
  GripperPlant(const GripperTruth& truth, std::uint64_t seed);

  [[nodiscard]] const Measurement<GripSample>& sample() const { return state_.sample; }
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  // A force that is not a number is refused (health fault); one beyond the range is clamped (out_of_range).
  void command(const Grip& grip) noexcept;
  void advance(Time t, double dt) noexcept;  // once a tick

 private:
  [[nodiscard]] double stop() const noexcept;  // opening at which the jaws stop, m
  void begin(bool closing) noexcept;

  GripperTruth truth_;
  State state_;
};

}  // namespace enc::sim
