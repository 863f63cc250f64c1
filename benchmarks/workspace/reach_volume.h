// Where the haptic-tip gets: extents and volume with straight axes, which is how the core commands it, and
// with all turns that the machine allows.
#pragma once

#include "core/machine/hexapod.h"

namespace enc::bench::workspace {

// All in m, of H against where it is at the machine's zero (W).
class ReachVolume {
 public:
  explicit ReachVolume(const Hexapod& machine) : machine_(machine) {}

  // Straight axes. Each strut holds the tip between two spheres, so over (x, y) the tip's heights are one
  // interval, in closed form; empty where low > high.
  struct Column {
    double low = 0.0, high = 0.0;
    [[nodiscard]] double height() const { return high > low ? high - low : 0.0; }
  };
  [[nodiscard]] Column column(double x, double y) const;
  [[nodiscard]] double straight(double step) const;  // m^3: midpoint rule over x and y
  // From the least to the largest x, y and z that any point of it has.
  struct Extents {
    Vec3 low{0, 0, 0}, high{0, 0, 0};
  };
  [[nodiscard]] Extents extents() const;

  // Least stroke that a strut has left, m, in the best of the allowed turns; negative: none gets there. The
  // search climbs, so it may miss some: a lower bound.
  [[nodiscard]] double turned_slack(const Vec3& p) const;
  [[nodiscard]] double turned(double step) const;  // m^3: midpoint rule over x and y

 private:
  // From the lowest to the highest that is reached over (x, y), m; what is between counts as reached.
  [[nodiscard]] double turned_height(double x, double y) const;
  [[nodiscard]] double slack(const Vec3& p, const Vec3& turn) const;
  Hexapod machine_;
};

}  // namespace enc::bench::workspace
