// How far a machine gets on each of the controller's axes, from its zero: what TMN? and TMX? say.
#pragma once

#include "core/machine/reach.h"
#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

struct Travel {
  Coordinates low{}, high{};

  [[nodiscard]] Coordinates both_sides() const noexcept;  // the lesser of the two on each axis
  // The nearest within; true where that is another one.
  bool clamp(Coordinates& at) const noexcept;
};
[[nodiscard]] Travel travel_of(const Reach& reach, const Stand& stand) noexcept;

}  // namespace enc::gcs
