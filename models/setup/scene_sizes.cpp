#include "models/setup/scene_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include <fmt/format.h>

#include "core/control/track/markers.h"
#include "core/control/world/object.h"
#include "models/schema/wording.h"
#include "models/setup/scene_check.h"
#include "models/sizes/mesh_size.h"

namespace enc::models {
namespace {

// Ordinary sizes of things that a hand holds or touches, m.
struct SizeRange {
  double least, most;
  [[nodiscard]] bool has(double length) const { return length >= least && length <= most; }
  [[nodiscard]] std::string text() const {
    return fmt::format("expected {} to {}", length_text(least), length_text(most));
  }
};
constexpr SizeRange kLever{0.020, 1.0};    // distance of a tool's tip from the middle of its markers
constexpr SizeRange kSpan{0.020, 0.5};     // longest distance between two markers
constexpr SizeRange kTip{0.00005, 0.030};  // radius of a tip that is not a point
constexpr SizeRange kObject{0.005, 2.0};   // longest side of a mesh and of a face, and a ball's diameter
// Thickness of the solid behind a button's face.
constexpr SizeRange kThick{0.001, 1.0};
constexpr SizeRange kUsual{0.010, 1.0};  // size assumed for guessing a unit

struct Factor {
  double value;  // factor from this unit to the expected one
  std::string_view unit;
};
constexpr auto kMeshUnits =
    std::to_array<Factor>({{1e-3, "mm"}, {1e-2, "cm"}, {0.0254, "inches"}, {1e3, "km"}});
constexpr auto kKeyUnits = std::to_array<Factor>({{1e3, "m"}, {10.0, "cm"}, {1e-3, "um"}});

double lever_of(const ToolSpec& tool, double of_tip = 1.0, double of_markers = 1.0) {
  return (of_tip * tool.tip - of_markers * middle_of(tool.markers)).norm();
}
double span_of(const ToolSpec& tool) {
  double span = 0.0;
  for (const Vec3& a : tool.markers)
    for (const Vec3& b : tool.markers) span = std::max(span, (a - b).norm());
  return span;
}

// "is 'radius_mm' in m? then write radius_mm = 33; or in cm? then ...": each unit of a key of millimetres
// that gives an ordinary size; else "correct 'radius_mm'". `then`: the remedy for a factor.
std::string unit_advice(std::string_view key, const std::function<bool(double)>& ordinary,
                        const std::function<std::string(double)>& then) {
  std::string text;
  for (const Factor& factor : kKeyUnits)
    if (ordinary(factor.value))
      text += fmt::format("{} {}? then {}", text.empty() ? fmt::format("is '{}' in", key) : "; or in",
                          factor.unit, then(factor.value));
  return text.empty() ? fmt::format("correct '{}'", key) : text;
}

// Advice for a key with one length, m; `across`: multiple of it that is judged as the size.
std::string length_advice(std::string_view key, const SizeRange& ordinary, double length,
                          double across = 1.0) {
  return unit_advice(
      key, [&](double factor) { return ordinary.has(across * factor * length); },
      [&](double factor) { return fmt::format("write {} = {:g}", key, factor * length * 1e3); });
}

Mesh in_world(const ObjectSpec& object) {
  const Pose<'W', 'O'> X_WO = place_of(object);
  Mesh mesh = *object.surface;
  for (auto& vertex : mesh.vertices) {
    const Vec3 at = (X_WO * Point<'O'>(Vec3(object.scale * Vec3(vertex.data())))).e();
    vertex = {at.x(), at.y(), at.z()};
  }
  return mesh;
}

// "is the file in mm? then write scale = 0.001": the units that would give a mesh a usual size; empty: none.
std::string scale_advice(const ObjectSpec& object, double longest) {
  std::string text;
  for (const Factor& factor : kMeshUnits) {
    if (!kUsual.has(factor.value * longest)) continue;
    text += fmt::format("{} {}? then write scale = {:g}", text.empty() ? "is the file in" : "; or in",
                        factor.unit, factor.value * object.scale);
    if (factor.unit == "mm") break;
  }
  return text;
}

// Rounded to the micrometre, as in a file.
std::string millimetres(const Vec3& v) {
  const auto rounded = [](double metres) { return std::round(metres * 1e6) / 1e3 + 0.0; };  // no -0
  return fmt::format("[{}, {}, {}]", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

void warn(Setup& setup, const std::string& key, const std::string& what) {
  setup.notes.push_back(fmt::format("{}: warning: {}", place_of(setup, key), what));
}

// Factor of the first unit that gives the markers an ordinary size: 1 if they have it already or no unit
// helps.
double scale_of_markers(const ToolSpec& tool) {
  const double span = span_of(tool);
  if (kSpan.has(span)) return 1.0;
  const auto* const meant = std::find_if(kKeyUnits.begin(), kKeyUnits.end(),
                                         [&](const Factor& unit) { return kSpan.has(unit.value * span); });
  return meant == kKeyUnits.end() ? 1.0 : meant->value;
}

void note_markers(Setup& setup, const ToolSpec& tool) {
  if (kSpan.has(span_of(tool))) return;
  const std::string advice = markers_advice(tool);
  warn(setup, "tool." + tool.name + ".markers",
       fmt::format("the markers of tool {} are up to {} apart; {}; {}", quoted(tool.name),
                   length_text(span_of(tool)), kSpan.text(),
                   advice.empty() ? "correct 'markers_mm'" : advice));
}

void note_tool(Setup& setup, const ToolSpec& tool) {
  const std::string key = "tool." + tool.name;
  if (tool.tip_radius > 0.0 && !kTip.has(tool.tip_radius))
    warn(setup, key + ".tip_radius",
         fmt::format("the tip of tool {} has a radius of {}; {}; {}", quoted(tool.name),
                     length_text(tool.tip_radius), kTip.text(),
                     length_advice("tip_radius_mm", kTip, tool.tip_radius)));
  if (tool.markers.empty()) return;
  note_markers(setup, tool);
  const double scale = scale_of_markers(tool);
  const double lever = lever_of(tool, 1.0, scale);
  if (kLever.has(lever)) return;
  const std::string advice = unit_advice(
      "tip_mm",
      [&](double factor) { return tool.tip.norm() > 0.0 && kLever.has(lever_of(tool, factor, scale)); },
      [&](double factor) { return fmt::format("write tip_mm = {}", millimetres(factor * tool.tip)); });
  warn(setup, key + ".tip",
       fmt::format("the tip of tool {} is {} from the middle of its markers{}; {}; {}", quoted(tool.name),
                   length_text(lever), scale == 1.0 ? "" : " once these are in mm", kLever.text(), advice));
}

void note_ball(Setup& setup, const ObjectSpec& object) {
  const double diameter = 2.0 * object.radius;
  if (kObject.has(diameter)) return;
  warn(setup, "object." + object.name + ".radius",
       fmt::format("ball {} has a diameter of {}; {}; {}", quoted(object.name), length_text(diameter),
                   kObject.text(), length_advice("radius_mm", kUsual, object.radius, 2.0)));
}

void note_button(Setup& setup, const ObjectSpec& object) {
  struct Side {
    const char *name, *key;
    double length;
    const SizeRange& ordinary;
  };
  for (const Side& side :
       {Side{"width", "width_mm", object.width, kObject}, Side{"height", "height_mm", object.height, kObject},
        Side{"thickness", "thickness_mm", object.thickness, kThick}})
    if (!side.ordinary.has(side.length))
      warn(setup, fmt::format("object.{}.{}", object.name, side.name),
           fmt::format("button {} has a {} of {}; {}; {}", quoted(object.name), side.name,
                       length_text(side.length), side.ordinary.text(),
                       length_advice(side.key, side.ordinary, side.length)));
}

// An object's origin may be out of reach of every machine.
void note_place(Setup& setup, const ObjectSpec& object) {
  // No machine of a laboratory reaches farther, m.
  constexpr double kFarthest = 10.0;
  const double away = object.position.norm();
  if (away <= kFarthest) return;
  const Factor& unit = kKeyUnits.back();
  warn(setup, "object." + object.name + ".position",
       fmt::format("object {} is {} from the origin of W; expected at most {}; {}", quoted(object.name),
                   length_text(away), length_text(kFarthest),
                   unit.value * away <= kFarthest
                       ? fmt::format("is 'position_mm' in {}? then write position_mm = {}", unit.unit,
                                     millimetres(unit.value * object.position))
                       : "correct 'position_mm'"));
}

void note_box(Setup& setup, const ObjectSpec& object) {
  if (kObject.has(object.size.maxCoeff())) return;
  warn(setup, "object." + object.name + ".size",
       fmt::format("box {} is {}; expected a longest side of {} to {}; {}", quoted(object.name),
                   extent_text(object.size), length_text(kObject.least), length_text(kObject.most),
                   unit_advice(
                       "size_mm", [&](double factor) { return kUsual.has(factor * object.size.maxCoeff()); },
                       [&](double factor) {
                         return fmt::format("write size_mm = {}", millimetres(factor * object.size));
                       })));
}

void note_mesh(Setup& setup, const ObjectSpec& object) {
  const Vec3 extent = MeshBox(in_world(object)).extent();
  if (kObject.has(extent.maxCoeff())) return;
  const std::string advice = scale_advice(object, extent.maxCoeff());
  warn(setup, "object." + object.name + ".mesh",
       fmt::format("mesh {} is {}; expected a longest side of {} to {}; {}", quoted(object.mesh),
                   extent_text(extent), length_text(kObject.least), length_text(kObject.most),
                   advice.empty() ? "correct its 'scale'" : advice));
}

}  // namespace

void note_sizes(Setup& setup) {
  for (const ToolSpec& tool : setup.scene.tools) note_tool(setup, tool);
  for (const ObjectSpec& object : setup.scene.objects) {
    if (object.shape == ShapeKind::mesh) note_mesh(setup, object);
    if (object.shape == ShapeKind::box) note_box(setup, object);
    if (object.shape == ShapeKind::sphere) note_ball(setup, object);
    if (object.shape == ShapeKind::button) note_button(setup, object);
    if (object.shape != ShapeKind::mesh) note_place(setup, object);
  }
}

std::string markers_advice(const ToolSpec& tool) {
  const double span = span_of(tool);
  if (kSpan.has(span) || scale_of_markers(tool) == 1.0) return "";
  return unit_advice(
      "markers_mm", [&](double factor) { return kSpan.has(factor * span); },
      [](double factor) { return fmt::format("multiply each number of it by {:g}", factor); });
}

std::string sizes_text(const Setup& setup) {
  std::string text;
  const auto add = [&](const std::string& line) {
    text += fmt::format("{:12}{}\n", text.empty() ? "sizes" : "", line);
  };
  for (const ToolSpec& tool : setup.scene.tools) {
    std::string markers;
    if (!tool.markers.empty())
      markers = fmt::format(", {} from the middle of its {} markers, up to {} apart",
                            length_text(lever_of(tool)), tool.markers.size(), length_text(span_of(tool)));
    add(fmt::format("tool {}: tip radius {}{}; {:g} g", quoted(tool.name), length_text(tool.tip_radius),
                    markers, tool.mass * 1e3));
  }
  for (const ObjectSpec& object : setup.scene.objects) {
    if (object.shape != ShapeKind::mesh) continue;
    const MeshSize size = size_of(in_world(object));
    add(fmt::format("mesh {} ({}): {}, middle at {} of W, volume {}, {} faces", quoted(object.name),
                    printable(object.mesh), extent_text(size.extent), place_text(size.middle),
                    volume_text(size.volume), size.faces));
  }
  return text;
}

std::string mesh_advice(const Setup& setup, const std::string& key) {
  const std::vector<ObjectSpec>& objects = setup.scene.objects;
  const std::string pressed = key.starts_with("user.") && setup.scene.user       ? setup.scene.user->object
                              : key.starts_with("pusher.") && setup.scene.pusher ? setup.scene.pusher->object
                                                                                 : std::string();
  const bool named = key.starts_with("object.") && key.ends_with(".position");
  if (!named && !key.starts_with("user.") && !key.starts_with("pusher.")) return {};
  const auto is_meant = [&](const ObjectSpec& object) {
    return named ? key == "object." + object.name + ".position" : pressed.empty() || pressed == object.name;
  };
  const auto object = std::find_if(objects.begin(), objects.end(), is_meant);
  if (object == objects.end() || object->shape != ShapeKind::mesh) return {};
  const MeshSize size = size_of(in_world(*object));
  const double longest = size.extent.maxCoeff();
  std::string advice;
  if (!kObject.has(longest)) advice = scale_advice(*object, longest);
  if (advice.empty() && size.middle.norm() > longest)
    advice = fmt::format("position_mm = {} puts its middle at the origin of W",
                         millimetres(object->position - size.middle));
  return fmt::format("; mesh {} is {} in this scene, with its middle at {} of W{}{}", quoted(object->mesh),
                     extent_text(size.extent), place_text(size.middle), advice.empty() ? "" : ": ", advice);
}

}  // namespace enc::models
