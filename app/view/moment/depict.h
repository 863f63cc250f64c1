// Turns a moment of a run into a picture: machine, tool, force, normal, names.
#pragma once

#include "app/view/moment/moment.h"
#include "sim/view/view.h"

namespace enc::app {

// The default camera: the whole machine, or a close-up of the contact.
[[nodiscard]] sim::Camera camera_for(const Moment& m, bool close_up);
// The caller sets `data`, which may be another copy than the moment's.
[[nodiscard]] sim::ViewRequest depict(const Moment& m, const sim::Camera& camera, bool close_up);
// In place of the labels, which would jump from frame to frame: where there are several objects, each has its
// name on it; where there are more than four, the one that the machine is at.
void name_objects(const Moment& m, sim::ViewRequest& request);
// A frame of a film: a line with time, mode and force, and name_objects().
[[nodiscard]] sim::ViewRequest depict_frame(const Moment& m, const sim::Camera& camera, bool close_up);

// Gives a request the poses of a run, with pushed objects where they are now and the touched surface dented.
// `m` outlives the request.
void show(const Moment& m, mjData* data, sim::ViewRequest& request);

// Moves pushed objects to where they are now.
void shift_objects(const Moment& m, mjData* data);
// Dents the touched surface by the true tool, as the eye should see it. `model`: the picture's own, not
// dented yet. Returns the index of the mesh, or -1.
int dent_object(const Moment& m, mjModel* model);

}  // namespace enc::app
