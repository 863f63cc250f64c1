// The dent over arrays of floats: a renderer's whole mesh at once.
#include <algorithm>

#include "core/dent_field.h"

namespace enc {
namespace {

constexpr std::size_t kBlock = 16;  // points that are tested, and skipped, together

// Whether any of these points can move.
bool any_in_reach(const DentField<float>& f, const float* x, const float* y, const float* z,
                  std::size_t count) {
  int any = 0;
  const float slope2 = f.slope * f.slope;
  for (std::size_t i = 0; i < count; ++i) {
    const float px = x[i] - f.origin[0];
    const float py = y[i] - f.origin[1];
    const float pz = z[i] - f.origin[2];
    const float h = px * f.n[0] + py * f.n[1] + pz * f.n[2];
    const float aside2 = px * px + py * py + pz * pz - h * h;
    const float up = h + f.reach;
    any |= static_cast<int>(up > 0.0F) & static_cast<int>(up * up > slope2 * aside2);
  }
  return any != 0;
}

template <bool kEdge>
void displace(const DentField<float>& field, const float* __restrict x, const float* __restrict y,
              const float* __restrict z, const float* __restrict nx, const float* __restrict ny,
              const float* __restrict nz, float* __restrict ox, float* __restrict oy, float* __restrict oz,
              float* __restrict onx, float* __restrict ony, float* __restrict onz, std::size_t count) {
  const DentField<float> f = field;  // a copy of its own: nothing written can change it
  for (std::size_t i = 0; i < count; ++i) {
    const auto s = detail::shift<kEdge>(f, x[i], y[i], z[i]);
    ox[i] = x[i] - s.by * f.n[0];
    oy[i] = y[i] - s.by * f.n[1];
    oz[i] = z[i] - s.by * f.n[2];
    const float on = s.share * (nx[i] * f.n[0] + ny[i] * f.n[1] + nz[i] * f.n[2]);
    const float keep = 1.0F - s.share;
    const float tx = keep * nx[i] + on * (f.n[0] - s.gx);
    const float ty = keep * ny[i] + on * (f.n[1] - s.gy);
    const float tz = keep * nz[i] + on * (f.n[2] - s.gz);
    const float unit = 1.0F / std::sqrt(tx * tx + ty * ty + tz * tz);
    onx[i] = s.share > 0.0F ? tx * unit : nx[i];
    ony[i] = s.share > 0.0F ? ty * unit : ny[i];
    onz[i] = s.share > 0.0F ? tz * unit : nz[i];
  }
}

}  // namespace

void apply(const DentField<float>& field, const DentIn& in, const DentOut& out, std::size_t count) noexcept {
  const auto block = field.edge ? displace<true> : displace<false>;
  std::size_t still = 0;  // from here on nothing moves; copied in one go
  const auto copy_up_to = [&](std::size_t end) {
    std::copy(in.x + still, in.x + end, out.x + still);
    std::copy(in.y + still, in.y + end, out.y + still);
    std::copy(in.z + still, in.z + end, out.z + still);
    std::copy(in.nx + still, in.nx + end, out.nx + still);
    std::copy(in.ny + still, in.ny + end, out.ny + still);
    std::copy(in.nz + still, in.nz + end, out.nz + still);
  };
  for (std::size_t i = 0; field.active && i < count; i += kBlock) {
    const std::size_t n = std::min(kBlock, count - i);
    if (!any_in_reach(field, in.x + i, in.y + i, in.z + i, n)) continue;
    copy_up_to(i);
    still = i + n;
    block(field, in.x + i, in.y + i, in.z + i, in.nx + i, in.ny + i, in.nz + i, out.x + i, out.y + i,
          out.z + i, out.nx + i, out.ny + i, out.nz + i, n);
  }
  copy_up_to(count);
}

DentField<float> to_float(const DentField<double>& from) noexcept {
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const auto narrow3 = [&](const std::array<double, 3>& a) {
    return std::array<float, 3>{narrow(a[0]), narrow(a[1]), narrow(a[2])};
  };
  return {from.active,           from.edge,          narrow3(from.origin), narrow3(from.n),
          narrow(from.depth),    narrow(from.blend), narrow(from.radius),  narrow(from.cap2),
          narrow(from.slope),    narrow(from.cone),  narrow(from.reach),   narrow3(from.along),
          narrow(from.from),     narrow(from.to),    narrow(from.rise),    narrow(from.lean),
          narrow(from.lean_cone)};
}

}  // namespace enc
