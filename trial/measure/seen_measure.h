// Checks by the prop's own contacts whether the camera is still where it was registered: the tracked position
// of a pushing finger against the prop's position from the encoders. It uses only inputs and outputs, so it
// works with real devices too.
//
// A camera that has moved by m shows every finger displaced by -m. A press reveals the part along its normal,
// with either sign: a finger tracked too high pushes the prop before the core detects a touch, one tracked
// too low rests on it later. Presses on a single surface never reveal the part along that surface.
#pragma once

#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// One press, while a finger pushed the prop down and both were slow: tracked above (+) or below the prop's
// front, m.
struct SeenPress {
  double began = kUnset;             // s
  Vec3 normal{0, 0, 0};              // in W
  std::int64_t n = 0;                // poses
  double mean = 0.0, squares = 0.0;  // m; sum of squared differences from the mean, m^2
};

// Displacement of the tracked finger from its prop, from presses.
struct SeenShift {
  Vec3 shift{0, 0, 0};    // m in W; without the part that no press reveals
  double error = kUnset;  // m, standard error of the shift's length
  int ways = 0;           // 1 to 3: number of directions that presses cover
  std::size_t presses = 0;
  double since = kUnset;  // s: begin of the first of them
};

class SeenMeasure {
 public:
  static constexpr double kLeast = 2e-3;  // m: twice the error of vision itself
  static constexpr double kSigmas = 4.0;  // in standard errors
  // m: common error of the pictures in all presses at one place, which no number of presses reveals
  // (docs/reference/vision.md).
  static constexpr double kThroughImages = 1.4e-3;
  static constexpr std::int64_t kPoses = 5;  // fewest poses of a press that counts

  void see(const Glance& glance);
  [[nodiscard]] std::vector<SeenPress> presses() const;  // the presses that count
  // Shift from all presses.
  [[nodiscard]] SeenShift shift() const;
  // Shift from all presses since some time that agree with each other, if it exceeds the bounds. Without
  // presses, the camera is where it was registered, as far as presses show.
  [[nodiscard]] SeenShift moved() const;

 private:
  struct Moment {
    Time t{};
    std::int64_t push = -1;  // number of the push; -1: no push
    Point<'W'> prop;
    Vec<'W'> normal;
  };
  void remember(const Glance& glance);
  void compare(const Glance& glance, const Moment& then);

  std::vector<Moment> moments_;  // a ring of the last second
  std::size_t next_ = 0;
  // Number of the newest push, and that of the last press.
  std::int64_t push_ = -1, told_ = -1;
  double pushed_ = 0.0;  // s, without a break
  double pause_ = 1.0;   // s since the last push
  std::int32_t object_ = -1;
  Time newest_ = Time::min();
  std::vector<SeenPress> presses_ = with_room<SeenPress>();
};

}  // namespace enc::trial
