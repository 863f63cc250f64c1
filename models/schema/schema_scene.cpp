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
           "of the mesh's content: a mesh that has changed is refused; empty: any",
           kAuthor,
           chosen,
           kAny,
           defaulted,
           {},
           true},
          &o.mesh_hash);
  v.value({"scale", "of the mesh", kAuthor, chosen, kPositive}, &o.scale);
}

void describe(Visitor& v, ObjectSpec& o) {
  v.value(name_key("what --set, the user and the report call it"), &o.name);
  choice(v, {"shape", "its undeformed surface", kAuthor, chosen, kAny, needed}, o.shape);
  if (o.shape == ShapeKind::sphere) {
    v.value({"radius_mm", "radius of the sphere", "[VHMR 4.2], sources/ball 1", chosen, kPositive, needed},
            &o.radius);
  }
  if (o.shape == ShapeKind::mesh) describe_mesh(v, o);
  if (o.shape == ShapeKind::box)
    v.value({"size_mm", "its edges along x, y and z of O", kAuthor, chosen, kPositive, needed}, &o.size);
  if (has_triangles(o.shape))
    v.value({"rotation_deg", "about the fixed x, then y, then z axis of W", kAuthor, chosen}, &o.rotation);
  v.value({"position_mm", "where its origin O is in W", kAuthor, chosen, kAny, needed}, &o.position);
  if (o.shape == ShapeKind::plane || o.shape == ShapeKind::button)
    v.value({"normal", "outward, of length 1, in W", kAuthor, chosen}, &o.normal);
  if (o.shape == ShapeKind::button) {
    v.value({"width_mm", "of its face", "[VisHap 2.2]", chosen, kPositive, needed}, &o.width);
    v.value({"height_mm", "of its face", "[VisHap 2.2]", chosen, kPositive, needed}, &o.height);
    v.value({"thickness_mm", "of the solid behind its face", "docs/reference/objects.md", chosen, kPositive},
            &o.thickness);
  }
  v.value({"behaviour",
           "how it pushes back: a [[behaviour]] of this file or an entry of models/behaviours.toml; empty: a "
           "real thing, for [probe] alone",
           kAuthor, chosen},
          &o.behaviour);
  v.value({"limit_mm", "deflection limit that the device holds; unset: the behaviour's", "[VHMR 4.2]", chosen,
           kPositive, optional},
          &o.limit);
  v.value({"limits_mm", "instead: of the first, second, ... contact; the last stays; unset: all alike",
           "[VHMR 4.3]", chosen, kPositive, optional},
          &o.limits);
  choice(v,
         {"material", "what pictures show; unnamed: as the mesh's file says, else by shape", "[VHMR 3.5]",
          chosen},
         o.material);
}

void describe(Visitor& v, ToolSpec& t) {
  v.value(name_key("what --set, the user and the report call it"), &t.name);
  v.value({"markers_mm", "at least 3 markers in T; the tool is recognised by them", "[VHMR 3.2]", chosen},
          &t.markers);
  v.value({"tip_mm", "centre of the tip's sphere in T", "[VHMR 3.2]", chosen, kAny, needed}, &t.tip);
  v.value({"tip_radius_mm", "radius of the tip; 0: a point", kAuthor, chosen, {0.0, 1000.0}}, &t.tip_radius);
  choice(v, {"tip_shape", "what dents the seen surface", "[VHMR 3.5]", chosen}, t.tip_shape);
  if (t.tip_shape != TipShape::sphere)
    v.value({"tip_axis",
             "of length 1, in T; cone: from the apex into the tool, edge: along it",
             kAuthor,
             chosen,
             {-1.0, 1.0},
             needed},
            &t.tip_axis);
  if (t.tip_shape == TipShape::cone)
    v.value({"tip_half_angle_deg", "of the cone", kAuthor, chosen, {1.0, 80.0}, needed}, &t.tip_half_angle);
  if (t.tip_shape == TipShape::edge)
    v.value({"tip_edge_mm",
             "length of the edge, without its round ends",
             kAuthor,
             chosen,
             {0.0, 500.0, true},
             needed},
            &t.tip_edge);
  constexpr Range kWeighs{1e-6};  // kg: no tool is lighter than a milligram
  v.value({"mass_kg", "tool with its markers", "sources/hand 1", assumed, kWeighs}, &t.mass);
}

void describe(Visitor& v, FollowSpec& f) {
  v.value({"inset_mm", "how far inside the surface the haptic-tip waits", "sources/choices 11", chosen,
           kPositive},
          &f.inset);
  v.value({"pause_mm", "a tool farther than this is not followed", "[VHMR 3.3]", published, kPositive},
          &f.pause);
  v.value(
      {"resume_mm", "and is followed again when nearer than this", "sources/hexapod 7", assumed, kPositive},
      &f.resume);
  v.value({"hysteresis_mm", "another object must be nearer by this to take over", "[VisHap 3]", assumed,
           kNotNegative},
          &f.hysteresis);
  v.value({"ahead_ms", "the nearest object is that of where the tool will be by then",
           "docs/reference/reaching.md", chosen, kNotNegative},
          &f.ahead);
}

void describe(Visitor& v, ProbeSpec& p) {
  v.value({"object", "pressed object, by name; empty: the first", kAuthor, chosen}, &p.object);
  v.value({"azimuth_deg",
           "of the axis out of the object, from +x towards +y of W",
           kAuthor,
           chosen,
           {-360.0, 360.0}},
          &p.azimuth);
  v.value({"polar_deg",
           "and from +z of W; 180: pushed from below, straight up",
           "[VHMR 4.2]",
           chosen,
           {90.0, 180.0}},
          &p.polar);
  v.value({"offset_mm", "sideways of that axis, towards growing polar angle (indentation B)", "[VHMR 4.2]",
           chosen},
          &p.offset);
  v.value(
      {"radius_mm", "of the sphere that the machine carries as its tip", "[VHMR 4.2]", published, kPositive},
      &p.radius);
  v.value({"depth_mm", "of a push, from the first touch", "[VHMR 4.2]", published, kPositive}, &p.depth);
  v.value({"speed_mm_s", "of pushing and of going back", "sources/ball 4", assumed, kPositive}, &p.speed);
  v.value(
      {"clear_mm", "distance to the first touch at which a push begins and ends", kAuthor, chosen, kPositive},
      &p.clear);
  v.value({"dwell_s", "at depth", kAuthor, chosen, kNotNegative}, &p.dwell);
  v.value({"rest_s", "clear of the object before each push", kAuthor, chosen, kNotNegative}, &p.rest);
  v.value({"repeats", "pushes", "[VHMR 4.2]", published, {1.0, 1e6}}, &p.repeats);
}

void describe(Visitor& v, PusherSpec& p) {
  v.value({"object", "pushed into, by name; empty: the first", kAuthor, chosen}, &p.object);
  v.value({"depth_mm", "wanted deflection", "sources/hand 5", assumed, kPositive}, &p.depth);
  v.value({"force_max_N", "no deeper than where the object pushes back with this", "sources/hand 5", assumed,
           kPositive},
          &p.force);
  v.value({"ramp_s", "from clear to depth, and back", "sources/hand 5", assumed, kPositive}, &p.ramp_time);
  v.value({"hold_s", "at depth", kAuthor, chosen, kPositive}, &p.hold_time);
  v.value({"rest_s", "clear of the tip before each push", kAuthor, chosen, kPositive}, &p.rest_time);
  v.value({"repeats", "pushes", kAuthor, chosen, {1.0, 1e6}}, &p.repeats);
}

void describe(Visitor& v, TravelSpec& t) {
  v.value({"axes", "of W, travelled one after another, such as \"xyz\" or \"z\"", "[VHMR 4.1]", published},
          &t.axes);
  v.value({"start_mm", "where the travel along x, along y and along z begins; the other two axes stay at 0",
           "sources/choices 10", chosen},
          &t.start);
  v.value({"stops_mm", "from the start, towards +, growing", "[VHMR 4.1]", published, kNotNegative},
          &t.stops);
  choice(v,
         {"ways", "one_way: straight back from the last stop; both_ways: stop by stop back", "[VHMR 4.1]",
          assumed},
         t.ways);
  v.value({"speed_mm_s", "from stop to stop", "[VHMR 4.1]", published, kPositive}, &t.speed);
  v.value({"dwell_s", "at each stop", "[VHMR 4.1]", published, kNotNegative}, &t.dwell);
  v.value({"repeats", "of the whole", kAuthor, chosen, {1.0, 1e4}}, &t.repeats);
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
  v.value({"title", "what the experiment is, in a line", kAuthor, chosen}, &s.title);
  v.value({"made_for",
           "rig in models/rigs that it is made for, or a file, from the scene's folder; --rig says otherwise",
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
    choice(v, {"kind", "which machine carries the haptic-tip", "[VHMR 2]", chosen}, m.kind);
  });
  part(v, "arm", s.arm, [](ArmSpec&) {});
  part(v, "prop", s.prop, [&](PropSpec& p) { describe(v, p); });
  part(v, "force", s.force, [](ForceSpec&) {});
  part(v, "tracker", s.tracker, [](TrackerSpec&) {});
  part(v, "camera", s.camera, [](CameraSpec&) {});
  part(v, "display", s.display, [](DisplaySpec&) {});
  part(v, "gripper", s.gripper, [&](GripperSpec& g) {
    v.value({"tool", "clamped tool, by name; empty: the first", "[VHMR 4.1]", chosen}, &g.tool);
  });
  part(v, "user", s.user, [&](UserSpec& u) { describe(v, u); });
  part(v, "probe", s.probe, [&](ProbeSpec& p) { describe(v, p); });
  part(v, "pusher", s.pusher, [&](PusherSpec& p) { describe(v, p); });
  part(v, "travel", s.travel, [&](TravelSpec& t) { describe(v, t); });
  part(v, "questionnaire", s.questionnaire, [&](QuestionnaireSpec& q) {
    v.value({"form", "asked afterwards: a file in models/questionnaires without .toml", "[VHMR 4.4]", chosen,
             kAny, needed},
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
  v.value({"limit_mm", "the polynomials hold from 0 to here", source, derived, kPositive, needed, {}, true},
          &r.limit);
  v.value({"press_N_per_mm_k",
           "F = sum of a_k d^k, k = 1 to 4, pressing",
           source,
           derived,
           kAny,
           needed,
           {},
           true},
          std::span<double>(r.press));
  v.value({"release_N_per_mm_k", "the same, releasing", source, derived, kAny, needed, {}, true},
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
  v.value({"source", "where the numbers come from", "sources/choices 9", chosen, kAny, needed, {}, true},
          &r.source);
  describe(v, r.response);
}

void describe(Visitor& v, BehaviourSpec& b, bool with_curves) {
  v.value(name_key("what objects call it"), &b.name);
  v.value({"response", "file in models/responses without .toml; empty: linear", "sources/choices 9", chosen},
          &b.response);
  v.value({"stiffness_N_per_mm", "of a linear surface, press and release alike", "behaviours.toml", chosen,
           kPositive, optional},
          &b.stiffness);
  v.value({"limit_mm", "deflection limit; unset: that of the response file", "[VHMR 4.2]", chosen, kPositive,
           optional},
          &b.limit);
  choice(v,
         {"reversal",
          "what is felt where pressing turns to releasing; the second needs [stops] in the response file",
          "sources/ball 6", chosen},
         b.reversal);
  choice(v,
         {"tangential", "what a sideways force does: nothing, or moves the contact point", "[VHMR 3.4]",
          assumed},
         b.tangential);
  const Presence sideways = b.tangential == TangentialMode::spring ? needed : optional;
  v.value({"tangential_stiffness_N_per_mm", "of the sideways spring", "behaviours.toml", chosen, kPositive,
           sideways},
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
  v.value({"depth_mm", "deflection that the user wants to see", "[VHMR 4.2]", chosen, kPositive}, &u.depth);
  v.value({"depths_mm", "instead: of the first, second, ... press; the last stays; unset: all alike",
           "[VHMR 4.3]", chosen, kPositive, optional},
          &u.depths);
  v.value(
      {"push_N", "push with this force instead, whatever the depth", kAuthor, chosen, kPositive, optional},
      &u.push);
  v.value({"press_s", "from touch to depth", "sources/hand 3", chosen, kPositive}, &u.press_time);
  v.value({"hold_s", "at depth", kAuthor, chosen, kNotNegative}, &u.hold_time);
  v.value({"release_s", "from depth to touch", "sources/hand 3", chosen, kPositive}, &u.release_time);
  v.value({"rest_s", "between two presses", kAuthor, chosen, kNotNegative}, &u.rest_time);
  v.value({"approach_mm_s", "speeds of the tool at the touch; one press for each", "sources/hand 2", chosen,
           kPositive},
          &u.approach);
  v.value({"approach_from_mm", "distance of the start from the touched point", kAuthor, chosen, kPositive},
          &u.approach_from);
  v.value({"approach_tilt_deg", "of the approach from the surface normal", kAuthor, chosen, {0.0, 80.0}},
          &u.approach_tilt);
  v.value({"slide_mm", "there and back along the surface while it is held", kAuthor, chosen, kNotNegative},
          &u.slide);
  v.value({"slide_mm_s", "of that, at its fastest", kAuthor, chosen, kPositive}, &u.slide_speed);
  v.value({"repeats", "of the whole list of presses", kAuthor, chosen, {1.0, 1e6}}, &u.repeats);
}

// A pair holds the minimum and maximum of a random value.
void describe_ranges(Visitor& v, ReachRanges& r) {
  v.value({"tilt_deg", "of a reach from the surface normal: least, most", kAuthor, assumed, {0.0, 60.0}},
          &r.tilt);
  v.value({"reach_mm", "from where a reach begins to the touched point: least, most", kAuthor, assumed,
           kPositive},
          &r.reach);
  v.value({"peak_mm_s", "of the first, ballistic part of a reach: least, most", "sources/hand 2", published,
           kPositive},
          &r.peak_speed);
  v.value({"touch_mm_s", "wanted at the surface: least, most", "sources/hand 2", assumed, kPositive},
          &r.touch_speed);
  v.value({"depth_mm", "wanted deflection: least, most", "[VHMR 4.2]", assumed, kPositive}, &r.depth);
  v.value(
      {"press_mm_s", "mean, of pressing and of releasing: least, most", "sources/hand 2", assumed, kPositive},
      &r.press_speed);
  v.value({"hold_s", "at depth: least, most", kAuthor, assumed, kNotNegative}, &r.hold);
  v.value({"rest_s", "over the next place: least, most", kAuthor, assumed, kNotNegative}, &r.rest);
}

void describe(Visitor& v, SessionSpec& s) {
  v.value({"duration_s", "of the session", "[VHMR 4.4]", published, kPositive}, &s.duration);
  v.value({"polar_max_deg",
           "places are even over the directions up to here from +z of W that can be pressed",
           "[VHMR 4.4]",
           assumed,
           {0.0, 85.0}},
          &s.polar_most);
  describe_ranges(v, s);
  v.value({"other_tool", "that the user changes to, by name; empty: no change", "[VHMR 4.4]", chosen},
          &s.other_tool);
  v.value({"change_share",
           "of the duration, after which the next pause is the change: least, most",
           "[VHMR 4.4]",
           assumed,
           {0.0, 1.0}},
          &s.change);
  v.value({"tray_mm",
           "in W: where the first tool's tip lies when it is not held; the other's 80 mm further "
           "along y",
           kAuthor, chosen},
          &s.tray);
}

void describe(Visitor& v, ReachesSpec& r) {
  v.value({"count", "reaches", "docs/reference/reaching.md", chosen, {1.0, 1e6}}, &r.count);
  v.value({"spread_mm", "of a plane, places are even over this around the point of it that is named",
           "docs/reference/reaching.md", chosen, kPositive},
          &r.spread);
  v.value({"polar_max_deg",
           "of a sphere, places are even over the directions up to here from +z of W",
           "docs/reference/reaching.md",
           assumed,
           {0.0, 85.0}},
          &r.polar_most);
  describe_ranges(v, r);
}

}  // namespace

void describe(Visitor& v, UserSpec& u) {
  choice(v, {"kind", "what the user does", kAuthor, chosen}, u.kind);
  v.value({"object", "pressed object, by name; empty: the first", kAuthor, chosen}, &u.object);
  v.value({"tool", "held tool, by name; empty: the first", kAuthor, chosen}, &u.tool);
  v.value({"azimuth_deg", "where on the object, from +x towards +y of W", kAuthor, chosen, {-360.0, 360.0}},
          &u.azimuth);
  v.value({"polar_deg", "where on the object, from +z of W; 0: from above", kAuthor, chosen, {0.0, 180.0}},
          &u.polar);
  v.value({"offset_mm", "sideways of the axis (indentation B)", "[VHMR 4.2]", chosen}, &u.offset);
  describe_presses(v, u);
  choice(
      v,
      {"tremor", "one sine for each axis, or a band of several that wax and wane", "sources/hand 2", assumed},
      u.tremor);
  part(v, "session", u.session, [&](SessionSpec& session) { describe(v, session); });
  part(v, "reaches", u.reaches, [&](ReachesSpec& reaches) { describe(v, reaches); });
}

}  // namespace enc::models
