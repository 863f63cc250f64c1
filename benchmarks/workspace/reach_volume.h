// Reach of the haptic-tip: extents and volume with straight axes, as the core commands it, and with all turns
// that the machine allows.
#pragma once

#include "core/machine/hexapod.h"

namespace enc::bench::workspace {

// All in m, of H against its place at the machine's zero (W).
class ReachVolume {
 public:
  explicit ReachVolume(const Hexapod& machine) : machine_(machine) {}

  // Straight axes. Each strut holds the tip between two spheres, so over (x, y) the tip's heights are one
  // interval, in closed form; empty if low > high.
  struct Column {
    double low = 0.0, high = 0.0;
    [[nodiscard]] double height() const { return high > low ? high - low : 0.0; }
  };
  [[nodiscard]] Column column(double x, double y) const;
  [[nodiscard]] double straight(double step) const;  // m^3: midpoint rule over x and y
  // Extents from the least to the largest x, y and z of all points.
  struct Extents {
    Vec3 low{0, 0, 0}, high{0, 0, 0};
  };
  [[nodiscard]] Extents extents() const;

  // Least remaining stroke of a strut, m, in the best of the allowed turns; negative: out of reach. The
  // search climbs, so it may miss some: a lower bound.
  [[nodiscard]] double turned_slack(const Vec3& p) const;
  [[nodiscard]] double turned(double step) const;  // m^3: midpoint rule over x and y

 private:
  // Height between the lowest and the highest reached point over (x, y), m; the range between counts as
  // reached.
  [[nodiscard]] double turned_height(double x, double y) const;
  [[nodiscard]] double slack(const Vec3& p, const Vec3& turn) const;
  Hexapod machine_;
};

}  // namespace enc::bench::workspace
