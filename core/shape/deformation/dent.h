// Surface deformation: the shown surface, displaced by the tool's tip [VHMR 3.5, Fig 11]. The renderer draws
// it, and the core tests the haptic-tip against it. Derivation: docs/reference/model.md, "The seen surface".
//
// Let q be the tip's deepest point, n the outward normal there, d its depth. Points move against n, in two
// parts. First, a ball behaves as a thin shell: around the contact it sinks by s (1 - (c / L)^2)^3, where c
// is the distance from the undeformed contact. Second, E is the lower boundary of the tip, continued with the
// slope at which the surface leaves the tip. Points that are then still at a height v > 0 over E move down to
// it by u(v); u fades to zero at v = -3b. So the point under the tool moves by d, and far points do not move.
// The surface lies on the tip around that point and never enters it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/sample.h"
#include "core/shape/surface/mesh.h"
#include "core/shape/surface/surface.h"

namespace enc {

// The deepest ball of a tip in an object: its centre, and the surface point under it.
struct DeepestBall {
  Point<'O'> centre;
  SurfacePoint at;  // nearest to the centre
};
// `hint`, here and below: start of the search (surface.h); it never changes a result.
[[nodiscard]] DeepestBall deepest(const Surface& surface, const Tip<'O'>& tip,
                                  std::int32_t hint = -1) noexcept;

// The deformation by a tip, if the tip is below the undeformed surface.
[[nodiscard]] DentSample dent_of(const Surface& surface, std::int32_t object, const Tip<'O'>& tip) noexcept;

// A DentSample prepared for evaluation at many points. T: double, or float for drawing.
template <class T>
struct DentField {
  using Triple = std::array<T, 3>;
  bool active = false;   // false: no displacement
  bool edge = false;     // the tip is swept along `along`
  Triple origin{}, n{};  // q and the outward normal there, in O
  Triple contact{};      // the undeformed contact, q + d n
  T depth{}, blend{};    // d, b
  T sink{}, narrow{};    // s, 1 / L^2
  // Radius of the ball; (sideways extent of its part below the slope)^2.
  T radius{}, cap2{};
  T slope{}, cone{};  // beyond that extent E = cone + slope |w|
  // u is zero if h + reach <= slope |w|; h along n from q, w sideways.
  T reach{};
  Triple along{};  // edge: sideways unit direction; `from` and `to` are its ends
  T from{}, to{};
  // edge: tangent and sine above the tangent plane; rise/sqrt(slope^2 - rise^2).
  T rise{}, lean{}, lean_cone{};
};
[[nodiscard]] DentField<double> dent_field(const Surface& surface, const DentSample& dent,
                                           std::int32_t hint = -1) noexcept;
[[nodiscard]] DentField<float> to_float(const DentField<double>& field) noexcept;

// A displaced surface point, and the normal of the deformed surface there. `normal`: undeformed, outward,
// unit.
struct DisplacedPoint {
  Point<'O'> point;
  Vec<'O'> normal;
  double by = 0.0;  // m, against the field's n
};
[[nodiscard]] DisplacedPoint displaced(const DentField<double>& field, const Point<'O'>& p,
                                       const Vec<'O'>& normal) noexcept;

// As displaced(), for arrays, as the renderer draws them: positions and undeformed unit normals in, displaced
// ones out. In and out must not overlap. No heap; points out of reach are only copied.
struct DentInput {
  const float *x, *y, *z, *nx, *ny, *nz;
};
struct DentOutput {
  float *x, *y, *z, *nx, *ny, *nz;
};
void apply(const DentField<float>& field, const DentInput& in, const DentOutput& out,
           std::size_t count) noexcept;

// Signed distance of p to the deformed surface, m, negative inside. The sign is exact. The magnitude is the
// height over the surface along n times the cosine of its slope, which is the distance near the surface.
[[nodiscard]] double dented_distance(const Surface& surface, const DentSample& dent, const Point<'O'>& p,
                                     std::int32_t hint = -1) noexcept;

// Volume of the deformed mesh minus that of the undeformed one, m^3: negative.
[[nodiscard]] double volume_change(const Mesh& mesh, const DentField<double>& field);

}  // namespace enc
