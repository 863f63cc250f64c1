// What the eye sees: the surface displaced by the tool's tip [VHMR 3.5]. The renderer draws it, the core
// tests the haptic-tip against it. First form, for smooth surfaces; tool shapes and meshes follow.
#pragma once

#include "core/sample.h"
#include "core/surface.h"

namespace enc {

// The dent that a tool's tip makes where it is below the undeformed surface. `tip` is the centre of its
// sphere, in O.
[[nodiscard]] DentSample dent_of(const Surface& surface, std::int32_t object, const Point<'O'>& tip,
                                 double tip_radius) noexcept;

// Signed distance of p to the dented surface, m, negative inside: the undeformed distance plus the inward
// displacement of the surface near p. Under the tool the displacement is the dent's depth, so the surface
// passes through the tip's lowest point.
[[nodiscard]] double dented_distance(const Surface& surface, const DentSample& dent,
                                     const Point<'O'>& p) noexcept;

}  // namespace enc
