// Sizes of a scene's tools and meshes, and positions of the meshes. They reveal a wrong unit or origin of an
// imported file first.
#pragma once

#include <string>

#include "models/setup/scene_file.h"

namespace enc::models {

// Adds a warning to the setup's notes for each tool, mesh, ball and button of an unusual size, and for
// objects farther from W than any machine reaches. The warning names the unit that would explain it.
void note_sizes(Setup& setup);

// "is 'markers_mm' in m? then multiply each number of it by 1000": the unit that gives a tool's markers a
// usual size; empty if they have one, or no unit helps.
[[nodiscard]] std::string markers_advice(const ToolSpec& tool);

// One line for each tool and each mesh, the first one after "sizes": "mesh 'hare' (hare.glb): 67 x 50 x 40
// mm, ...". Empty if the scene has neither.
[[nodiscard]] std::string sizes_text(const Setup& setup);

// Text that ends the refusal of a mesh out of reach or out of the user's way: its extent and middle in W, and
// the scale or position that corrects it. `key`: the refused key; empty if it does not concern a mesh.
[[nodiscard]] std::string mesh_advice(const Setup& setup, const std::string& key);

}  // namespace enc::models
