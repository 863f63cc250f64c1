// What others offer for the same work, to race against: the module encounter_peers. A shared object of its
// own, so that nothing but `encounter bench` maps these libraries.
#pragma once

#include <array>
#include <memory>

#include "core/mesh/mesh.h"

namespace enc::bench {

class NearestPeer {
 public:
  struct Found {
    std::array<float, 3> point;
    float distance;  // m, without sign
  };
  virtual ~NearestPeer() = default;
  // Nearest surface point within `radius` of p, m.
  virtual Found nearest(const std::array<float, 3>& p, float radius) = 0;
};

struct PeersModule {
  // Embree 3, rtcPointQuery. Throws Error (kind device) where it refuses.
  std::unique_ptr<NearestPeer> (*embree)(const Mesh& mesh) = nullptr;
};

}  // namespace enc::bench
