#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/base/rotation.h"
#include "models/schema/wording.h"
#include "models/setup/scene_check.h"

namespace enc::models {
namespace {

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

// Signed distance of a point to an object's surface, m; of triangles to the nearest vertex, of a button to
// the ball around it.
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
  double nearest = std::numeric_limits<double>::infinity();  // of a mesh that is not read yet
  if (object.surface == nullptr) return nearest;
  const Vec3 at = rotation_xyz(object.rotation).conjugate() * from / object.scale;
  for (const auto& [x, y, z] : object.surface->vertices)
    nearest = std::min(nearest, object.scale * (Vec3(x, y, z) - at).norm());
  return nearest;
}

// The machine follows a tool to the nearest object, whichever is pressed.
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

// A kind of user that is drawn has a table of its own name; then it presses to a depth.
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

}  // namespace

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

}  // namespace enc::models
