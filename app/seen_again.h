// Evaluates the images of a recorded run with vision once more.
#pragma once

#include <string>
#include <vector>

#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::app {

struct SeenAgain {
  std::int64_t told = 0;               // poses and "no finger" results of vision
  std::int64_t first_difference = -1;  // index of the tick; -1: no difference
  std::string what;
  std::vector<std::string> said;  // messages of the driver that plays the folder, if there is a difference
};
// Compares vision's results for the frames of `folder` (run --frames) with those in the record: equal bits at
// equal ticks. Throws Error if the scene has no camera or the folder no frames.
[[nodiscard]] SeenAgain see_again(models::Setup setup, RecordReader& record, const std::string& folder);

}  // namespace enc::app
