#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "models/scene_check.h"
#include "models/wording.h"

namespace enc::models {
namespace {

void check_pair(const Setup& setup, const std::string& key, const std::vector<double>& pair) {
  if (pair.size() == 2 && pair[0] <= pair[1]) return;
  fail(setup, "user.session." + key,
       fmt::format(
           "'{}' has {}; expected the least and the most; write it like '{} = [1, 2]'", key,
           pair.size() == 2 ? "its first number above its second" : fmt::format("{} numbers", pair.size()),
           key));
}

}  // namespace

void check_session(const Setup& setup) {
  const UserSpec& user = *setup.scene.user;
  if (user.session.has_value() != (user.kind == "session"))
    fail(setup, user.session ? "user.session" : "user.kind",
         fmt::format("'kind' is {} and there is {} [user.session]; expected both or none; {}",
                     quoted(user.kind), user.session ? "a" : "no",
                     user.session ? "write 'kind = \"session\"' or remove the table" : "add the table"));
  if (!user.session) return;
  const SessionSpec& s = *user.session;
  for (const auto& [key, pair] : {std::pair{"tilt_deg", &s.tilt},
                                  {"reach_mm", &s.reach},
                                  {"peak_mm_s", &s.peak_speed},
                                  {"touch_mm_s", &s.touch_speed},
                                  {"depth_mm", &s.depth},
                                  {"press_mm_s", &s.press_speed},
                                  {"hold_s", &s.hold},
                                  {"rest_s", &s.rest},
                                  {"change_share", &s.change}})
    check_pair(setup, key, *pair);
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
  if (!std::isnan(user.push))
    fail(setup, "user.push_N", "a session presses to a depth; expected no 'push_N'; remove it");
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
  const double away = (s.tray - object.position).norm() - object.radius;
  if (!(away > setup.scene.follow.pause))
    fail(setup, "user.session.tray_mm",
         fmt::format(
             "'tray_mm' is {} mm from the surface of {}; expected more than 'follow.pause_mm', {} mm, or "
             "the machine would lose a tool that it follows; move it",
             mm(std::round(away * 1e5) / 1e5), quoted(object.name), mm(setup.scene.follow.pause)));
}

}  // namespace enc::models
