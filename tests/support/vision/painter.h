// Paints hands before two pinhole cameras, and the sequences of painted hands for the evaluation of vision.
// The painter casts one ray through each pixel, four where a hand has an edge. It models a wall, one lamp and
// ambient light, shadows, and a sensor with noise. The painter shares no code with the twin's renderer, and
// its ground truth is exact.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/devices/device.h"
#include "core/spec/optics_rig.h"
#include "tests/support/vision/painted_hand.h"

namespace enc::painted {

using Colour = std::array<double, 3>;  // linear, 0 to 1: a white sheet under the lamp is 1

// Five colours of skin, light to dark; sRGB with hues of 12 to 24 degrees.
inline constexpr std::size_t kTones = 5;
[[nodiscard]] Colour tone(std::size_t index);

// Office: things of many hues, but not of skin's. Beige has a hue of 34 degrees, plaster and wood have a hue
// of skin.
enum class WallKind : std::uint8_t { office, grey, beige, plaster, wood };

struct Room {
  WallKind wall = WallKind::office;
  double depth = 1.1;           // m, depth of the wall
  Vec3 lamp{-0.3, -0.8, -0.5};  // direction to the lamp, in C
  double lamp_share = 0.55;     // lamp's share of the light; the rest is ambient
  double light = 1.0;           // relative to the light that the exposure is set for
  double shadow = 0.5;          // share of the lamp's light that a hand takes from the wall
  double noise = 1.5;           // rms, of 255
  std::uint64_t seed = 1;
};

struct Picture {
  Image left, right;
  [[nodiscard]] StereoFrame frame() const { return {left.view(), right.view()}; }
};

// Visibility of a fingertip in the left and the right image.
struct TipVisibility {
  double share = 0.0;     // share of the cap's pixels where it is in front; the smaller of both images
  double coloured = 0.0;  // share of the left image's shown pixels with a hue of skin
  double apart = 0.0;     // share of them that differs from the wall by more than the noise
};

class Painter {
 public:
  // Rectified cameras without distortion: `rig` gives only sizes, focal lengths, centres and the baseline.
  Painter(const StereoRig& rig, const Room& room);

  void paint(const std::vector<Hand>& hands, std::size_t tone, std::uint64_t frame, Picture& picture);
  // Visibility of the cap at `tip` of the hand in the last picture.
  [[nodiscard]] TipVisibility shown(const Hand& hand, const Vec3& tip) const;

 private:
  struct Eye {
    double focal_x, focal_y, centre_x, centre_y, shift;
    std::vector<Colour> wall;  // per pixel a pair: the empty room without the lamp, and the lamp's light
  };
  struct RayHit {
    const Cone* cone = nullptr;
    Hit hit;
  };
  [[nodiscard]] Vec3 ray(const Eye& eye, double x, double y) const;
  using ConeList = std::vector<const Cone*>;
  [[nodiscard]] ConeList near(const Eye& eye, const Region& tile) const;
  [[nodiscard]] RayHit first(const ConeList& near, const Vec3& from, const Vec3& ray) const;
  [[nodiscard]] Colour colour_of(const RayHit& seen, const Vec3& from, const Vec3& ray) const;
  [[nodiscard]] Colour wall_at(const Eye& eye, int x, int y, double sub_x, double sub_y) const;
  void paint_tile(const Eye& eye, const Region& tile, std::vector<Colour>& light) const;
  struct Counts {
    int all = 0, front = 0, coloured = 0, apart = 0;  // pixels
  };
  [[nodiscard]] Counts count_cap(std::size_t side, const Vec3& tip, double radius) const;
  void paint_eye(const Eye& eye, std::uint64_t key, Image& image) const;
  void cast_shadow();
  [[nodiscard]] double lit(double x, double y) const;  // lamp's light on the wall: 1, or less in a shadow

  StereoRig rig_;
  Room room_;
  std::array<Eye, 2> eyes_;
  Colour skin_{};
  std::vector<Cone> cones_;
  std::vector<double> lit_;  // on a coarse grid of the wall
  Image last_;
};

// Sequences of painted hands for the evaluation of vision. They vary five colours of skin, light from before
// and from below, walls with and without the hue of skin, and the finger's direction. They also vary arms
// with and without a sleeve, a second hand, and a finger that folds.
struct Sequence {
  std::string name;
  Room room;
  std::size_t tone = 0;
  std::vector<Hand> hands;       // mean poses of the sway
  Vec3 sway{0.045, 0.03, 0.04};  // m
  double phase = 0.0;            // rad
  bool folds = false;            // the pointing finger folds from the fifth frame to the eleventh
};

// 640 x 480 px, focal length 721 px, baseline 90 mm.
[[nodiscard]] StereoRig head();
[[nodiscard]] std::vector<Hand> hands_at(const Sequence& sequence, int frame);
// Neighbours differ, so that every n-th sequence is a fair choice.
[[nodiscard]] std::vector<Sequence> sequences();

// A visible fingertip in a frame, of any hand that points.
struct VisibleTip {
  Vec3 tip;
  TipVisibility shown;
};
[[nodiscard]] std::vector<VisibleTip> tips_in(const Painter& painter, const std::vector<Hand>& hands);

}  // namespace enc::painted
