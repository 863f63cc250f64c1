// Dynamic objects, which a finger moves [VisHap 1, 2], prepared, and their law of motion: a ball that is
// knocked away, a tile that is pushed along its path, a surface that runs like that of a drum.
//
// A finger at depth d presses with F = k d while d grows.
//
// Tile: while d falls at the rate v, F = k d (1 - c |v| / v1). v1 = d1 sqrt(k / m) is the speed that a free
// mass would get back from d1, the deepest d of this touch. The tile parts from a finger at constant velocity
// with e times the speed at which they met. Damping that grows with depth is Hunt's and Crossley's (1975);
// our addition is that it acts only while d falls.
//
// Ball: F = q k d, and q falls from 1 as soon as the ball is faster than the pressing finger, V. With q ~
// d^p, the energy at parting is m w^2 / 2 + q k d^2 / (p + 2). w is the ball's speed over the finger's; p
// makes that energy m (e V)^2 / 2. This law needs no rate of d, which encoders measure badly, and it corrects
// itself each tick. q never rises in a touch.
//
// Both laws begin and end with F = 0, never pull, and give back no more energy than was put in.
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

// State of an object that moves, and of the finger in it.
struct MoverState {
  Vec<'W'> shift = Vec<'W'>::zero(), velocity = Vec<'W'>::zero();
  // Depth of the finger at the last tick, m; unset: another object was nearest.
  double depth = kUnset;
  double deepest = 0.0;   // m, largest depth of this touch; 0: no touch
  double firmness = 1.0;  // share of the stiffness that acts now
};

// An obstacle of a tile: a box beside it, in the tile's own axes.
struct Neighbour {
  std::int32_t mover = -1;  // -1: it is fixed
  // Distance of the centres, and sum of the half sizes, m.
  Vec3 apart{0, 0, 0}, sum{0, 0, 0};
};

struct Mover {
  std::int32_t object = -1;
  Interaction kind = Interaction::shift;
  double stiffness = kUnset;            // k, N/m
  double bounce = 0.0;                  // c sqrt(m / k), s, tile only
  double restitution = kUnset;          // e, ball only
  double mass = kUnset;                 // kg
  double friction = 0.0;                // N, tile only
  Vec<'W'> way;                         // unit; tile, and running surface
  double travel = kUnset, speed = 0.0;  // m, m/s
  Point<'W'> centre;                    // ball's rest position: centre of its bounding ball
  double radius = kUnset;               // m
  Quat to_tile{Quat::Identity()};       // rotation from W's axes to the tile's
  std::vector<Neighbour> neighbours{};
};

// The finger in one tick.
struct FingerPress {
  std::int32_t object = -1;  // nearest object
  double depth = kUnset;     // depth in that object, m; negative: outside
  Vec<'W'> normal;           // outward, at the nearest point
  Point<'W'> finger;         // centre of the fingertip
  double radius = 0.0;       // radius of the fingertip, m
  double speed = 0.0;        // m/s, of the pressing finger, against the normal
  // Rate of the depth, m/s, from the arm's motion, because the depth jumps with each picture.
  double sinks = 0.0;
  // The finger is unseen since it last parted from a ball.
  bool late = false;
};

// One tick of all objects. A ball flies without weight or friction until it is `travel` away and waits there.
// It returns to its rest position as soon as the finger is kClear away from that; so does a ball that hardly
// moves. Friction, both ends of its path and its neighbours stop a tile. A running surface stays in place:
// its shift is the distance that it has run.
void move(std::span<const Mover> movers, const FingerPress& press, double dt,
          std::span<MoverState> moved) noexcept;
inline constexpr double kClear = 0.020;  // m

// c of the tile's law for a restitution e of 0.05 to 1.
[[nodiscard]] double bounce_of(double restitution);

// Displacement of the object from its rest position.
[[nodiscard]] inline Vec<'W'> shift_of(const Object& object, std::span<const MoverState> moved) noexcept {
  const bool stands = object.moving < 0 || object.interaction.kind == Interaction::spin;
  return stands ? Vec<'W'>::zero() : moved[static_cast<std::size_t>(object.moving)].shift;
}

// Gives each object with a moving interaction its index in DynamicObjectState::moved. Throws Error (key: that
// of the file).
[[nodiscard]] std::vector<Mover> make_movers(const std::vector<ObjectSpec>& specs,
                                             std::vector<Object>& objects);

}  // namespace enc
