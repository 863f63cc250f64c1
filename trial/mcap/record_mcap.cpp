#include "trial/mcap/record_mcap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/base/words.h"
#include "core/control/scene/scene.h"
#include "core/record/record.h"
#include "models/schema/wording.h"
#include "trial/family.h"
#include "trial/mcap/json.h"
#include "trial/mcap/ros2.h"

namespace enc::trial {
namespace {

// ---- the fields of a tick on each channel, with unit and meaning, for JsonMessage and JsonSchema

// Empty for an index of -1 or out of range.
std::optional<std::string_view> name_at(const std::vector<std::string>& names, std::int32_t i) {
  if (i < 0 || static_cast<std::size_t>(i) >= names.size()) return {};
  return names[static_cast<std::size_t>(i)];
}
// A record comes from a file, so a number may be outside of the enum; it then has no word.
template <class Enum>
std::string_view word_if_any(Enum value) {
  return static_cast<std::size_t>(value) < kWords<Enum>.size() ? word_of(value) : "unknown";
}

// Time in an MCAP file, which has no times before the start of the experiment.
std::uint64_t nanoseconds(Time t) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(t.time_since_epoch().count(), 0));
}
template <class F>
void moment_fields(F& f, Time t) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  f.integer("sec", "", nanoseconds(t) / kSecond);
  f.integer("nsec", "", nanoseconds(t) % kSecond);
}
// ROS 2 only: the header of a stamped message.
template <class F>
void header_field(F& f, Time t, std::string_view frame) {
  if constexpr (F::kRos)
    f.object("header", "", [&](auto& header) {
      header.object("stamp", "", [&](auto& stamp) {
        constexpr std::uint64_t kSecond = 1'000'000'000;
        stamp.integer("sec", "", static_cast<std::int32_t>(nanoseconds(t) / kSecond));
        stamp.integer("nanosec", "", static_cast<std::uint32_t>(nanoseconds(t) % kSecond));
      });
      header.text("frame_id", "", frame);
    });
}
template <class F, class T>
void stamp_field(F& f, const Measurement<T>& said) {
  f.number("stamp_s", "when it was true", stamp_of(said));
}
template <class F>
void three_fields(F& f, const std::array<double, 3>& xyz) {
  f.number("x", "", xyz[0]);
  f.number("y", "", xyz[1]);
  f.number("z", "", xyz[2]);
}
// Omits the vector if all three numbers are unknown.
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

// foxglove.PoseInFrame or geometry_msgs/PoseStamped: viewers know these names.
template <class F, char A, char B>
void pose_fields(F& f, Time t, const Pose<A, B>& X) {
  static constexpr char kFrame = A;
  header_field(f, t, std::string_view(&kFrame, 1));
  if constexpr (!F::kRos) {
    f.object("timestamp", "", [&](auto& inner) { moment_fields(inner, t); });
    f.text("frame_id", "", std::string_view(&kFrame, 1));
  }
  f.object("pose", "", [&](auto& pose) {
    pose.object("position", "m", [&](auto& inner) { three_fields(inner, X.xyz); });
    pose.object("orientation", "", [&](auto& inner) { turn_fields(inner, X.xyzw); });
  });
}

// foxglove.FrameTransforms or tf2_msgs/TFMessage
struct FixedFrame {
  std::string_view parent, child;
  std::array<double, 4> xyzw{};
  std::array<double, 3> xyz{};
};
template <class F>
void frames_fields(F& f, Time t, const std::vector<FixedFrame>& frames) {
  f.list("transforms", "", frames, [&](auto& one, const FixedFrame& frame) {
    const auto turned = [&](auto& inner) { turn_fields(inner, frame.xyzw); };
    const auto moved = [&](auto& inner) { three_fields(inner, frame.xyz); };
    header_field(one, t, frame.parent);
    if constexpr (F::kRos) {
      one.text("child_frame_id", "", frame.child);
      one.object("transform", "", [&](auto& transform) {
        transform.object("translation", "m", moved);
        transform.object("rotation", "", turned);
      });
    } else {
      one.object("timestamp", "", [&](auto& inner) { moment_fields(inner, t); });
      one.text("parent_frame_id", "", frame.parent);
      one.text("child_frame_id", "", frame.child);
      one.object("translation", "m", moved);
      one.object("rotation", "", turned);
    }
  });
}

template <class F>
void wrench_fields(F& f, const Measurement<Wrench>& wrench) {
  if constexpr (F::kRos) {  // geometry_msgs/WrenchStamped
    header_field(f, wrench.t, "F");
    f.object("wrench", "", [&](auto& inner) {
      vector_field(inner, "force", "N", wrench.value.force);
      vector_field(inner, "torque", "Nm", wrench.value.torque);
    });
    return;
  }
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
  header_field(f, in.arm.t, "R");
  for (std::size_t i = 0; i < joints.size(); ++i) f.number(joints[i], "of the encoder", arm.joints[i]);
  for (std::size_t i = 0; i < speeds.size(); ++i) f.number(speeds[i], "", arm.joint_velocities[i]);
  vector_field(f, "tip_m", "where the encoders say that the tip is, in R", arm.tip);
  vector_field(f, "tip_velocity_m_per_s", "in R", arm.velocity);
  vector_field(f, "told_force_N", "that it is told to push with, in R; gravity included", out.arm.force);
  vector_field(f, "wanted_m", "where its tip shall be, in W", out.arm.target);
  f.number("gain", "of its stiffness along the surface's normal; 1 where no object is rendered",
           out.arm.gain);
  f.number("prop_speed_m_per_s", "of a driven prop's surface against the prop", out.arm.prop_speed);
  vector_field(f, "prop_facing", "that the prop's front shall face, unit, in R", out.arm.prop_facing);
  f.text("health", "what the arm says of itself", word_if_any(in.arm.health));
  stamp_field(f, in.arm);
}

// The haptic core, the gripper and the display.
std::string_view mode_word(Mode mode) {
  return static_cast<int>(mode) < kModes ? mode_name(mode) : "unknown";
}
// Empty for a device that the scene lacks.
std::optional<std::string_view> health_if(bool has, Health health) {
  if (!has) return {};
  return word_if_any(health);
}

template <class F>
void core_fields(F& f, const Scene& scene, const std::vector<std::string>& objects,
                 const std::vector<std::string>& tools, const RecordedTick& frame) {
  const Inputs& in = frame.in;
  const Outputs& out = frame.out;
  header_field(f, frame.tick.t, "W");
  f.integer("tick", "number of the cycle", frame.tick.index);
  f.text("mode", "away, follow, contact, restore, hold, probe or travel", mode_word(out.mode));
  f.text("why", "reasons and notices; empty: none", why_text(out.why));
  f.integer("why_bits", "the same, as bits", out.why);
  f.text_if("object", "the nearest, or the one in contact", name_at(objects, out.object));
  f.text_if("tool", "that the tracker sees", name_at(tools, out.view.tool));
  f.integer("contacts", "since the start", out.contacts);
  f.number("gap_m", "of the tool's tip to the surface; negative inside", out.gap);
  f.number("deflection_m", "wanted; of a probe: measured, negative before it touches", out.deflection);
  vector_field(f, "force_N", "on the tip, low-passed, in N: z along the outward normal", out.force);
  vector_field(f, "felt_N", "the same before the low-pass, in W", out.force_unfiltered);
  vector_field(f, "first_touch_m", "centre of the tip at the first touch of the contact, in W",
               out.first_touch);
  vector_field(f, "tool_tip_m", "centre of the tool's tip as tracked, in W", out.view.tip);
  f.text_if("tool_health", "what the tracker says of itself", health_if(scene.has_tracker, in.tool.health));
  f.text_if("tip_health", "what the machine says of itself", health_if(scene.has_manipulator, in.tip.health));
  f.text_if("wrench_health", "what the sensor says of itself", health_if(scene.has_force, in.wrench.health));
  f.integer("missed_cycles", "that passed before this one without a tick", in.missed);
  f.flag("withheld", "what the machine is told was not sent", in.withheld);
  f.flag("resumed", "the machine's link came back", in.resumed);
}

template <class F>
void surface_fields(F& f, const std::vector<std::string>& objects, const Measurement<DentSample>& dent) {
  header_field(f, dent.t, "O");
  f.text_if("object", "that is dented", name_at(objects, dent.value.object));
  f.number("depth_m", "of the tip's lowest point below the undeformed surface", dent.value.depth);
  vector_field(f, "tip_m", "centre of the tip that dents it, in O", dent.value.tip.centre);
  f.text("health", "what the display says of itself", word_if_any(dent.health));
  stamp_field(f, dent);
}

template <class F>
void gripper_fields(F& f, const Measurement<GripSample>& grip, const Grip& told) {
  header_field(f, grip.t, "R");
  f.flag("told_closed", "what it is told", told.closed);
  f.number("told_force_N", "", told.force);
  f.text("phase", "open, closing, closed or opening", word_if_any(grip.value.phase));
  f.number("opening_m", "between the jaws", grip.value.opening);
  f.number("force_N", "on what is clamped", grip.value.force);
  f.flag("holding", "something is between the jaws", grip.value.holding);
  f.text("health", "what the gripper says of itself", word_if_any(grip.health));
  stamp_field(f, grip);
}

// ---- the file

constexpr std::string_view kMesh = "mesh:";
// Names used in every file. A text of the record with such a name is renamed.
constexpr const char *kTicks = "ticks", *kMissed = "missed_cycles", *kState = "state";

template <class Spec>
std::vector<std::string> names_of(const std::vector<Spec>& specs) {
  std::vector<std::string> names;
  names.reserve(specs.size());
  for (const Spec& spec : specs) names.push_back(spec.name);
  return names;
}

template <char A, char B>
bool is_known(const Pose<A, B>& X) {
  return X.q().coeffs().allFinite() && X.p().allFinite();
}

// Texts of an MCAP file are UTF-8, and readers refuse a file with invalid text. printable() replaces the
// invalid bytes and keeps the line breaks.
std::string lines_for_mcap(std::string_view text) {
  std::string lines;
  for (;;) {
    const std::size_t end = text.find('\n');
    lines += models::printable(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
}

// Appends a mark to a name that exists already, so that no text is lost.
void put_about(RecordTexts& about, std::string_view name, std::string_view text) {
  std::string key = models::printable(name);
  while (about.contains(key)) key += '\'';
  about[key] = lines_for_mcap(text);
}

// The time of a device's sample. Without a sample, the present time.
template <class T>
Time stamp_or(const Measurement<T>& said, Time now) {
  return said.health == Health::absent ? now : said.t;
}

}  // namespace

RecordMcap::RecordMcap(MessageSink& file, const models::Setup& setup, const Scene& scene,
                       const RecordTexts& texts, McapMessages form)
    : file_(file),
      scene_(scene),
      ros2_(form == McapMessages::ros2),
      about_{{kTicks, ""}, {kMissed, ""}, {kState, ""}},
      objects_(names_of(setup.scene.objects)),
      tools_(names_of(setup.scene.tools)) {
  for (const auto& [name, text] : texts) {
    if (name == "resolved")
      file_.attach("resolved.toml", "application/toml", text);
    else if (name.starts_with(kMesh))
      file_.attach(models::printable(name), "application/octet-stream", text);
    else
      put_about(about_, name, text);
  }
  for (const std::string& unit : family_of(scene).joint_units(scene)) {
    joints_.push_back(fmt::format("joint_{}_{}", joints_.size() + 1, unit));
    joint_speeds_.push_back(joints_.back() + "_per_s");
  }
  add_channels();
}

template <class Fields>
std::uint16_t RecordMcap::channel(std::string_view topic, std::string_view schema_name, Fields&& fields) {
  auto schema = schemas_.find(schema_name);
  if (schema == schemas_.end()) {
    const std::uint16_t number =
        ros2_ ? file_.add_schema(ros2_schema(schema_name), "ros2msg", Ros2Schema::of(fields))
              : file_.add_schema(schema_name, "jsonschema", JsonSchema::of(schema_name, fields));
    schema = schemas_.emplace(schema_name, number).first;
  }
  return file_.add_channel(topic, schema->second, ros2_ ? "cdr" : "json");
}

// The content of a channel is defined once: here for its schema, in add() for its messages.
void RecordMcap::add_channels() {
  constexpr std::string_view kPose = "foxglove.PoseInFrame";
  const RecordedTick any;
  frames_ = channel(ros2_ ? "/tf_static" : "/frames", "foxglove.FrameTransforms",
                    [](auto& f) { frames_fields(f, Time{}, std::vector<FixedFrame>{}); });
  const auto pose = [](auto& f) { pose_fields(f, Time{}, Pose<'C', 'T'>{}); };
  if (scene_.has_tracker) tool_ = channel("/tool", kPose, pose);
  if (scene_.has_manipulator) {
    tip_ = channel("/tip", kPose, pose);
    command_ = channel("/command", kPose, pose);
  }
  if (scene_.has_force)
    wrench_ = channel("/wrench", "encounter.Wrench", [&](auto& f) { wrench_fields(f, any.in.wrench); });
  if (!joints_.empty())
    arm_ = channel("/arm", "encounter.Arm",
                   [&](auto& f) { arm_fields(f, joints_, joint_speeds_, any.in, any.out); });
  if (scene_.clamped_tool >= 0)
    gripper_ = channel("/gripper", "encounter.Gripper",
                       [&](auto& f) { gripper_fields(f, any.in.grip, any.out.manipulator.grip); });
  if (scene_.has_display)
    surface_ =
        channel("/surface", "encounter.Surface", [&](auto& f) { surface_fields(f, objects_, any.in.dent); });
  core_ = channel("/core", "encounter.Core", [&](auto& f) { core_fields(f, scene_, objects_, tools_, any); });
}

template <class Fields>
void RecordMcap::say(std::uint16_t channel, Time log, Time publish, Fields&& fields) {
  message_.clear();
  if (ros2_)
    CdrMessage(message_).whole(fields);
  else
    JsonMessage(message_).whole(fields);
  file_.message(channel, nanoseconds(log), nanoseconds(publish), message_);
}

// Adds the poses of the fixed frames, so that a viewer shows all poses in one picture.
void RecordMcap::add_fixed_frames(Time t) {
  std::vector<FixedFrame> fixed;
  if (is_known(scene_.X_WR)) fixed.push_back({"W", "R", scene_.X_WR.xyzw, scene_.X_WR.xyz});
  if (scene_.has_tracker && is_known(scene_.X_WC))
    fixed.push_back({"W", "C", scene_.X_WC.xyzw, scene_.X_WC.xyz});
  say(frames_, t, t, [&](auto& f) { frames_fields(f, t, fixed); });
}

void RecordMcap::add(const RecordedTick& frame) {
  const Time now = frame.tick.t;
  const Inputs& in = frame.in;
  const Outputs& out = frame.out;
  if (ticks_ == 0) add_fixed_frames(now);
  ++ticks_;
  missed_ += in.missed;
  // Write a pose only in the tick that received it.
  const bool seen = in.tool.health == Health::ok && in.tool.value.tool >= 0 && in.tool.t != tool_t_;
  if (tool_ && seen && is_known(in.tool.value.X_CT)) {
    tool_t_ = in.tool.t;
    say(*tool_, now, in.tool.t, [&](auto& f) { pose_fields(f, in.tool.t, in.tool.value.X_CT); });
  }
  if (tip_ && is_known(in.tip.value.X_RH))
    say(*tip_, now, in.tip.t, [&](auto& f) { pose_fields(f, in.tip.t, in.tip.value.X_RH); });
  if (command_ && is_known(out.manipulator.tip))
    say(*command_, now, now, [&](auto& f) { pose_fields(f, now, out.manipulator.tip); });
  if (wrench_) say(*wrench_, now, stamp_or(in.wrench, now), [&](auto& f) { wrench_fields(f, in.wrench); });
  if (arm_)
    say(*arm_, now, stamp_or(in.arm, now), [&](auto& f) { arm_fields(f, joints_, joint_speeds_, in, out); });
  if (gripper_)
    say(*gripper_, now, stamp_or(in.grip, now),
        [&](auto& f) { gripper_fields(f, in.grip, out.manipulator.grip); });
  if (surface_ && in.dent.health != Health::absent && in.dent.t != surface_t_) {
    surface_t_ = in.dent.t;
    say(*surface_, now, in.dent.t, [&](auto& f) { surface_fields(f, objects_, in.dent); });
  }
  say(core_, now, now, [&](auto& f) { core_fields(f, scene_, objects_, tools_, frame); });
}

void RecordMcap::end(const RecordTexts& end_texts, std::string_view state) {
  for (const auto& [name, text] : end_texts)
    if (name == "ledger")
      file_.attach("ledger.csv", "text/csv", text);
    else
      put_about(about_, name, text);
  about_[kTicks] = std::to_string(ticks_);
  about_[kMissed] = std::to_string(missed_);
  about_[kState] = lines_for_mcap(state);
  file_.metadata("encounter", about_);
  file_.close();
}

}  // namespace enc::trial
