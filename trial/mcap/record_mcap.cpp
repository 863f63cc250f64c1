#include "trial/mcap/record_mcap.h"

#include <algorithm>

#include <fmt/format.h>

#include "models/schema/wording.h"
#include "trial/family.h"
#include "trial/mcap/core_fields.h"
#include "trial/mcap/json_schema.h"
#include "trial/mcap/record_fields.h"

namespace enc::trial {
namespace {

constexpr std::string_view kMesh = "mesh:";
// What is said of every file. A text of the record that is named so gets another name.
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

// Texts of an MCAP file are UTF-8, and readers refuse the file for one that is not: printable() shows each
// byte that is no letter's. The lines stay.
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

// A name that is there already gets a mark behind it, so that no text is lost.
void put_about(RecordTexts& about, std::string_view name, std::string_view text) {
  std::string key = models::printable(name);
  while (about.contains(key)) key += '\'';
  about[key] = lines_for_mcap(text);
}

// When what a device says was true. One that has said nothing has no such time.
template <class T>
Time stamp_or(const Stamped<T>& said, Time now) {
  return said.health == Health::absent ? now : said.t;
}

}  // namespace

RecordMcap::RecordMcap(McapWriter& file, const models::Setup& setup, const Scene& scene,
                       const RecordTexts& texts)
    : file_(file),
      scene_(scene),
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
    const std::string text = JsonSchema::of(schema_name, fields);
    schema = schemas_.emplace(schema_name, file_.add_schema(schema_name, "jsonschema", text)).first;
  }
  return file_.add_channel(topic, schema->second, "json");
}

// What a channel says is written once: here for its schema, in add() for its messages.
void RecordMcap::add_channels() {
  constexpr std::string_view kPose = "foxglove.PoseInFrame";
  const RecordedTick any;
  frames_ = channel("/frames", "foxglove.FrameTransforms",
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
                       [&](auto& f) { gripper_fields(f, any.in.grip, any.out.grip); });
  if (scene_.has_display)
    surface_ =
        channel("/surface", "encounter.Surface", [&](auto& f) { surface_fields(f, objects_, any.in.dent); });
  core_ = channel("/core", "encounter.Core", [&](auto& f) { core_fields(f, scene_, objects_, tools_, any); });
}

template <class Fields>
void RecordMcap::say(std::uint16_t channel, Time log, Time publish, Fields&& fields) {
  message_.clear();
  JsonMessage(message_).whole(fields);
  file_.message(channel, nanoseconds(log), nanoseconds(publish), message_);
}

// Where those frames are that do not move, so that a viewer shows all poses in one picture.
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
  // Only in the tick in which it came.
  const bool seen = in.tool.health == Health::ok && in.tool.value.tool >= 0 && in.tool.t != tool_t_;
  if (tool_ && seen && is_known(in.tool.value.X_CT)) {
    tool_t_ = in.tool.t;
    say(*tool_, now, in.tool.t, [&](auto& f) { pose_fields(f, in.tool.t, in.tool.value.X_CT); });
  }
  if (tip_ && is_known(in.tip.value.X_RH))
    say(*tip_, now, in.tip.t, [&](auto& f) { pose_fields(f, in.tip.t, in.tip.value.X_RH); });
  if (command_ && is_known(out.tip)) say(*command_, now, now, [&](auto& f) { pose_fields(f, now, out.tip); });
  if (wrench_) say(*wrench_, now, stamp_or(in.wrench, now), [&](auto& f) { wrench_fields(f, in.wrench); });
  if (arm_)
    say(*arm_, now, stamp_or(in.arm, now), [&](auto& f) { arm_fields(f, joints_, joint_speeds_, in, out); });
  if (gripper_)
    say(*gripper_, now, stamp_or(in.grip, now), [&](auto& f) { gripper_fields(f, in.grip, out.grip); });
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
