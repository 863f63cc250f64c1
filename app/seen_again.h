// The images of a recorded run, seen by vision once more.
#pragma once

#include <string>
#include <vector>

#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::app {

struct SeenAgain {
  std::int64_t told = 0;               // poses and "no finger" that vision told
  std::int64_t first_difference = -1;  // index of the tick; -1: none
  std::string what;
  std::vector<std::string> said;  // by the driver that plays the folder, where something differs
};
// What vision makes of the frames of `folder` (run --frames), against what the record says that it told the
// core: the same bits at the same ticks. Throws Error where the scene has no camera or the folder no frames.
[[nodiscard]] SeenAgain see_again(models::Setup setup, RecordReader& record, const std::string& folder);

}  // namespace enc::app
