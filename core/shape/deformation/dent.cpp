#include "core/shape/deformation/dent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace enc {
namespace {

// ---- The one formula of the deformation, for a single point, in double for the core and in float for
// drawing.

template <class T>
struct Shift {
  T by;          // displacement against n, m
  T gx, gy, gz;  // its gradient
};

// Displacement of a sinking ball, without the tip: by = s (1 - |c|^2 / L^2)^3.
template <class T>
Shift<T> sinking(const DentField<T>& f, T x, T y, T z) noexcept {
  const T cx = x - f.contact[0];
  const T cy = y - f.contact[1];
  const T cz = z - f.contact[2];
  const T inside = T(1) - (cx * cx + cy * cy + cz * cz) * f.narrow;
  const T t = inside > T(0) ? inside : T(0);
  const T part = f.sink * (t * t);
  const T slope = T(-6) * f.narrow * part;
  return {part * t, slope * cx, slope * cy, slope * cz};
}

// Finds the ball of the edge that is lowest at an offset w sideways of n: there its surface has the edge's
// own slope. Returns its position along the edge, m.
template <class T>
T lowest_on_edge(const DentField<T>& f, T wx, T wy, T wz) noexcept {
  const T r2 = f.radius * f.radius;
  const T t = wx * f.along[0] + wy * f.along[1] + wz * f.along[2];
  const T all = wx * wx + wy * wy + wz * wz - t * t;
  const T side2 = all > T(0) ? all : T(0);
  const T under = r2 > side2 ? r2 - side2 : T(0);
  const T ahead = f.lean * std::sqrt(under);
  const T ahead_cone = f.lean_cone * std::sqrt(side2);
  const T wanted = t - (ahead * ahead + side2 <= f.cap2 ? ahead : ahead_cone);
  const T above = wanted > f.from ? wanted : f.from;
  return above < f.to ? above : f.to;
}

// Every branch can become a selection, so the compiler vectorises the loop over arrays.
template <bool kEdge, class T>
Shift<T> shift(const DentField<T>& f, T x, T y, T z) noexcept {
  const T px = x - f.origin[0];
  const T py = y - f.origin[1];
  const T pz = z - f.origin[2];
  const T h = px * f.n[0] + py * f.n[1] + pz * f.n[2];
  T wx = px - h * f.n[0];
  T wy = py - h * f.n[1];
  T wz = pz - h * f.n[2];
  const Shift<T> ball = sinking(f, x, y, z);
  const T r2 = f.radius * f.radius;
  T low = T(0);
  if constexpr (kEdge) {
    const T at = lowest_on_edge(f, wx, wy, wz);
    wx -= at * f.along[0];
    wy -= at * f.along[1];
    wz -= at * f.along[2];
    low = at * f.rise;
  }
  const T w2 = wx * wx + wy * wy + wz * wz;
  const bool round = w2 <= f.cap2;
  const T root = std::sqrt(round ? r2 - w2 : w2);
  const T boundary = low + (round ? f.radius - root : f.cone + f.slope * root);
  const T steep = (round ? T(1) : f.slope) / root;
  const T v = h - ball.by - boundary;
  // u = b t^4 up to v = b, then v itself; t = (v + 3b) / 4b.
  const T per_width = T(1) / (T(4) * f.blend);  // equal for all points
  const T wide = (v + T(3) * f.blend) * per_width;
  const T positive = wide > T(0) ? wide : T(0);
  const T t = positive < T(1) ? positive : T(1);
  const T beyond = v > f.blend ? v - f.blend : T(0);
  const T share = t * t * t;  // du/dv: 1 on the tip
  const T rest = T(1) - share;
  const T side = -share * steep;
  return {ball.by + f.blend * (t * t) * (t * t) + beyond,  //
          rest * ball.gx + share * f.n[0] + side * wx,     //
          rest * ball.gy + share * f.n[1] + side * wy,     //
          rest * ball.gz + share * f.n[2] + side * wz};
}

// Depth by which the contact sinks with the ball itself, and radius of that depression: shares of the ball's
// radius. Calibrated at 2 and 6 mm on a pressed tennis ball [docs/notes/deformation.md]: at first the felt
// yields, then the wall. A half space does not sink.
constexpr double kStiff = 0.116;
constexpr double kSinking = 0.80;

// The slope at which the surface leaves the tip: twice the slope sqrt(d/R) at the rim of the dimple of a thin
// ball [sources/ball 2, Pogorelov]. A half space dents over a few depths: 10/3 d.
double leaving_slope(double size, double depth, const DentSample& dent, const Vec3& n) {
  const double own = std::isfinite(size) ? 2.0 * std::sqrt(depth / size) : 0.75;
  if (dent.tip.shape != TipShape::cone) return own;
  // No steeper than the flattest line on the cone's side; for a cone that nearly lies on its side the slope
  // is bounded.
  const double tilt = std::acos(std::clamp(dent.tip.axis.e().dot(n), -1.0, 1.0));
  const double flank = 0.5 * std::numbers::pi - (dent.tip.half_angle + tilt);
  return std::min(own, std::tan(std::max(flank, 0.1)));
}

// The rest of the edge, relative to its deepest ball. If the edge rises faster than the surface leaves it,
// only that ball counts.
void sweep(DentField<double>& field, const Tip<'O'>& tip, const Vec3& centre, const Vec3& n) {
  const double at = tip.axis.e().dot(centre - tip.centre.e());
  const double up = tip.axis.e().dot(n);
  const Vec3 side = tip.axis.e() - up * n;
  const double flat = side.norm();
  if (std::abs(up) >= field.slope * flat * (1.0 - 1e-6)) return;
  // Sweep along the edge towards its rising end; level edges are swept both ways.
  const double sign = up < 0.0 ? -1.0 : 1.0;
  const bool level = std::abs(up) < 1e-5;
  field.edge = true;
  Vec3::Map(field.along.data()) = sign * side / flat;
  field.to = std::max(0.0, flat * (0.5 * tip.length - sign * at));
  field.from = level ? std::min(0.0, -flat * (0.5 * tip.length + sign * at)) : 0.0;
  field.rise = level ? 0.0 : std::abs(up) / flat;
  field.lean = level ? 0.0 : std::abs(up);
  field.lean_cone = field.rise / std::sqrt(field.slope * field.slope - field.rise * field.rise);
  field.reach += field.slope * std::max(field.to, -field.from);
}

Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

Shift<double> shift_at(const DentField<double>& field, const Point<'O'>& p) {
  if (!field.active) return {};
  return field.edge ? shift<true>(field, p.xyz[0], p.xyz[1], p.xyz[2])
                    : shift<false>(field, p.xyz[0], p.xyz[1], p.xyz[2]);
}

// The undeformed surface above or below p along n: Newton steps on the distance. False if there is no
// surface, or if it turns away from n.
bool surface_over(const Surface& surface, const Vec3& n, const Point<'O'>& p, SurfacePoint at, double& up) {
  constexpr double kFlat = 0.2;
  up = 0.0;
  for (int i = 0; i < 12; ++i) {
    const double slope = at.normal.e().dot(n);
    if (slope < kFlat) return false;
    up -= at.distance / slope;
    at = surface.nearest(p + up * Vec<'O'>(n), at.feature);
    if (std::abs(at.distance) < 1e-10) return at.normal.e().dot(n) >= kFlat;
  }
  return false;
}

}  // namespace

DeepestBall deepest(const Surface& surface, const Tip<'O'>& tip, std::int32_t hint) noexcept {
  DeepestBall found{tip.centre, surface.nearest(tip.centre, hint)};
  if (tip.shape != TipShape::edge) return found;
  // The distance is least where the normal is at right angles to the edge: secant steps kept in the bracket.
  const auto slope = [&] { return found.at.normal.e().dot(tip.axis.e()); };
  const auto go = [&](double s) {
    found.centre = tip.centre + s * tip.axis;
    found.at = surface.nearest(found.centre, found.at.feature);
    return slope();
  };
  constexpr double kLevel = 1e-7;
  if (std::abs(slope()) < kLevel) return found;
  double s0 = slope() > 0.0 ? -0.5 * tip.length : 0.0;
  double s1 = s0 + 0.5 * tip.length;
  double g1 = s0 < 0.0 ? slope() : go(s1);
  if (g1 <= 0.0) return found;  // still falling at the end of the edge
  double g0 = s0 < 0.0 ? go(s0) : 0.0;
  if (s0 < 0.0 && g0 >= 0.0) return found;
  if (!(s0 < 0.0)) g0 = go(s0);
  for (int i = 0; i < 40; ++i) {
    const double s = std::clamp((s0 * g1 - s1 * g0) / (g1 - g0), s0, s1);
    const double g = go(i % 3 == 2 ? 0.5 * (s0 + s1) : s);
    const double here = (found.centre - tip.centre).e().dot(tip.axis.e());
    if (std::abs(g) < kLevel || s1 - s0 < 1e-9) break;
    (g > 0.0 ? s1 : s0) = here;
    (g > 0.0 ? g1 : g0) = g;
  }
  return found;
}

DentSample dent_of(const Surface& surface, std::int32_t object, const Tip<'O'>& tip) noexcept {
  return {object, tip, std::max(0.0, tip.radius - deepest(surface, tip).at.distance)};
}

DentField<double> dent_field(const Surface& surface, const DentSample& dent, std::int32_t hint) noexcept {
  constexpr double kPoint = 0.2e-3;  // m: a sharper tip is drawn with this radius, its lowest point unchanged
  DentField<double> field;
  if (!(dent.depth > 0.0)) return field;
  const DeepestBall at = deepest(surface, dent.tip, hint);
  const Vec3 n = at.at.normal.e();
  field.active = true;
  Vec3::Map(field.n.data()) = n;
  Vec3::Map(field.origin.data()) = at.centre.e() - dent.tip.radius * n;
  Vec3::Map(field.contact.data()) = at.centre.e() - (dent.tip.radius - dent.depth) * n;
  field.depth = dent.depth;
  const double size = surface.bound().radius;
  if (std::isfinite(size)) {
    field.sink = dent.depth * dent.depth / (dent.depth + kStiff * size);
    field.narrow = 1.0 / (kSinking * size * kSinking * size);
  }
  field.blend = 0.5 * (dent.depth - field.sink);
  field.radius = std::max(dent.tip.radius, kPoint);
  field.slope = leaving_slope(size, dent.depth, dent, n);
  const double cosine = 1.0 / std::sqrt(1.0 + field.slope * field.slope);
  const double cap = field.radius * field.slope * cosine;
  field.cap2 = cap * cap;
  field.cone = field.radius * (1.0 - 1.0 / cosine);
  field.reach = 3.0 * field.blend - field.cone;
  if (dent.tip.shape == TipShape::edge) sweep(field, dent.tip, at.centre.e(), n);
  return field;
}

DisplacedPoint displaced(const DentField<double>& field, const Point<'O'>& p,
                         const Vec<'O'>& normal) noexcept {
  const auto shift = shift_at(field, p);
  if (!(shift.by > 0.0)) return {p, normal, 0.0};
  // x -> x - n by(x) has the gradient I - n g^T; normals go with its inverse transpose.
  const Vec3 n = vec(field.n);
  const Vec3 g(shift.gx, shift.gy, shift.gz);
  const Vec3 turned = (1.0 - g.dot(n)) * normal.e() + normal.e().dot(n) * g;
  return {p - shift.by * Vec<'O'>(n), Vec<'O'>(turned.normalized()), shift.by};
}

double dented_distance(const Surface& surface, const DentSample& dent, const Point<'O'>& p,
                       std::int32_t hint) noexcept {
  const SurfacePoint at = surface.nearest(p, hint);
  const DentField<double> field = dent_field(surface, dent, at.feature);
  if (!field.active) return at.distance;
  const Vec3 n = vec(field.n);
  const Vec3 from_tip = p.e() - vec(field.origin);
  const double aside = (from_tip - from_tip.dot(n) * n).norm();
  const bool on_tip = field.slope * aside < 2.0 * field.depth + field.reach;
  const bool sunk = field.sink > 0.0 && aside * aside * field.narrow < 1.0;
  if (!on_tip && !sunk) return at.distance;
  double up = 0.0;
  if (!surface_over(surface, n, p, at, up)) return at.distance;
  const Point<'O'> top = p + up * Vec<'O'>(n);
  const DisplacedPoint seen = displaced(field, top, surface.nearest(top, at.feature).normal);
  return seen.by > 0.0 ? (seen.by - up) * seen.normal.e().dot(n) : at.distance;
}

double volume_change(const Mesh& mesh, const DentField<double>& field) {
  double six = 0.0;
  for (const auto& triangle : mesh.triangles) {
    Mat3 before;
    Mat3 after;
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = vec(mesh.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])]);
      before.col(i) = p;
      after.col(i) = p - shift_at(field, Point<'O'>(p)).by * vec(field.n);
    }
    if (after != before) six += after.determinant() - before.determinant();
  }
  return six / 6.0;
}

// ---- The dent over arrays of floats: a renderer's whole mesh at once.

namespace {

constexpr std::size_t kBlock = 16;  // points that are tested, and skipped, as a block

// The cause that can move these points: none, only the sinking ball, or also the tip.
enum class Moves : int { nothing, ball, tip };

// Finds that cause for a block of points; values common to all blocks are computed once.
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
  const DentField<float> f_;  // own copy: no write can change it
  float lowest_, wide2_, slope2_;
};

template <Moves kMoves, bool kEdge>
void displace(const DentField<float>& field, const float* __restrict x, const float* __restrict y,
              const float* __restrict z, const float* __restrict nx, const float* __restrict ny,
              const float* __restrict nz, float* __restrict ox, float* __restrict oy, float* __restrict oz,
              float* __restrict onx, float* __restrict ony, float* __restrict onz, std::size_t count) {
  const DentField<float> f = field;  // own copy: no write can change it
  for (std::size_t i = 0; i < count; ++i) {
    const auto s = kMoves == Moves::tip ? shift<kEdge>(f, x[i], y[i], z[i]) : sinking(f, x[i], y[i], z[i]);
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

void apply(const DentField<float>& field, const DentInput& in, const DentOutput& out,
           std::size_t count) noexcept {
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
  // Adjacent blocks with the same cause are computed together.
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
