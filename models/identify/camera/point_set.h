// Positions of a device's tip seen by a camera, as a file: comma-separated columns camera_x_m, camera_y_m,
// camera_z_m (in C), device_x_m, device_y_m, device_z_m (in W, reported by the device). If the tip stood
// still for several frames, there is a column pair: rows with one number are frames of one position.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/identify/camera/register.h"

namespace enc::models {

struct SeenPlace {
  std::int64_t number = 0;  // number in the file
  std::vector<PointPair> frames;

  // Mean of the first `count` frames, or of all if there are fewer.
  [[nodiscard]] PointPair average(std::size_t count = SIZE_MAX) const;
};
using PointSet = std::vector<SeenPlace>;

[[nodiscard]] std::vector<PointPair> averages(const PointSet& places, std::size_t frames = SIZE_MAX);

// True if this text begins with such a header; else it is another kind of table.
[[nodiscard]] bool is_point_set(const std::string& text);

// name: of the file, for messages "name:line:column: ...". Throws Error: a missing column, not a number, a
// position beyond 10 m, a tip that moved between the frames of a pair, too few pairs, positions on one line
// or in one point, sets of different size, mirror images. Every returned set can be registered.
[[nodiscard]] PointSet parse_points(const std::string& text, const std::string& name);
[[nodiscard]] std::string points_text(const PointSet& places);

}  // namespace enc::models
