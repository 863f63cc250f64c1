// Embree's point query as in its manual: one triangle geometry, a callback that shrinks the radius.
#include <cmath>
#include <cstddef>
#include <cstring>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <embree3/rtcore.h>

#include "benchmarks/peers/peers.h"
#include "core/base/error.h"

namespace enc::bench {
namespace {

using Vec3f = Eigen::Vector3f;

// Closest point on triangle abc [Ericson 2005, 5.1.5].
Vec3f on_triangle(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a;
  const Vec3f ac = c - a;
  const Vec3f ap = p - a;
  const float d1 = ab.dot(ap);
  const float d2 = ac.dot(ap);
  if (d1 <= 0.0F && d2 <= 0.0F) return a;
  const Vec3f bp = p - b;
  const float d3 = ab.dot(bp);
  const float d4 = ac.dot(bp);
  if (d3 >= 0.0F && d4 <= d3) return b;
  const Vec3f cp = p - c;
  const float d5 = ab.dot(cp);
  const float d6 = ac.dot(cp);
  if (d6 >= 0.0F && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return a + d1 / (d1 - d3) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0F && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const float scale = 1.0F / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

class Embree final : public NearestPeer {
 public:
  explicit Embree(const Mesh& mesh)
      : device_(rtcNewDevice("threads=1")), scene_(device_ != nullptr ? rtcNewScene(device_) : nullptr) {
    if (scene_ == nullptr) throw Error("Embree cannot be started", {}, ErrorKind::device);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    triangles_ = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      for (std::size_t x = 0; x < 3; ++x) vertices_[3 * i + x] = static_cast<float>(mesh.vertices[i][x]);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      for (std::size_t x = 0; x < 3; ++x) triangles_[3 * i + x] = static_cast<unsigned>(mesh.triangles[i][x]);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
      throw Error("Embree cannot build its scene", {}, ErrorKind::device);
  }
  ~Embree() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  NearestPoint nearest(const std::array<float, 3>& p, float radius) override {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    query.x = p[0];
    query.y = p[1];
    query.z = p[2];
    query.radius = radius;
    Hit hit{this, Vec3f(p[0], p[1], p[2]), Vec3f::Constant(NAN), radius * radius};
    rtcPointQuery(scene_, &query, &context, closer, &hit);
    return {{hit.point.x(), hit.point.y(), hit.point.z()}, std::sqrt(hit.square)};
  }

 private:
  struct Hit {
    const Embree* self;
    Vec3f p, point;
    float square;
  };

  [[nodiscard]] Vec3f corner(unsigned primitive, unsigned i) const {
    return Eigen::Map<const Vec3f>(vertices_ + std::size_t{3} * triangles_[std::size_t{3} * primitive + i]);
  }

  static bool closer(RTCPointQueryFunctionArguments* found) {
    Hit& hit = *static_cast<Hit*>(found->userPtr);
    const Embree& self = *hit.self;
    const unsigned k = found->primID;
    const Vec3f point = on_triangle(hit.p, self.corner(k, 0), self.corner(k, 1), self.corner(k, 2));
    const float square = (hit.p - point).squaredNorm();
    if (square >= hit.square) return false;
    hit.square = square;
    hit.point = point;
    found->query->radius = std::sqrt(square);
    return true;
  }

  RTCDevice device_;
  RTCScene scene_;
  float* vertices_ = nullptr;  // Embree's own buffers
  unsigned* triangles_ = nullptr;
};

}  // namespace

std::unique_ptr<NearestPeer> make_embree(const Mesh& mesh) { return std::make_unique<Embree>(mesh); }

}  // namespace enc::bench
