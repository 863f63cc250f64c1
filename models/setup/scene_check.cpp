// Checks of several keys together. Core's prepare() checks the conditions that need the machine (reach,
// monotone curves).
#include "models/setup/scene_check.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/words.h"
#include "core/control/task/indentation/indentation.h"
#include "core/control/world/object.h"
#include "core/devices/roles.h"
#include "core/spec/vision_check.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/calibration_files.h"
#include "models/setup/scene_file.h"

namespace enc::models {
namespace {

// `table` names an entry of [[list]].
template <class T>
void check_named(const Setup& setup, const std::vector<T>& items, const std::string& name,
                 const std::string& list, const std::string& table = "user") {
  const std::vector<std::string> names = names_of(items);
  if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) return;
  fail(setup, table + "." + list,
       fmt::format("there is no {} {}; expected the name of a [[{}]]; {}", list, quoted(name), list,
                   advice(name, names)));
}

// Only an object pressed by the probe may be real instead of rendered.
void check_real(const Setup& setup, const ObjectSpec& o) {
  const std::string path = "object." + o.name;
  const bool probed = setup.scene.probe && &o == &probed_object(setup.scene);
  if (!probed) {
    fail(setup, path,
         fmt::format("object {} has no 'behaviour'; expected one, because {}; write it like 'behaviour = "
                     "\"{}\"'",
                     quoted(o.name),
                     setup.scene.probe ? "[probe] does not press it" : "nothing else says what is felt",
                     checks_of(setup.scene).behaviour));
  }
  if (!std::isnan(o.limit) || !o.limits.empty()) {
    const char* key = o.limits.empty() ? "limit_mm" : "limits_mm";
    fail(setup, fmt::format("{}.{}", path, key),
         fmt::format("object {} is real and has a '{}'; expected none, or a 'behaviour' that it limits; "
                     "remove it",
                     quoted(o.name), key));
  }
}

// `most`: end of the behaviour, 0 while it is unknown.
void check_contacts(const Setup& setup, const ObjectSpec& o, double most, const std::string& behaviour) {
  const LimitCheck found = check_limits(o, most);
  if (found.fault == LimitFault::none) return;
  const bool several = !o.limits.empty();
  const std::string key = fmt::format("object.{}.{}", o.name, several ? "limits_mm" : "limit_mm");
  const auto wrong = [&](const std::string& expected) {
    fail(setup, key,
         fmt::format("'{}' is {}; expected {}",
                     several ? fmt::format("limits_mm[{}]", found.index) : "limit_mm",
                     mm(several ? o.limits[found.index] : o.limit), expected));
  };
  switch (found.fault) {
    case LimitFault::none:
      return;
    case LimitFault::two_keys:
      fail(setup, key,
           fmt::format("object {} has both 'limit_mm' and 'limits_mm'; expected one of them; remove one",
                       quoted(o.name)));
    case LimitFault::too_many:
      fail(setup, key,
           fmt::format("'limits_mm' has {} elements; expected at most {}; the last one stays for all further "
                       "contacts; remove some",
                       o.limits.size(), ContactLimits::kMost));
    case LimitFault::not_positive:
      return wrong("a positive number; raise it");
    case LimitFault::beyond_radius:
      return wrong(fmt::format("less than the radius, {} mm; lower it", mm(o.radius)));
    case LimitFault::beyond_behaviour:
      return wrong(
          fmt::format("at most {} mm, where behaviour {} ends; lower it", mm(most), quoted(behaviour)));
  }
}

void check_object(const Setup& setup, const ObjectSpec& o) {
  const std::string path = "object." + o.name;
  if (o.shape == ShapeKind::plane || o.shape == ShapeKind::button) {
    check_unit(setup, path + ".normal", o.normal);  // mend_normals() has scaled every vector with a direction
  }
  if (o.behaviour.empty()) return check_real(setup, o);
  const auto b = std::find_if(setup.scene.behaviours.begin(), setup.scene.behaviours.end(),
                              [&](const BehaviourSpec& item) { return item.name == o.behaviour; });
  if (b == setup.scene.behaviours.end()) {
    fail(setup, path + ".behaviour",
         fmt::format("there is no behaviour {}; expected a [[behaviour]]; {}", quoted(o.behaviour),
                     advice(o.behaviour, names_of(setup.scene.behaviours))));
  }
  const double most = std::isnan(b->limit) ? b->curves.limit : b->limit;
  check_contacts(setup, o, most, b->name);
}

// Called before and after the curves are loaded.
void check_behaviour(const Setup& setup, const BehaviourSpec& b) {
  if (b.interaction.kind != Interaction::press) return check_interaction(setup, b);
  const std::string path = "behaviour." + b.name;
  const bool linear = !std::isnan(b.stiffness);
  if (linear && !b.response.empty()) {
    fail(setup, path + ".stiffness_N_per_mm",
         fmt::format(
             "behaviour {} has both 'response' and 'stiffness_N_per_mm'; expected one of them; remove one",
             quoted(b.name)));
  }
  if (!linear && b.response.empty()) {
    fail(setup, path,
         fmt::format("behaviour {} says nothing about its force; expected 'response' or "
                     "'stiffness_N_per_mm'; add 'response = \"tennis_ball\"'",
                     quoted(b.name)));
  }
  if (linear && std::isnan(b.limit)) {
    fail(setup, path,
         fmt::format(
             "behaviour {} has no 'limit_mm'; expected one with 'stiffness_N_per_mm'; add 'limit_mm = 6'",
             quoted(b.name)));
  }
  if (b.curves.limit > 0.0 && b.limit > b.curves.limit) {
    fail(setup, path + ".limit_mm",
         fmt::format("'limit_mm' is {}; expected at most {} mm, where response {} ends; lower it",
                     mm(b.limit), mm(b.curves.limit), quoted(b.response)));
  }
}

// ---- [user.session] and [user.reaches].

void check_pair(const Setup& setup, const std::string& table, const std::string& key,
                const std::vector<double>& pair) {
  if (pair.size() == 2 && pair[0] <= pair[1]) return;
  fail(setup, table + "." + key,
       fmt::format("'{}' has {}; expected the least and the most; write it like '{} = [1, 2]'", key,
                   pair.size() == 2 ? "its first number above its second" : counted(pair.size(), "number"),
                   key));
}

void check_ranges(const Setup& setup, const std::string& table, const ReachRanges& r) {
  for (const auto& [key, pair] : {std::pair{"tilt_deg", &r.tilt},
                                  {"reach_mm", &r.reach},
                                  {"peak_mm_s", &r.peak_speed},
                                  {"touch_mm_s", &r.touch_speed},
                                  {"depth_mm", &r.depth},
                                  {"press_mm_s", &r.press_speed},
                                  {"hold_s", &r.hold},
                                  {"rest_s", &r.rest}})
    check_pair(setup, table, key, *pair);
}

// Signed distance of a point to an object's surface, m. Triangles: to the nearest vertex. Button: to the ball
// around it.
double distance_to(const ObjectSpec& object, const Vec3& point) {
  const Vec3 from = point - object.position;
  switch (object.shape) {
    case ShapeKind::plane:
      return from.dot(object.normal);
    case ShapeKind::sphere:
      return from.norm() - object.radius;
    case ShapeKind::button:
      return from.norm() - Vec3(object.width, object.height, object.thickness).norm();
    case ShapeKind::mesh:
    case ShapeKind::box:
      break;
  }
  double nearest = std::numeric_limits<double>::infinity();  // a mesh may not be loaded yet
  if (object.surface == nullptr) return nearest;
  const Vec3 at = rotation_xyz(object.rotation).conjugate() * from / object.scale;
  for (const auto& [x, y, z] : object.surface->vertices)
    nearest = std::min(nearest, object.scale * (Vec3(x, y, z) - at).norm());
  return nearest;
}

// The machine follows a tool to the nearest object, whether or not it is pressed.
void check_tray(const Setup& setup, const SessionSpec& s) {
  for (const ObjectSpec& object : setup.scene.objects)
    for (const double beside : {0.0, SessionSpec::kTrayBeside}) {
      const double away = distance_to(object, s.tray + beside * Vec3::UnitY());
      if (away > setup.scene.follow.pause) continue;
      fail(setup, "user.session.tray_mm",
           fmt::format("'tray_mm' is {} mm from the surface of {}{}; expected more than 'follow.pause_mm', "
                       "{} mm, or the machine follows the tool there and loses it; move it away",
                       mm(std::round(away * 1e5) / 1e5), quoted(object.name),
                       beside > 0.0 ? ", the other tool's place 80 mm beside it" : "",
                       mm(setup.scene.follow.pause)));
    }
}

// A random kind of user has a table of its own name, and presses to a depth.
bool has_table(const Setup& setup, UserKind kind, bool there) {
  const UserSpec& user = *setup.scene.user;
  const std::string_view word = word_of(kind);
  if (there != (user.kind == kind))
    fail(setup, fmt::format("user.{}", there ? word : "kind"),
         fmt::format(
             "'kind' is '{}' and there is {} [user.{}]; expected both or none; {}", word_of(user.kind),
             there ? "a" : "no", word,
             there ? fmt::format("write 'kind = \"{}\"' or remove the table", word) : "add the table"));
  if (there && !std::isnan(user.push))
    fail(setup, "user.push_N",
         fmt::format("a user of kind {} presses to a depth; expected no 'push_N'; remove it",
                     quoted(std::string(word))));
  return there;
}

void check_reaches(const Setup& setup) {
  const UserSpec& user = *setup.scene.user;
  if (!has_table(setup, UserKind::reaches, user.reaches.has_value())) return;
  check_ranges(setup, "user.reaches", *user.reaches);
  for (const ObjectSpec& object : setup.scene.objects)
    if (has_triangles(object.shape))
      fail(setup, fmt::format("object.{}.shape", object.name),
           fmt::format("a user of kind \"reaches\" reaches for every object and {} is a {}; expected "
                       "planes, buttons and spheres; write 'kind = \"press_release\"' for one object",
                       quoted(object.name), word_of(object.shape)));
  const double farthest = user.reaches->reach[1];
  if (!(farthest > setup.scene.follow.pause))
    fail(setup, "user.reaches.reach_mm",
         fmt::format("a reach begins {} mm from its place at most; expected more than 'follow.pause_mm', {} "
                     "mm, so that the finger is away before; raise it",
                     mm(farthest), mm(setup.scene.follow.pause)));
}

void check_session(const Setup& setup) {
  const UserSpec& user = *setup.scene.user;
  if (!has_table(setup, UserKind::session, user.session.has_value())) return;
  const SessionSpec& s = *user.session;
  check_ranges(setup, "user.session", s);
  check_pair(setup, "user.session", "change_share", s.change);
  const auto first = [](const auto& items, const std::string& name) -> const auto& {
    const auto named =
        std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
    return named == items.end() ? items.front() : *named;
  };
  const ObjectSpec& object = first(setup.scene.objects, user.object);
  if (object.shape != ShapeKind::sphere)
    fail(
        setup, "user.object",
        fmt::format("a session presses a ball and {} is none; expected a sphere; name one, or write 'shape = "
                    "\"sphere\"'",
                    quoted(object.name)));
  if (s.other_tool.empty()) return;
  const std::vector<std::string> tools = names_of(setup.scene.tools);
  if (std::find(tools.begin(), tools.end(), s.other_tool) == tools.end())
    fail(setup, "user.session.other_tool",
         fmt::format("there is no tool {}; expected the name of a [[tool]]; {}", quoted(s.other_tool),
                     advice(s.other_tool, tools)));
  if (s.other_tool == first(setup.scene.tools, user.tool).name)
    fail(setup, "user.session.other_tool",
         fmt::format("'other_tool' is {}, which is held already; expected another tool; name it, or leave it "
                     "out for no change",
                     quoted(s.other_tool)));
  check_tray(setup, s);
}

void check_user(const Setup& setup) {
  if (!setup.scene.user) return;
  if (setup.scene.tools.empty()) {
    fail(setup, "user", "the user has no tool; expected at least one [[tool]]; add one or remove [user]");
  }
  check_named(setup, setup.scene.objects, setup.scene.user->object, "object");
  check_named(setup, setup.scene.tools, setup.scene.user->tool, "tool");
  check_session(setup);
  check_reaches(setup);
}

// Limits of the simulated ball's law (sim/bodies/ball_plant.h). A real machine may press other objects.
void check_probe(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.probe || setup.rig.force.driver != "sim") return;
  constexpr double kRadius = 10e-3, kDeepest = 8e-3;  // m
  const ObjectSpec& object = probed_object(s);
  if (object.shape != ShapeKind::sphere) {
    fail(setup, fmt::format("object.{}.shape", object.name),
         "the simulated rig has a ball to press and nothing else; expected a sphere; write it like 'shape = "
         "\"sphere\"'");
  }
  if (std::abs(s.probe->radius - kRadius) > 1e-9) {
    fail(setup, "probe.radius_mm",
         fmt::format("'radius_mm' is {}; expected 10, because the law of the simulated ball holds for that "
                     "probe only; write it like 'radius_mm = 10'",
                     mm(s.probe->radius)));
  }
  if (s.probe->depth > kDeepest) {
    fail(setup, "probe.depth_mm",
         fmt::format(
             "'depth_mm' is {}; expected at most {}, where the law of the simulated ball ends; lower it",
             mm(s.probe->depth), mm(kDeepest)));
  }
}

// A pusher is alone with the machine and its force sensor: force alone makes the contact.
void check_pusher(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.pusher) return;
  check_named(setup, s.objects, s.pusher->object, "object", "pusher");
  const auto alone = [&](bool there, const char* table) {
    if (there)
      fail(setup, table,
           fmt::format("the scene has both [pusher] and [{}]; expected one of them; remove one", table));
  };
  alone(s.user.has_value(), "user");
  alone(s.probe.has_value(), "probe");
  alone(s.tracker.has_value(), "tracker");
  alone(s.display.has_value(), "display");
  if (!s.force)
    fail(setup, "pusher", "the tip cannot feel the pusher; expected a [force]; add it or remove [pusher]");
  if (s.pusher->rest_time < setup.rig.force.tare_time)
    fail(setup, "pusher.rest_s",
         fmt::format("'rest_s' is {:g}; expected at least 'rig.force.tare_time_s', {:g}, in which the force "
                     "zero is found; raise it",
                     s.pusher->rest_time, setup.rig.force.tare_time));
}

// The user does not hold the tool that the gripper clamps.
void check_gripper(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.gripper) return;
  if (s.tools.empty())
    fail(setup, "gripper",
         "the gripper has no tool; expected at least one [[tool]]; add one or remove [gripper]");
  check_named(setup, s.tools, s.gripper->tool, "tool", "gripper");
  const auto first = [&](const std::string& name) { return name.empty() ? s.tools.front().name : name; };
  if (s.user && first(s.user->tool) == first(s.gripper->tool))
    fail(setup, "gripper.tool",
         fmt::format("tool {} is both clamped and held by the user; expected another one; name it in "
                     "'gripper.tool' or remove [user]",
                     quoted(first(s.gripper->tool))));
  const sim::GripperTruth& g = setup.twin.gripper;
  if (g.force_max < g.force_min)
    fail(setup, "truth.gripper.force_max_N",
         "'force_max_N' is less than 'force_min_N'; expected at least that; raise it");
  if (g.width > 2.0 * g.stroke)
    fail(setup, "truth.gripper.width_mm",
         fmt::format("'width_mm' is {}; expected at most {} mm, which the jaws open; lower it", mm(g.width),
                     mm(2.0 * g.stroke)));
}

// ---- The camera and the objects in its view.

// The reason why a finger at the object would be out of view, by the rig's camera pose; empty if it is in
// view. Pinholes are enough: the distortion at the edge of an image does not matter here.
std::string unseen(const RigSpec& rig, const ObjectSpec& object) {
  const StereoRig& camera = rig.camera;
  const Point<'C'> at = pose_of<'W', 'C'>(rig.frames.W_C).inverse() * Point<'W'>(object.position);
  const double depth = at.xyz[2];
  if (!(depth > 0.0)) return "behind it";
  const MatchSpec& match = rig.vision.match;
  if (depth < match.nearest || depth > match.farthest)
    return fmt::format("{} mm before it, where {} to {} mm are matched", mm(std::round(depth * 1e3) * 1e-3),
                       mm(match.nearest), mm(match.farthest));
  const auto outside = [&](const Lens& lens, const Vec3& p) {
    const double column = lens.centre_x + lens.focal_x * p.x() / p.z();
    const double row = lens.centre_y + lens.focal_y * p.y() / p.z();
    return !(p.z() > 0.0 && column >= 0.0 && row >= 0.0 && column <= static_cast<double>(camera.width - 1) &&
             row <= static_cast<double>(camera.height - 1));
  };
  if (outside(camera.left, at.e())) return "outside of the left image";
  if (outside(camera.right, (camera.X_CD.inverse() * at).e())) return "outside of the right image";
  return {};
}

// Detects a registration of another rig before anything moves: the camera would not see the objects.
void check_views(const Setup& setup) {
  const std::vector<ObjectSpec>& objects = setup.scene.objects;
  const auto seen = [&](const ObjectSpec& object) { return unseen(setup.rig, object).empty(); };
  if (objects.empty() || std::any_of(objects.begin(), objects.end(), seen)) return;
  fail(setup, "rig.frames.W_C",
       fmt::format("a camera that stands there would have object {} {}{}; expected the registration of this "
                   "rig; make it by `encounter calibrate camera`",
                   quoted(objects.front().name), unseen(setup.rig, objects.front()),
                   objects.size() > 1 ? ", and none of the others in view" : ""));
}

// Compares the twin's camera with the rig's.
void check_twin(const Setup& setup) {
  const StereoRig& believed = setup.rig.camera;
  const sim::CameraTruth& truth = setup.twin.camera;
  if (believed.width != truth.width || believed.height != truth.height)
    fail(setup, "rig.camera.width_px",
         fmt::format("the rig's images are {} x {} px and the twin's {} x {}; expected the same; correct "
                     "'width_px' and 'height_px' here or in [truth.camera]",
                     believed.width, believed.height, truth.width, truth.height));
  if (!std::isnan(truth.back_at) && !(truth.back_at > truth.stalls_at))
    fail(setup, "truth.camera.back_at_s",
         fmt::format(
             "'back_at_s' is {:g}; expected more than 'stalls_at_s', at which the frames stop; correct "
             "one of them",
             truth.back_at));
}

// Vision detects a bare fingertip only.
void check_camera(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.camera) return;
  if (!s.tracker)
    fail(setup, "camera",
         "the scene has a [camera] and nothing that looks through it; expected a [tracker]; add it");
  if (!checks_of(s).bare_finger)
    fail(setup, "camera",
         "vision sees a bare finger, which has no markers; expected an [arm] that meets it; remove [camera]");
  if (s.tools.size() > 1)
    fail(setup, "camera",
         "vision sees one finger and tells no tools apart; expected one [[tool]]; remove the others");
  try {
    check_stereo(setup.rig.camera);
  } catch (const Error& e) {
    fail(setup, "rig.camera." + e.key(), e.what());
  }
  try {
    check(setup.rig.camera, setup.rig.vision);
  } catch (const Error& e) {
    fail(setup, e.key(), e.what());
  }
  if (setup.rig.camera.driver == "sim") check_twin(setup);  // the view depends on the image size
  check_views(setup);
}

// ---- the rig

void check_driver(const Setup& setup, bool named, const std::string& table, const std::string& driver) {
  if (!named || driver != "none") return;
  fail(setup, table,
       fmt::format("the scene names [{}] and rig {} has none; expected a [{}] with a driver; add it to the "
                   "rig, or use '--rig {}'",
                   table, quoted(setup.rig_path), table, checks_of(setup.scene).rig));
}

void check_calibration(const Setup& setup) {
  const std::string& date = setup.rig.calibration.date;
  if (date.empty() || day_of(date)) return;
  fail(setup, "rig.calibration.date",
       fmt::format(
           "'date' is {}; expected a day, as \"2026-11-27\"; write the day on which the rig was measured",
           quoted(date)));
}

void check_rig(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  const RigSpec& r = setup.rig;
  check_driver(setup, s.camera.has_value(), "camera", r.camera.driver);
  check_camera(setup);
  check_calibration(setup);
  each_device([&](const auto& role) {
    check_driver(setup, (s.*role.scene).has_value(), role.table, (r.*role.rig).driver);
  });
  if (r.tracker.lost_age < r.tracker.usual_age) {
    fail(setup, "rig.tracker.lost_age_ms",
         "'lost_age_ms' is less than 'usual_age_ms'; expected at least that; raise it");
  }
}

// A haptic period needs a whole number of physics steps, and not so many that a run never ends.
void check_stepping(const Setup& setup) {
  constexpr double kMost = 1000.0;
  const sim::Stepping stepping = setup.twin.stepping(setup.scene);
  const double rate = setup.rig.loop.rate, period = 1e6 / rate;  // us
  if (stepping.timestep * rate * kMost < 1.0 - 1e-6)
    fail(
        setup, stepping.table + ".timestep_us",
        fmt::format("'timestep_us' is {:g}; expected at least a thousandth of the haptic period, {:g}; raise "
                    "it",
                    stepping.timestep * 1e6, period / kMost));
  if (stepping.steps_per_tick(rate) == 0)
    fail(setup, stepping.table + ".timestep_us",
         fmt::format(
             "'timestep_us' does not divide the haptic period, {} us; expected a whole share of it, such "
             "as 'timestep_us = {}'",
             period, period));
}

}  // namespace

void fail(const Setup& setup, const std::string& key, const std::string& what) {
  throw Error(fmt::format("{}: {}", place_of(setup, key), what));
}

std::string mm(double metres) { return text_of(unit_of("x_mm"), metres); }

void check_unit(const Setup& setup, const std::string& key, const Vec3& v) {
  const double length = v.stableNorm();
  if (std::abs(length - 1.0) < 1e-6) return;
  const bool none = !(length > kNoWay);
  const Vec3 u = none ? Vec3(0, 0, 1) : Vec3(v / length);
  const std::string name = key.substr(key.rfind('.') + 1);
  fail(setup, key,
       fmt::format("'{}' has length {:.6g}{}; expected length 1; write it like '{} = [{}, {}, {}]'", name,
                   length, none ? " and no direction" : "", name, u.x(), u.y(), u.z()));
}

// As with [user] and a real tracker: the scene describes the pushes, and a real pusher must perform them.
void note_pusher(Setup& setup) {
  const std::string& driver = setup.rig.force.driver;
  if (!setup.scene.pusher || driver == "none" || driver == "sim") return;
  setup.notes.push_back(
      fmt::format("{}: warning: [pusher] is simulated and the rig's force sensor is {}, which feels what is "
                  "there: somebody has to push, or `encounter fake` with this scene",
                  place_of(setup, "pusher"), quoted(driver)));
}

void check(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (s.objects.empty() && !s.travel)
    fail(
        setup, "",
        "the scene has no object; expected at least one [[object]]; add one, as in models/scenes/plane.toml");
  if (s.probe) check_named(setup, s.objects, s.probe->object, "object", "probe");
  for (const ObjectSpec& object : s.objects) check_object(setup, object);
  for (const BehaviourSpec& behaviour : s.behaviours) check_behaviour(setup, behaviour);
  for (const ToolSpec& tool : s.tools) checks_of(s).tool(setup, tool);
  if (s.follow.resume > s.follow.pause) {
    fail(setup, "follow.resume_mm",
         fmt::format("'resume_mm' is {}; expected at most 'pause_mm', {} mm; lower it", mm(s.follow.resume),
                     mm(s.follow.pause)));
  }
  check_user(setup);
  check_probe(setup);
  check_pusher(setup);
  check_gripper(setup);
  checks_of(s).scene(setup);
  check_rig(setup);
  check_stepping(setup);
}

void note_views(Setup& setup) {
  if (!setup.scene.camera) return;
  const std::vector<ObjectSpec>& objects = setup.scene.objects;
  const auto hidden = [&](const ObjectSpec& object) { return !unseen(setup.rig, object).empty(); };
  const auto first = std::find_if(objects.begin(), objects.end(), hidden);
  if (first == objects.end()) return;
  const auto others = std::count_if(objects.begin(), objects.end(), hidden) - 1;
  setup.notes.push_back(fmt::format(
      "{}: warning: a camera that stands at [frames.W_C] has object {} {}{}, where no finger is seen; "
      "move it, or register the camera again",
      place_of(setup, "object." + first->name), quoted(first->name), unseen(setup.rig, *first),
      others > 0 ? fmt::format(", and {} more out of view", others) : ""));
}

}  // namespace enc::models
