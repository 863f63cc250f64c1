// The indentation test rig of [VHMR 4.2, Fig 7], prepared: the position and number of the pushes of a probe
// into a real object. It measures force against deflection; the reference curves of an object are fitted to
// these data.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/frames.h"
#include "core/control/stages/displacement.h"
#include "core/spec/task_spec.h"

namespace enc {

struct ObjectSpec;
struct Outputs;
struct CommonScene;
struct SceneSpec;

// Phase of the programme of pushes. The programme's time stands still in a hold.
enum class ProbePhase : std::uint8_t { wait, approach, rest, push, dwell, back, done };
struct IndentationState : CommandState {
  ProbePhase phase = ProbePhase::wait;
  double elapsed = 0.0;     // s of this phase
  double deflection = 0.0;  // requested, m; negative: above the surface
};

struct IndentationTask : DisplacementTask {
  using Memory = IndentationState;
  using Context = stages::ManipulatorContext;
  // The programme that the scene asks for, if any; `scene` is otherwise complete. Throws Error if this
  // machine cannot do it: out of reach, an obstacle, no force sensor, too deep.
  [[nodiscard]] static std::optional<IndentationTask> asked(const SceneSpec& spec, const CommonScene& scene);

  std::int32_t object = 0;  // index in the scene
  // Origin: the probe's centre where it first touches the undeformed object. z: out of the object, against
  // the push. x: direction of an offset.
  Pose<'W', 'N'> X_WN;
  double depth = kUnset, clear = kUnset;  // m, below and above the first touch
  double speed = kUnset;                  // m/s
  double dwell = kUnset, rest = kUnset;   // s
  std::int32_t repeats = 0;

  // Deflection of a probe with its centre at `p`, m: distance along the push, negative before the first
  // touch.
  [[nodiscard]] double deflection(const Point<'W'>& p) const { return -(X_WN.inverse() * p).xyz[2]; }
  [[nodiscard]] Point<'W'> at(double deflection) const { return X_WN * Point<'N'>(0, 0, -deflection); }
};

// The object that [probe] names, or the first. Throws Error if there is no such object.
[[nodiscard]] const ObjectSpec& probed_object(const SceneSpec& spec);
// Upper bound of the time from the start to the rest after the last push, s.
[[nodiscard]] double programme_time(const CommonScene& scene, const IndentationTask& probe);

template <class F>
void fields(F& f, IndentationState& p) {
  fields(f, static_cast<CommandState&>(p));
  f("probe_phase", p.phase);
  f("probe_elapsed", p.elapsed);
  f("probe_deflection", p.deflection);
}

namespace stages {
void touch(ManipulatorContext& context, const IndentationTask& task, CommonState& state,
           IndentationState& now) noexcept;
void act(ManipulatorContext& context, const IndentationTask& task, CommonState& state,
         IndentationState& now) noexcept;
void guard(ManipulatorContext& context, const IndentationTask& task, CommonState& state,
           IndentationState& now) noexcept;
void report(const ManipulatorContext& context, const IndentationTask& task, CommonState& state,
            const IndentationState& now, Outputs& out) noexcept;
}  // namespace stages

}  // namespace enc
