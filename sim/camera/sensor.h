// Noise of an image sensor, out of a table.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace enc::sim {

class SensorNoise {
 public:
  // rms in units of 255. The table holds whole numbers whose rms is this one; nothing is added where it is 0.
  // Throws Error where it is not 0 to 30.
  SensorNoise(double rms, std::uint64_t seed);
  // The same bits for the same seed, frame and eye.
  void add(Image& image, std::uint64_t frame, std::uint64_t eye) const;

 private:
  std::uint64_t seed_;
  std::vector<std::int8_t> table_;
};

}  // namespace enc::sim
