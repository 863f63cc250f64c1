// Whether the camera stands where it was registered, by the prop's own contacts: where a finger that pushes
// the prop is seen, against where the encoders say the prop is. Of inputs and outputs alone, so that it holds
// for real devices, too.
//
// A camera that has moved by m shows every finger by -m beside its place. A press tells the part along its
// normal, whichever sign it has: a finger seen too high pushes the prop before the core believes that it
// touches, one seen too low lies on it later. What is along the surface no press of one surface tells.
#pragma once

#include <vector>

#include "trial/lists/room.h"
#include "trial/trial.h"

namespace enc::trial {

// While a finger pushed the prop down, and both were slow: seen above (+) or below the prop's front, m.
struct SeenPress {
  double began = kUnset;             // s
  Vec3 normal{0, 0, 0};              // in W
  std::int64_t n = 0;                // poses
  double mean = 0.0, squares = 0.0;  // m; sum of squared differences from the mean, m^2
};

// By which way a finger is seen beside its prop, as presses tell it.
struct SeenShift {
  Vec3 shift{0, 0, 0};    // m in W; without the part that no press tells
  double error = kUnset;  // m, standard error of its length
  int ways = 0;           // 1 to 3: directions in which presses tell it
  std::size_t presses = 0;
  double since = kUnset;  // s: when the first of them began
};

class SeenMeasure {
 public:
  static constexpr double kLeast = 2e-3;  // m: twice what vision is wrong by itself
  static constexpr double kSigmas = 4.0;  // of its standard error
  // m: by which pictures are off alike in all presses of a place, so that no number of them tells
  // (docs/reference/vision.md).
  static constexpr double kThroughImages = 1.4e-3;
  static constexpr std::int64_t kPoses = 5;  // of a press that counts

  void see(const Glance& glance);
  [[nodiscard]] std::vector<SeenPress> presses() const;  // those that count
  // Of all presses.
  [[nodiscard]] SeenShift shift() const;
  // Of all presses since some time that all tell the same, where that is more than the bounds; without
  // presses: the camera stands where it was registered, as far as presses tell.
  [[nodiscard]] SeenShift moved() const;

 private:
  struct Moment {
    Time t{};
    std::int64_t push = -1;  // the how manieth; -1: none
    Point<'W'> prop;
    Vec<'W'> normal;
  };
  void remember(const Glance& glance);
  void compare(const Glance& glance, const Moment& then);

  std::vector<Moment> moments_;  // a ring, of the last second
  std::size_t next_ = 0;
  std::int64_t push_ = -1, told_ = -1;  // the newest, and that of the last press
  double pushed_ = 0.0;                 // s, without a break
  double pause_ = 1.0;                  // s since the last push
  std::int32_t object_ = -1;
  Time newest_ = Time::min();
  std::vector<SeenPress> presses_ = with_room<SeenPress>();
};

}  // namespace enc::trial
