// Draws a moment of a run: machine, tool, force, normal, names.
#pragma once

#include "app/view/moment/moment.h"
#include "sim/view/view.h"

namespace enc::app {

// The drawing of one kind of machine: the differences between pictures of a hexapod and of an arm.
struct MachineLook {
  double force_scale;  // m of arrow for each N
  bool removed;        // the augmented view leaves it out
  // Words for what presses on its tip.
  const char* (*presser)(const Moment& m);
  // The machine itself, and the floor under it.
  void (*add_parts)(const Moment& m, sim::ViewRequest& request);
  // `marker`: a marker of the held tool, if any.
  void (*add_labels)(const Moment& m, sim::ViewRequest& request, const Point<'W'>& marker);
  // Sets the default camera's azimuth, distance and place to look at.
  void (*aim)(const Moment& m, bool close_up, sim::Camera& camera);
  // The tip position that the core commands.
  Point<'W'> (*target)(const Moment& m);
};
[[nodiscard]] const MachineLook& look_of(const models::Setup& setup);

// The default camera: the whole machine, or a close-up of the contact.
[[nodiscard]] sim::Camera camera_for(const Moment& m, bool close_up);
// The caller sets `data`, which may be another copy than the moment's.
[[nodiscard]] sim::ViewRequest depict(const Moment& m, const sim::Camera& camera, bool close_up);
// Replaces the labels, which would jump from frame to frame. With several objects, each has its name on it;
// with more than four, only the object at the machine.
void name_objects(const Moment& m, sim::ViewRequest& request);
// A frame of a film: a line with time, mode and force.
[[nodiscard]] sim::ViewRequest depict_frame(const Moment& m, const sim::Camera& camera, bool close_up);

// Sets the poses of a run in a request, with dynamic objects at their present places and the touched surface
// deformed. `m` must outlive the request.
void show(const Moment& m, mjData* data, sim::ViewRequest& request);

// Moves dynamic objects to their present places.
void shift_objects(const Moment& m, mjData* data);
// Deforms the touched surface by the true tool, as the display is meant to show it. `model`: the picture's
// own, not deformed yet. Returns the index of the mesh, or -1.
int dent_object(const Moment& m, mjModel* model);

}  // namespace enc::app
