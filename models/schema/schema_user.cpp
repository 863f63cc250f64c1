// What a scene says of the person: presses, a session, reaches.
#include "models/schema/schema_walk.h"

namespace enc::models {
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

// A pair is the least and the most of what is drawn.
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
