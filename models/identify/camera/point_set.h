// Places of a device's tip that a camera saw, as a file: comma-separated columns camera_x_m, camera_y_m,
// camera_z_m (in C), device_x_m, device_y_m, device_z_m (in W, as the device says) and, where the tip stood
// still for several frames, pair: rows with the same number are frames of one place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/identify/camera/register.h"

namespace enc::models {

struct SeenPlace {
  std::int64_t number = 0;  // in the file
  std::vector<PointPair> frames;

  // Of the first `count` frames, or of all where there are not so many.
  [[nodiscard]] PointPair average(std::size_t count = SIZE_MAX) const;
};
using PointSet = std::vector<SeenPlace>;

[[nodiscard]] std::vector<PointPair> averages(const PointSet& places, std::size_t frames = SIZE_MAX);

// Does this text begin with such a header? Else it is another kind of table.
[[nodiscard]] bool is_point_set(const std::string& text);

// name: of the file, for messages "name:line:column: ...". Throws Error: no such column, no number, a place
// beyond 10 m, a tip that moved between the frames of a pair, too few pairs, places on one line or in one
// place, sets of different size, mirror images. What it returns can be registered.
[[nodiscard]] PointSet parse_points(const std::string& text, const std::string& name);
[[nodiscard]] std::string points_text(const PointSet& places);

}  // namespace enc::models
