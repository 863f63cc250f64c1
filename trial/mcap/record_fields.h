// The fields of a tick on each channel, with unit and meaning, for JsonMessage and JsonSchema.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/words.h"
#include "core/record/record.h"
#include "trial/family.h"

namespace enc::trial {

// Empty for an index of -1 or out of range.
[[nodiscard]] inline std::optional<std::string_view> name_at(const std::vector<std::string>& names,
                                                             std::int32_t i) {
  if (i < 0 || static_cast<std::size_t>(i) >= names.size()) return {};
  return names[static_cast<std::size_t>(i)];
}
// A record comes from a file, so a number may be no value of the enum; it has no word.
template <class Enum>
[[nodiscard]] std::string_view word_if_any(Enum value) {
  return static_cast<std::size_t>(value) < kWords<Enum>.size() ? word_of(value) : "unknown";
}

// Time as in an MCAP file, which has no times before the start of the experiment.
[[nodiscard]] inline std::uint64_t nanoseconds(Time t) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(t.time_since_epoch().count(), 0));
}
template <class F>
void moment_fields(F& f, Time t) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  f.integer("sec", "", nanoseconds(t) / kSecond);
  f.integer("nsec", "", nanoseconds(t) % kSecond);
}
template <class F, class T>
void stamp_field(F& f, const Stamped<T>& said) {
  f.number("stamp_s", "when it was true", stamp_of(said));
}
template <class F>
void three_fields(F& f, const std::array<double, 3>& xyz) {
  f.number("x", "", xyz[0]);
  f.number("y", "", xyz[1]);
  f.number("z", "", xyz[2]);
}
// Left out if all three numbers are unknown.
template <class F>
void vector_field(F& f, std::string_view name, std::string_view about, const detail::Triple& v) {
  const bool any = std::any_of(v.xyz.begin(), v.xyz.end(), [](double x) { return std::isfinite(x); });
  f.object_if(name, about, any, [&](auto& inner) { three_fields(inner, v.xyz); });
}
template <class F>
void turn_fields(F& f, const std::array<double, 4>& xyzw) {
  three_fields(f, {xyzw[0], xyzw[1], xyzw[2]});
  f.number("w", "", xyzw[3]);
}

// foxglove.PoseInFrame: viewers know these names.
template <class F, char A, char B>
void pose_fields(F& f, Time t, const Pose<A, B>& X) {
  static constexpr char kFrame = A;
  f.object("timestamp", "", [&](auto& inner) { moment_fields(inner, t); });
  f.text("frame_id", "", std::string_view(&kFrame, 1));
  f.object("pose", "", [&](auto& pose) {
    pose.object("position", "m", [&](auto& inner) { three_fields(inner, X.xyz); });
    pose.object("orientation", "", [&](auto& inner) { turn_fields(inner, X.xyzw); });
  });
}

// foxglove.FrameTransforms
struct FixedFrame {
  std::string_view parent, child;
  std::array<double, 4> xyzw{};
  std::array<double, 3> xyz{};
};
template <class F>
void frames_fields(F& f, Time t, const std::vector<FixedFrame>& frames) {
  f.list("transforms", "", frames, [&](auto& one, const FixedFrame& frame) {
    one.object("timestamp", "", [&](auto& inner) { moment_fields(inner, t); });
    one.text("parent_frame_id", "", frame.parent);
    one.text("child_frame_id", "", frame.child);
    one.object("translation", "m", [&](auto& inner) { three_fields(inner, frame.xyz); });
    one.object("rotation", "", [&](auto& inner) { turn_fields(inner, frame.xyzw); });
  });
}

template <class F>
void wrench_fields(F& f, const Stamped<Wrench>& wrench) {
  f.text("frame", "of both, which is the sensor's", "F");
  vector_field(f, "force_N", "on the haptic-tip's side: weight, inertia and zero error are in it",
               wrench.value.force);
  vector_field(f, "torque_Nm", "about the origin of F", wrench.value.torque);
  f.text("health", "what the sensor says of itself", word_if_any(wrench.health));
  stamp_field(f, wrench);
}

template <class F>
void arm_fields(F& f, const std::vector<std::string>& joints, const std::vector<std::string>& speeds,
                const Inputs& in, const Outputs& out) {
  const ArmSample& arm = in.arm.value;
  for (std::size_t i = 0; i < joints.size(); ++i) f.number(joints[i], "of the encoder", arm.joints[i]);
  for (std::size_t i = 0; i < speeds.size(); ++i) f.number(speeds[i], "", arm.joint_velocities[i]);
  vector_field(f, "tip_m", "where the encoders say that the tip is, in R", arm.tip);
  vector_field(f, "tip_velocity_m_per_s", "in R", arm.velocity);
  vector_field(f, "told_force_N", "that it is told to push with, in R; gravity included", out.arm_force);
  vector_field(f, "wanted_m", "where its tip shall be, in W", out.wanted);
  f.number("gain", "of its stiffness along the surface's normal; 1 in free space", out.gain);
  f.number("prop_speed_m_per_s", "of a driven prop's surface against the prop", out.prop_speed);
  vector_field(f, "prop_facing", "that the prop's front shall face, unit, in R", out.prop_facing);
  f.text("health", "what the arm says of itself", word_if_any(in.arm.health));
  stamp_field(f, in.arm);
}

}  // namespace enc::trial
