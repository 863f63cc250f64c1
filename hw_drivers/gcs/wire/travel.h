// Range of a machine on each of the controller's axes, from its zero, as TMN? and TMX? report it.
#pragma once

#include "core/machine/reach.h"
#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

struct Travel {
  Coordinates low{}, high{};

  [[nodiscard]] Coordinates both_sides() const noexcept;  // the smaller of the two on each axis
  // Limits `at` to the range; returns true if that changed it.
  bool clamp(Coordinates& at) const noexcept;
};
[[nodiscard]] Travel travel_of(const Reach& reach, const Stand& stand) noexcept;

}  // namespace enc::gcs
