// Sequences of painted hands by which vision is judged: five colours of skin, light from before and from
// below, walls with and without the hue of skin, the finger from each side, towards the camera and away from
// it, arms with and without a sleeve, a second hand, a finger that folds.
#pragma once

#include <string>
#include <vector>

#include "tests/support/vision/painter.h"

namespace enc::painted {

struct Sequence {
  std::string name;
  Room room;
  std::size_t tone = 0;
  std::vector<Hand> hands;       // about which they sway
  Vec3 sway{0.045, 0.03, 0.04};  // m
  double phase = 0.0;            // rad
  bool folds = false;            // the finger that points, from the fifth frame to the eleventh
};

// 640 x 480 px, focal length 721 px, baseline 90 mm.
[[nodiscard]] StereoRig head();
[[nodiscard]] std::vector<Hand> hands_at(const Sequence& sequence, int frame);
// Neighbours differ, so that every n-th is a fair choice of all.
[[nodiscard]] std::vector<Sequence> sequences();

// A fingertip that a frame shows, of any hand that points.
struct TipShown {
  Vec3 tip;
  Shown shown;
};
[[nodiscard]] std::vector<TipShown> tips_in(const Painter& painter, const std::vector<Hand>& hands);

}  // namespace enc::painted
