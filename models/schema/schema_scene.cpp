// Keys of a scene: models/scenes/*.toml, models/behaviours.toml, models/responses/*.toml.
#include "models/schema/schema_walk.h"

namespace enc::models {
namespace {

using enum Confidence;
using enum Presence;

Key name_key(std::string_view meaning) { return {"name", meaning, kAuthor, chosen, kAny, needed, {}, true}; }

void describe_mesh(Visitor& v, ObjectSpec& o) {
  v.value({"mesh", "file (.obj, .stl, .gltf, .glb; m) beside the scene or in models/meshes", kAuthor, chosen,
           kAny, needed},
          &o.mesh);
  v.value({"mesh_hash",
           "hash of the mesh's content: a changed mesh is refused; empty: accept any",
           kAuthor,
           chosen,
           kAny,
           defaulted,
           {},
           true},
          &o.mesh_hash);
  v.value({"scale", "factor on the coordinates of the mesh file", kAuthor, chosen, kPositive}, &o.scale);
}

void describe(Visitor& v, ObjectSpec& o) {
  v.value(name_key("name for --set, [user] and the report"), &o.name);
  choice(v, {"shape", "shape of the undeformed surface", kAuthor, chosen, kAny, needed}, o.shape);
  if (o.shape == ShapeKind::sphere) {
    v.value({"radius_mm", "radius of the sphere", "[VHMR 4.2], sources/ball 1", chosen, kPositive, needed},
            &o.radius);
  }
  if (o.shape == ShapeKind::mesh) describe_mesh(v, o);
  if (o.shape == ShapeKind::box)
    v.value({"size_mm", "edge lengths along x, y and z of O", kAuthor, chosen, kPositive, needed}, &o.size);
  if (has_triangles(o.shape))
    v.value({"rotation_deg", "about the fixed x, then y, then z axis of W", kAuthor, chosen}, &o.rotation);
  v.value({"position_mm", "position of its origin O in W", kAuthor, chosen, kAny, needed}, &o.position);
  if (o.shape == ShapeKind::plane || o.shape == ShapeKind::button)
    v.value({"normal", "outward unit normal, in W", kAuthor, chosen}, &o.normal);
  if (o.shape == ShapeKind::button) {
    v.value({"width_mm", "width of the face", "[VisHap 2.2]", chosen, kPositive, needed}, &o.width);
    v.value({"height_mm", "height of the face", "[VisHap 2.2]", chosen, kPositive, needed}, &o.height);
    v.value({"thickness_mm", "thickness of the solid behind the face", "docs/reference/objects.md", chosen,
             kPositive},
            &o.thickness);
  }
  v.value({"behaviour",
           "how the object pushes back: a [[behaviour]] of this file or of models/behaviours.toml; empty: a "
           "real object, for [probe] only",
           kAuthor, chosen},
          &o.behaviour);
  v.value({"limit_mm", "deflection limit that the device enforces; unset: the behaviour's", "[VHMR 4.2]",
           chosen, kPositive, optional},
          &o.limit);
  v.value({"limits_mm",
           "deflection limits of the first, second, ... contact; the last one stays; unset: limit_mm",
           "[VHMR 4.3]", chosen, kPositive, optional},
          &o.limits);
  choice(
      v,
      {"material", "look in pictures; unnamed: that of the mesh file, else by shape", "[VHMR 3.5]", chosen},
      o.material);
}

void describe(Visitor& v, ToolSpec& t) {
  v.value(name_key("name for --set, [user] and the report"), &t.name);
  v.value({"markers_mm", "positions of at least 3 markers in T, by which the tool is recognised",
           "[VHMR 3.2]", chosen},
          &t.markers);
  v.value({"tip_mm", "centre of the tip's sphere in T", "[VHMR 3.2]", chosen, kAny, needed}, &t.tip);
  v.value({"tip_radius_mm", "radius of the tip; 0: a point", kAuthor, chosen, {0.0, 1000.0}}, &t.tip_radius);
  choice(v, {"tip_shape", "shape of the tip that displaces the seen surface", "[VHMR 3.5]", chosen},
         t.tip_shape);
  if (t.tip_shape != TipShape::sphere)
    v.value({"tip_axis",
             "unit vector in T; cone: from the apex into the tool; edge: along the edge",
             kAuthor,
             chosen,
             {-1.0, 1.0},
             needed},
            &t.tip_axis);
  if (t.tip_shape == TipShape::cone)
    v.value({"tip_half_angle_deg", "half angle of the cone", kAuthor, chosen, {1.0, 80.0}, needed},
            &t.tip_half_angle);
  if (t.tip_shape == TipShape::edge)
    v.value({"tip_edge_mm",
             "length of the edge, without its round ends",
             kAuthor,
             chosen,
             {0.0, 500.0, true},
             needed},
            &t.tip_edge);
  constexpr Range kWeighs{1e-6};  // kg: no tool is lighter than a milligram
  v.value({"mass_kg", "mass of the tool with its markers", "sources/hand 1", assumed, kWeighs}, &t.mass);
}

void describe(Visitor& v, FollowSpec& f) {
  v.value({"inset_mm", "distance inside the surface at which the haptic-tip waits", "sources/choices 11",
           chosen, kPositive},
          &f.inset);
  v.value({"pause_mm", "distance beyond which a tool is not followed", "[VHMR 3.3]", published, kPositive},
          &f.pause);
  v.value(
      {"resume_mm", "distance below which a tool is followed again", "sources/hexapod 7", assumed, kPositive},
      &f.resume);
  v.value({"hysteresis_mm", "difference of distance by which another object must be nearer to be chosen",
           "[VisHap 3]", assumed, kNotNegative},
          &f.hysteresis);
  v.value({"ahead_ms", "time ahead for whose predicted tool position the nearest object is chosen",
           "docs/reference/reaching.md", chosen, kNotNegative},
          &f.ahead);
}

void describe(Visitor& v, ProbeSpec& p) {
  v.value({"object", "name of the pressed object; empty: the first", kAuthor, chosen}, &p.object);
  v.value({"azimuth_deg",
           "azimuth of the outward push axis, from +x towards +y of W",
           kAuthor,
           chosen,
           {-360.0, 360.0}},
          &p.azimuth);
  v.value({"polar_deg",
           "polar angle of the outward push axis, from +z of W; 180: pushed straight up",
           "[VHMR 4.2]",
           chosen,
           {90.0, 180.0}},
          &p.polar);
  v.value({"offset_mm", "lateral offset of the axis, towards growing polar angle (indentation B)",
           "[VHMR 4.2]", chosen},
          &p.offset);
  v.value({"radius_mm", "radius of the sphere that the machine carries as its tip", "[VHMR 4.2]", published,
           kPositive},
          &p.radius);
  v.value({"depth_mm", "depth of a push from the first touch", "[VHMR 4.2]", published, kPositive}, &p.depth);
  v.value({"speed_mm_s", "speed of pushing and of returning", "sources/ball 4", assumed, kPositive},
          &p.speed);
  v.value({"clear_mm", "distance from the first touch at which a push begins and ends", kAuthor, chosen,
           kPositive},
          &p.clear);
  v.value({"dwell_s", "dwell at full depth", kAuthor, chosen, kNotNegative}, &p.dwell);
  v.value({"rest_s", "rest, clear of the object, before each push", kAuthor, chosen, kNotNegative}, &p.rest);
  v.value({"repeats", "number of pushes", "[VHMR 4.2]", published, {1.0, 1e6}}, &p.repeats);
}

void describe(Visitor& v, PusherSpec& p) {
  v.value({"object", "name of the pushed object; empty: the first", kAuthor, chosen}, &p.object);
  v.value({"depth_mm", "intended deflection", "sources/hand 5", assumed, kPositive}, &p.depth);
  v.value({"force_max_N", "force of the object that limits the depth", "sources/hand 5", assumed, kPositive},
          &p.force);
  v.value({"ramp_s", "time from clear to full depth, and back", "sources/hand 5", assumed, kPositive},
          &p.ramp_time);
  v.value({"hold_s", "hold at full depth", kAuthor, chosen, kPositive}, &p.hold_time);
  v.value({"rest_s", "rest, clear of the tip, before each push", kAuthor, chosen, kPositive}, &p.rest_time);
  v.value({"repeats", "number of pushes", kAuthor, chosen, {1.0, 1e6}}, &p.repeats);
}

void describe(Visitor& v, TravelSpec& t) {
  v.value(
      {"axes", "axes of W, travelled one after another, such as \"xyz\" or \"z\"", "[VHMR 4.1]", published},
      &t.axes);
  v.value({"start_mm", "start of the travel along x, y and z; the other two coordinates stay at 0",
           "sources/choices 10", chosen},
          &t.start);
  v.value({"stops_mm", "stops, from the start towards +, ascending", "[VHMR 4.1]", published, kNotNegative},
          &t.stops);
  choice(
      v,
      {"ways", "one_way: return without stops; both_ways: return from stop to stop", "[VHMR 4.1]", assumed},
      t.ways);
  v.value({"speed_mm_s", "speed from stop to stop", "[VHMR 4.1]", published, kPositive}, &t.speed);
  v.value({"dwell_s", "dwell at each stop", "[VHMR 4.1]", published, kNotNegative}, &t.dwell);
  v.value({"repeats", "repeats of the whole travel", kAuthor, chosen, {1.0, 1e4}}, &t.repeats);
}

}  // namespace

void describe(Visitor& v, SceneSpec& s) {
  v.value({"format",
           "version of the scene format; this program reads version 1",
           kAuthor,
           chosen,
           {1.0, 1.0},
           needed,
           {},
           true},
          &s.format);
  v.value({"title", "title of the experiment, one line", kAuthor, chosen}, &s.title);
  v.value({"made_for",
           "rig of the scene unless --rig names another: a name in models/rigs, or a file relative to the "
           "scene's folder",
           kAuthor,
           chosen,
           kAny,
           defaulted,
           {},
           true},
          &s.rig);
  list(v, "object", s.objects, [&](ObjectSpec& o) { describe(v, o); });
  list(v, "tool", s.tools, [&](ToolSpec& t) { describe(v, t); });
  table(v, "follow", [&] { describe(v, s.follow); });
  part(v, "manipulator", s.manipulator, [&](ManipulatorSpec& m) {
    choice(v, {"kind", "machine that carries the haptic-tip", "[VHMR 2]", chosen}, m.kind);
  });
  part(v, "arm", s.arm, [](ArmSpec&) {});
  part(v, "prop", s.prop, [&](PropSpec& p) { describe(v, p); });
  part(v, "force", s.force, [](ForceSpec&) {});
  part(v, "tracker", s.tracker, [](TrackerSpec&) {});
  part(v, "camera", s.camera, [](CameraSpec&) {});
  part(v, "display", s.display, [](DisplaySpec&) {});
  part(v, "gripper", s.gripper, [&](GripperSpec& g) {
    v.value({"tool", "name of the clamped tool; empty: the first", "[VHMR 4.1]", chosen}, &g.tool);
  });
  part(v, "hand_tracker", s.hand_tracker, [](HandTrackerSpec&) {});
  part(v, "user", s.user, [&](UserSpec& u) { describe(v, u); });
  part(v, "probe", s.probe, [&](ProbeSpec& p) { describe(v, p); });
  part(v, "pusher", s.pusher, [&](PusherSpec& p) { describe(v, p); });
  part(v, "travel", s.travel, [&](TravelSpec& t) { describe(v, t); });
  part(v, "questionnaire", s.questionnaire, [&](QuestionnaireSpec& q) {
    v.value({"form", "questionnaire after the session: a file in models/questionnaires without .toml",
             "[VHMR 4.4]", chosen, kAny, needed},
            &q.form);
  });
}

namespace {

void describe(Visitor& v, StopsSpec& s) {
  const auto key = [](std::string_view name, std::string_view meaning, Range range) {
    return Key{name, meaning, "response file", derived, range, needed, {}, true};
  };
  v.value(key("curve_N", "elastic part: sum of c_k (d / limit)^k, k = 1 to at most 8", kAny), &s.curve);
  v.value(key("radii_mm", "travel at which each stop begins to slide", kPositive), &s.radii);
  v.value(key("weights_N_per_mm", "stiffness of each stop at the limit", kNotNegative), &s.weights);
}

}  // namespace

void describe(Visitor& v, ResponseSpec& r) {
  const std::string_view source = "response file";
  v.value({"limit_mm",
           "deflection up to which the polynomials are valid",
           source,
           derived,
           kPositive,
           needed,
           {},
           true},
          &r.limit);
  v.value({"press_N_per_mm_k",
           "pressing: F = sum of a_k d^k, k = 1 to 4",
           source,
           derived,
           kAny,
           needed,
           {},
           true},
          std::span<double>(r.press));
  v.value({"release_N_per_mm_k",
           "releasing: F = sum of a_k d^k, k = 1 to 4",
           source,
           derived,
           kAny,
           needed,
           {},
           true},
          std::span<double>(r.release));
  part(v, "stops", r.stops, [&](StopsSpec& s) { describe(v, s); });
}

void describe(Visitor& v, ResponseFile& r) {
  v.value({"format",
           "version of the response format; this program reads version 1",
           "sources/choices 9",
           chosen,
           {1.0, 1.0},
           needed,
           {},
           true},
          &r.format);
  v.value({"source", "source of the numbers", "sources/choices 9", chosen, kAny, needed, {}, true},
          &r.source);
  describe(v, r.response);
}

void describe(Visitor& v, BehaviourSpec& b, bool with_curves) {
  v.value(name_key("name by which objects refer to the behaviour"), &b.name);
  v.value({"response", "file in models/responses without .toml; empty: linear", "sources/choices 9", chosen},
          &b.response);
  v.value({"stiffness_N_per_mm", "stiffness of a linear surface, the same for press and release",
           "behaviours.toml", chosen, kPositive, optional},
          &b.stiffness);
  v.value({"limit_mm", "deflection limit; unset: that of the response file", "[VHMR 4.2]", chosen, kPositive,
           optional},
          &b.limit);
  choice(
      v,
      {"reversal",
       "model of a change of direction within a press; prandtl_ishlinskii needs [stops] in the response file",
       "sources/ball 6", chosen},
      b.reversal);
  choice(v,
         {"tangential", "effect of a lateral force: stick, none; spring, it moves the contact point",
          "[VHMR 3.4]", assumed},
         b.tangential);
  const Presence sideways = b.tangential == TangentialMode::spring ? needed : optional;
  v.value({"tangential_stiffness_N_per_mm", "stiffness of the lateral spring", "behaviours.toml", chosen,
           kPositive, sideways},
          &b.tangential_stiffness);
  const bool arm = b.interaction.kind != Interaction::press;
  if (!table_if(v, "interaction", arm, [&] { describe(v, b.interaction); }))
    b.interaction = InteractionSpec{};
  if (with_curves && !arm) table(v, "curves", [&] { describe(v, b.curves); });
}

void describe_behaviours(Visitor& v, std::vector<BehaviourSpec>& behaviours, bool with_curves) {
  list(v, "behaviour", behaviours, [&](BehaviourSpec& b) { describe(v, b, with_curves); });
}

// ---- The person: presses, a session, reaches.

namespace {

using enum Confidence;
using enum Presence;

void describe_presses(Visitor& v, UserSpec& u) {
  v.value({"depth_mm", "deflection that the user aims at, by eye", "[VHMR 4.2]", chosen, kPositive},
          &u.depth);
  v.value({"depths_mm",
           "intended deflections of the first, second, ... press; the last one stays; unset: depth_mm",
           "[VHMR 4.3]", chosen, kPositive, optional},
          &u.depths);
  v.value({"push_N", "force to push with, instead of a depth", kAuthor, chosen, kPositive, optional},
          &u.push);
  v.value({"press_s", "time from touch to full depth", "sources/hand 3", chosen, kPositive}, &u.press_time);
  v.value({"hold_s", "hold at full depth", kAuthor, chosen, kNotNegative}, &u.hold_time);
  v.value({"release_s", "time from full depth to touch", "sources/hand 3", chosen, kPositive},
          &u.release_time);
  v.value({"rest_s", "rest between two presses", kAuthor, chosen, kNotNegative}, &u.rest_time);
  v.value({"approach_mm_s", "speed of the tool at the touch; one press for each value", "sources/hand 2",
           chosen, kPositive},
          &u.approach);
  v.value({"approach_from_mm", "distance of the approach's start from the touched point", kAuthor, chosen,
           kPositive},
          &u.approach_from);
  v.value(
      {"approach_tilt_deg", "angle of the approach from the surface normal", kAuthor, chosen, {0.0, 80.0}},
      &u.approach_tilt);
  v.value({"slide_mm", "length of a slide along the surface and back, during the hold", kAuthor, chosen,
           kNotNegative},
          &u.slide);
  v.value({"slide_mm_s", "highest speed of that slide", kAuthor, chosen, kPositive}, &u.slide_speed);
  v.value({"repeats", "repeats of the whole list of presses", kAuthor, chosen, {1.0, 1e6}}, &u.repeats);
}

// A pair holds the minimum and maximum of a random value.
void describe_ranges(Visitor& v, ReachRanges& r) {
  v.value(
      {"tilt_deg", "angle of a reach from the surface normal: least, most", kAuthor, assumed, {0.0, 60.0}},
      &r.tilt);
  v.value({"reach_mm", "distance from the start of a reach to the touched point: least, most", kAuthor,
           assumed, kPositive},
          &r.reach);
  v.value({"peak_mm_s", "peak speed of a reach's first, ballistic part: least, most", "sources/hand 2",
           published, kPositive},
          &r.peak_speed);
  v.value({"touch_mm_s", "intended speed at the surface: least, most", "sources/hand 2", assumed, kPositive},
          &r.touch_speed);
  v.value({"depth_mm", "intended deflection: least, most", "[VHMR 4.2]", assumed, kPositive}, &r.depth);
  v.value({"press_mm_s", "mean speed of pressing and of releasing: least, most", "sources/hand 2", assumed,
           kPositive},
          &r.press_speed);
  v.value({"hold_s", "hold at full depth: least, most", kAuthor, assumed, kNotNegative}, &r.hold);
  v.value({"rest_s", "rest above the next place: least, most", kAuthor, assumed, kNotNegative}, &r.rest);
}

void describe(Visitor& v, SessionSpec& s) {
  v.value({"duration_s", "duration of the session", "[VHMR 4.4]", published, kPositive}, &s.duration);
  v.value({"polar_max_deg",
           "largest polar angle, from +z of W, of the places; they are evenly distributed over the "
           "directions that can be pressed",
           "[VHMR 4.4]",
           assumed,
           {0.0, 85.0}},
          &s.polar_most);
  describe_ranges(v, s);
  v.value({"other_tool", "name of the tool that the user changes to; empty: no change", "[VHMR 4.4]", chosen},
          &s.other_tool);
  v.value({"change_share",
           "share of the duration after which the next pause is used to change tools: least, most",
           "[VHMR 4.4]",
           assumed,
           {0.0, 1.0}},
          &s.change);
  v.value({"tray_mm",
           "position in W of the first tool's tip while the tool is not held; the other tool's is 80 mm "
           "further along y",
           kAuthor, chosen},
          &s.tray);
}

void describe(Visitor& v, ReachesSpec& r) {
  v.value({"count", "number of reaches", "docs/reference/reaching.md", chosen, {1.0, 1e6}}, &r.count);
  v.value({"spread_mm",
           "plane: places are evenly distributed up to this distance from position_mm along each axis",
           "docs/reference/reaching.md", chosen, kPositive},
          &r.spread);
  v.value({"polar_max_deg",
           "sphere: largest polar angle, from +z of W, of the evenly distributed places",
           "docs/reference/reaching.md",
           assumed,
           {0.0, 85.0}},
          &r.polar_most);
  describe_ranges(v, r);
}

}  // namespace

void describe(Visitor& v, UserSpec& u) {
  choice(v, {"kind", "task of the user", kAuthor, chosen}, u.kind);
  v.value({"object", "name of the pressed object; empty: the first", kAuthor, chosen}, &u.object);
  v.value({"tool", "name of the held tool; empty: the first", kAuthor, chosen}, &u.tool);
  v.value({"azimuth_deg",
           "azimuth of the touched point, from +x towards +y of W",
           kAuthor,
           chosen,
           {-360.0, 360.0}},
          &u.azimuth);
  v.value({"polar_deg",
           "polar angle of the touched point, from +z of W; 0: from above",
           kAuthor,
           chosen,
           {0.0, 180.0}},
          &u.polar);
  v.value({"offset_mm", "lateral offset from the axis (indentation B)", "[VHMR 4.2]", chosen}, &u.offset);
  describe_presses(v, u);
  choice(v,
         {"tremor", "sine: one for each axis; band: several of varying amplitude", "sources/hand 2", assumed},
         u.tremor);
  part(v, "session", u.session, [&](SessionSpec& session) { describe(v, session); });
  part(v, "reaches", u.reaches, [&](ReachesSpec& reaches) { describe(v, reaches); });
}

}  // namespace enc::models
