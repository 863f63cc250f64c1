// Noise of an image sensor, from a table.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace enc::sim {

class SensorNoise {
 public:
  // rms in units of 255. The table holds integers with this rms; a value of 0 adds no noise. Throws Error
  // unless the value is 0 to 30.
  SensorNoise(double rms, std::uint64_t seed);
  // Gives equal bits for equal seed, frame and eye.
  void add(Image& image, std::uint64_t frame, std::uint64_t eye) const;

 private:
  std::uint64_t seed_;
  std::vector<std::int8_t> table_;
};

}  // namespace enc::sim
