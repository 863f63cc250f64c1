// Objects that a finger moves [VisHap 1, 2]: a ball that is knocked away, a tile that is pushed along its
// way, a surface that runs like that of a drum. Made ready, and their law of motion.
//
// A finger at depth d presses with F = k d while d grows.
//
// A tile: while d falls at the rate v, F = k d (1 - c |v| / v1); v1 = d1 sqrt(k / m) is the speed that a free
// mass would get back from the deepest d of this touch, d1. It parts from a finger that goes on evenly with e
// times the speed at which they met. A damping that grows with depth is Hunt's and Crossley's (1975); that it
// acts on the way back alone is ours.
//
// A ball: F = q k d, and q falls from 1 on as soon as the ball is faster than what presses it, V: with q ~
// d^p, m w^2 / 2 + q k d^2 / (p + 2) is the energy of parting, w being the speed by which it is faster, and p
// is that which makes it m (e V)^2 / 2. It needs no rate of d, which encoders know badly, and sets itself
// right each tick. q never rises in a touch.
//
// Both begin and end with F = 0, never pull, and give back no more than was put in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/frames.h"
#include "core/control/world/object.h"
#include "core/spec/interaction.h"

namespace enc {

inline constexpr std::size_t kMostMoving = 16;  // objects of a scene that can move

// How far an object that moves has got, and what its finger does.
struct Moved {
  Vec<'W'> shift = Vec<'W'>::zero(), velocity = Vec<'W'>::zero();
  double depth = kUnset;  // of the finger in it, m, at the last tick; unset: another object was nearest
  double deepest = 0.0;   // that of this touch, m; 0: they are apart
  double firmness = 1.0;  // share of its stiffness that is felt now
};

// What a tile may meet: a box beside it, in the tile's own axes.
struct Neighbour {
  std::int32_t mover = -1;            // -1: it stands
  Vec3 apart{0, 0, 0}, sum{0, 0, 0};  // between the centres, and of the half sizes, m
};

struct Mover {
  std::int32_t object = -1;
  Interaction kind = Interaction::shift;
  double stiffness = kUnset;            // k, N/m
  double bounce = 0.0;                  // c sqrt(m / k), s, of a tile
  double restitution = kUnset;          // e, of a ball
  double mass = kUnset;                 // kg
  double friction = 0.0;                // N, of a tile
  Vec<'W'> way;                         // unit: of a tile, and of a surface that runs
  double travel = kUnset, speed = 0.0;  // m, m/s
  Point<'W'> centre;                    // of a ball that holds it where it belongs
  double radius = kUnset;               // m
  Quat to_tile{Quat::Identity()};       // from W's axes to the tile's
  std::vector<Neighbour> neighbours{};
};

// What the finger does in a tick.
struct FingerPress {
  std::int32_t object = -1;  // that it is nearest to
  double depth = kUnset;     // in that, m; negative: outside
  Vec<'W'> normal;           // outward, there
  Point<'W'> finger;         // centre of its tip
  double radius = 0.0;       // of that, m
  double speed = 0.0;        // of what presses, against the normal, m/s
  double sinks = 0.0;        // rate of the depth, m/s: by what is felt, as the depth leaps with a picture
  bool late = false;         // the finger has not been seen since it last parted from a ball
};

// One tick of all of them. A ball flies on without weight or friction until it is `travel` away, waits there,
// and is back where it belongs as soon as the finger is kClear away from that; one that hardly
// moves, too. A tile stops by friction, at
// both ends of its way and at its neighbours. A running surface does not leave its place: its shift is how
// far it has run.
void move(std::span<const Mover> movers, const FingerPress& press, double dt,
          std::span<Moved> moved) noexcept;
inline constexpr double kClear = 0.020;  // m

// c of the law above, of a tile, for a restitution e of 0.05 to 1.
[[nodiscard]] double bounce_of(double restitution);

// How far the object stands from where it belongs.
[[nodiscard]] inline Vec<'W'> shift_of(const Object& object, std::span<const Moved> moved) noexcept {
  const bool stands = object.moving < 0 || object.interaction.kind == Interaction::spin;
  return stands ? Vec<'W'>::zero() : moved[static_cast<std::size_t>(object.moving)].shift;
}

// Objects with an interaction that moves get their place in Pushing::moved. Throws Error (key: that of the
// file).
[[nodiscard]] std::vector<Mover> make_movers(const std::vector<ObjectSpec>& specs,
                                             std::vector<Object>& objects);

}  // namespace enc
