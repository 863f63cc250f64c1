// The dent over arrays of floats: a renderer's whole mesh at once.
#include <algorithm>

#include "core/shape/deformation/dent_field.h"

namespace enc {
namespace {

constexpr std::size_t kBlock = 16;  // points that are tested, and skipped, together

// What can move these points: nothing, only the ball that sinks, or also the tip.
enum class Moves : int { nothing, ball, tip };

// Tells it for a block of points; what is the same for all of them is computed once.
class Range {
 public:
  explicit Range(const DentField<float>& field) : f_(field) {
    const float wide = f_.sink > 0.0F ? 1.0F / std::sqrt(f_.narrow) : 0.0F;
    lowest_ = f_.origin[0] * f_.n[0] + f_.origin[1] * f_.n[1] + f_.origin[2] * f_.n[2] -
              std::max(f_.reach, wide - f_.depth);
    wide2_ = f_.sink > 0.0F ? wide * wide : -1.0F;
    slope2_ = f_.slope * f_.slope;
  }

  [[nodiscard]] Moves operator()(const float* x, const float* y, const float* z, std::size_t count) const {
    int any = 0;  // most blocks are too low for both
    for (std::size_t i = 0; i < count; ++i)
      any |= static_cast<int>(x[i] * f_.n[0] + y[i] * f_.n[1] + z[i] * f_.n[2] > lowest_);
    if (any == 0) return Moves::nothing;
    int by_tip = 0;
    int by_ball = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const float px = x[i] - f_.contact[0];
      const float py = y[i] - f_.contact[1];
      const float pz = z[i] - f_.contact[2];
      const float h = px * f_.n[0] + py * f_.n[1] + pz * f_.n[2];
      const float away2 = px * px + py * py + pz * pz;
      const float up = h + f_.depth + f_.reach;
      by_tip |= static_cast<int>(up > 0.0F) & static_cast<int>(up * up > slope2_ * (away2 - h * h));
      by_ball |= static_cast<int>(away2 < wide2_);
    }
    if (by_tip != 0) return Moves::tip;
    return by_ball != 0 ? Moves::ball : Moves::nothing;
  }

 private:
  const DentField<float> f_;  // a copy of its own: nothing written can change it
  float lowest_, wide2_, slope2_;
};

template <Moves kMoves, bool kEdge>
void displace(const DentField<float>& field, const float* __restrict x, const float* __restrict y,
              const float* __restrict z, const float* __restrict nx, const float* __restrict ny,
              const float* __restrict nz, float* __restrict ox, float* __restrict oy, float* __restrict oz,
              float* __restrict onx, float* __restrict ony, float* __restrict onz, std::size_t count) {
  const DentField<float> f = field;  // a copy of its own: nothing written can change it
  for (std::size_t i = 0; i < count; ++i) {
    const auto s = kMoves == Moves::tip ? detail::shift<kEdge>(f, x[i], y[i], z[i])
                                        : detail::sinking(f, x[i], y[i], z[i]);
    ox[i] = x[i] - s.by * f.n[0];
    oy[i] = y[i] - s.by * f.n[1];
    oz[i] = z[i] - s.by * f.n[2];
    const float along = nx[i] * f.n[0] + ny[i] * f.n[1] + nz[i] * f.n[2];
    const float keep = 1.0F - (s.gx * f.n[0] + s.gy * f.n[1] + s.gz * f.n[2]);
    const float tx = keep * nx[i] + along * s.gx;
    const float ty = keep * ny[i] + along * s.gy;
    const float tz = keep * nz[i] + along * s.gz;
    const float unit = 1.0F / std::sqrt(tx * tx + ty * ty + tz * tz);
    onx[i] = s.by > 0.0F ? tx * unit : nx[i];
    ony[i] = s.by > 0.0F ? ty * unit : ny[i];
    onz[i] = s.by > 0.0F ? tz * unit : nz[i];
  }
}

void copy(const DentField<float>& /*field*/, const float* x, const float* y, const float* z, const float* nx,
          const float* ny, const float* nz, float* ox, float* oy, float* oz, float* onx, float* ony,
          float* onz, std::size_t count) {
  std::copy_n(x, count, ox);
  std::copy_n(y, count, oy);
  std::copy_n(z, count, oz);
  std::copy_n(nx, count, onx);
  std::copy_n(ny, count, ony);
  std::copy_n(nz, count, onz);
}

}  // namespace

void apply(const DentField<float>& field, const DentIn& in, const DentOut& out, std::size_t count) noexcept {
  const Range range(field);
  const auto moves = [&](std::size_t at) {
    if (!field.active || at >= count) return Moves::nothing;
    return range(in.x + at, in.y + at, in.z + at, std::min(kBlock, count - at));
  };
  const auto run = [&](Moves by, std::size_t at, std::size_t size) {
    const auto to = [&](auto move) {
      move(field, in.x + at, in.y + at, in.z + at, in.nx + at, in.ny + at, in.nz + at, out.x + at, out.y + at,
           out.z + at, out.nx + at, out.ny + at, out.nz + at, size);
    };
    if (by == Moves::nothing) return to(copy);
    if (by == Moves::ball) return to(displace<Moves::ball, false>);
    field.edge ? to(displace<Moves::tip, true>) : to(displace<Moves::tip, false>);
  };
  // Blocks that are alike go together.
  std::size_t begin = 0;
  Moves now = moves(0);
  for (std::size_t end = kBlock; begin < count; end += kBlock) {
    const Moves next = moves(end);
    if (end < count && next == now) continue;
    run(now, begin, std::min(end, count) - begin);
    begin = end;
    now = next;
  }
}

DentField<float> to_float(const DentField<double>& from) noexcept {
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const auto narrow3 = [&](const std::array<double, 3>& a) {
    return std::array<float, 3>{narrow(a[0]), narrow(a[1]), narrow(a[2])};
  };
  return {from.active,           from.edge,           narrow3(from.origin), narrow3(from.n),
          narrow3(from.contact), narrow(from.depth),  narrow(from.blend),   narrow(from.sink),
          narrow(from.narrow),   narrow(from.radius), narrow(from.cap2),    narrow(from.slope),
          narrow(from.cone),     narrow(from.reach),  narrow3(from.along),  narrow(from.from),
          narrow(from.to),       narrow(from.rise),   narrow(from.lean),    narrow(from.lean_cone)};
}

}  // namespace enc
