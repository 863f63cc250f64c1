// Peer libraries to race against: the module encounter_peers. It is its own shared object, so that nothing
// but `encounter bench` loads these libraries.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/image.h"
#include "core/machine/arm.h"
#include "core/shape/surface/mesh.h"

namespace enc::bench {

class NearestPeer {
 public:
  struct NearestPoint {
    std::array<float, 3> point;
    float distance;  // m, without sign
  };
  virtual ~NearestPeer() = default;
  // Nearest surface point within `radius` of p, m.
  virtual NearestPoint nearest(const std::array<float, 3>& p, float radius) = 0;
};

struct ArmAnswer {
  Vec3 tip;         // m
  PerJoint torque;  // against gravity and for a force at the tip, N m
};
class ArmPeer {
 public:
  virtual ~ArmPeer() = default;
  // Kinematics, Jacobian J, gravity g: returns tip and g + J^T force.
  virtual ArmAnswer answer(const PerJoint& q, const Vec3& force) = 0;
};

// Skin as inRange takes it: hues `from` to `to` of a circle of 256, both included; wraps past 255 to 0 if
// from > to.
struct HueRange {
  int from = 0, to = 0;
  int least_saturation = 20, least_value = 16;  // of 255
};
class SegmentationPeer {
 public:
  virtual ~SegmentationPeer() = default;
  virtual void learn(const ImageView& frame) = 0;                // of the background
  virtual void segment(const ImageView& frame, Mask& skin) = 0;  // does not change the learned model
};
class TilePeer {
 public:
  virtual ~TilePeer() = default;
  virtual void learn(const ImageView& frame) = 0;
  // Sets 255 for each tile, row by row, that has less than `match` in common with the learned tile.
  virtual void match(const ImageView& frame, double match, std::vector<std::uint8_t>& found) = 0;
};
class StereoPeer {
 public:
  virtual ~StereoPeer() = default;
  virtual void disparity(const ImageView& left, const ImageView& right) = 0;
};
// OpenCV on one thread, with its defaults where no value is given.
struct OpenCv {
  std::unique_ptr<SegmentationPeer> (*mog2)(const HueRange& skin);    // then inRange, medianBlur 5
  std::unique_ptr<SegmentationPeer> (*knn)(const HueRange& skin);     // then inRange, medianBlur 5
  std::unique_ptr<TilePeer> (*tiles)(int side, int bins);             // calcHist, compareHist
  void (*median)(const Mask& in, int side, Mask& out);                // medianBlur
  std::unique_ptr<StereoPeer> (*stereo)(int disparities, int block);  // StereoBM of grey images
};
extern const OpenCv kOpenCv;

// Embree 3, rtcPointQuery. Throws Error (kind device) if Embree refuses.
[[nodiscard]] std::unique_ptr<NearestPeer> make_embree(const Mesh& mesh);
// Orocos KDL for a chain (ArmKind::chain). Throws like make_embree().
[[nodiscard]] std::unique_ptr<ArmPeer> make_kdl(const ArmMachine& machine);

// Null: the library was missing when this was built.
struct PeersModule {
  std::unique_ptr<NearestPeer> (*embree)(const Mesh& mesh) = nullptr;
  std::unique_ptr<ArmPeer> (*kdl)(const ArmMachine& machine) = nullptr;
  const OpenCv* opencv = nullptr;
};

}  // namespace enc::bench
