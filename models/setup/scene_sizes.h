// How large a scene's tools and meshes are, and where the meshes stand. A wrong unit or origin of an imported
// file shows there first.
#pragma once

#include <string>

#include "models/setup/scene_file.h"

namespace enc::models {

// Adds a warning to the setup's notes for each tool, mesh, ball and button of a size that is out of the
// ordinary, and for what stands farther from W than any machine reaches: with the unit that would explain it.
void note_sizes(Setup& setup);

// "is 'markers_mm' in m? then multiply each number of it by 1000": the units that give the markers of a tool
// an ordinary size; empty where they have one, or no unit helps.
[[nodiscard]] std::string markers_advice(const ToolSpec& tool);

// A line for each tool and each mesh, the first one after "sizes": "mesh 'hare' (hare.glb): 67 x 50 x 40 mm,
// ...". Empty where the scene has neither.
[[nodiscard]] std::string sizes_text(const Setup& setup);

// Ends the refusal of a mesh that is out of reach or out of the user's way: its extent and middle in W, and
// the scale or position that puts it right. `key`: the key that is refused; empty where it is not about a
// mesh.
[[nodiscard]] std::string mesh_advice(const Setup& setup, const std::string& key);

}  // namespace enc::models
