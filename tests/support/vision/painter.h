// Paints hands before two pinhole cameras, and the sequences of painted hands by which vision is judged: a
// ray through each pixel, four where a hand has an edge, a wall behind, one lamp and the light of the room,
// shadows, a sensor with noise. The painter shares no code with the twin's renderer, and its ground truth is
// exact.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/devices/device.h"
#include "core/spec/optics_rig.h"
#include "tests/support/vision/painted_hand.h"

namespace enc::painted {

using Colour = std::array<double, 3>;  // linear, 0 to 1: of a white sheet under the lamp 1

// Five colours of skin, light to dark; sRGB with hues of 12 to 24 degrees.
inline constexpr std::size_t kTones = 5;
[[nodiscard]] Colour tone(std::size_t index);

// Office: things of many hues, none of them skin's. Beige has a hue of 34 degrees, plaster and wood one of
// skin.
enum class WallKind : std::uint8_t { office, grey, beige, plaster, wood };

struct Room {
  WallKind wall = WallKind::office;
  double depth = 1.1;           // m, of the wall
  Vec3 lamp{-0.3, -0.8, -0.5};  // towards it, in C
  double lamp_share = 0.55;     // of all light; the rest comes from everywhere
  double light = 1.0;           // times the light that the exposure is set for
  double shadow = 0.5;          // of the lamp's light that a hand takes from the wall
  double noise = 1.5;           // of 255, rms
  std::uint64_t seed = 1;
};

struct Picture {
  Image left, right;
  [[nodiscard]] StereoFrame frame() const { return {left.view(), right.view()}; }
};

// How much of a fingertip the left and the right image show.
struct Shown {
  double share = 0.0;     // of the pixels that its cap would cover, those where it is in front; the lesser
  double coloured = 0.0;  // of the left image's shown pixels: those that have a hue of skin
  double apart = 0.0;     // of the same: those that differ from the wall there by more than the noise
};

class Painter {
 public:
  // Rectified cameras without distortion: of `rig` only sizes, focal lengths, centres and the baseline count.
  Painter(const StereoRig& rig, const Room& room);

  void paint(const std::vector<Hand>& hands, std::size_t tone, std::uint64_t frame, Picture& picture);
  // What the last picture shows of the cap at `tip` of the hand, whose cone is a tip's.
  [[nodiscard]] Shown shown(const Hand& hand, const Vec3& tip) const;

 private:
  struct Eye {
    double focal_x, focal_y, centre_x, centre_y, shift;
    std::vector<Colour> wall;  // of the empty room without the lamp's light, and with it: a pair a pixel
  };
  struct Seen {
    const Cone* cone = nullptr;
    Hit hit;
  };
  [[nodiscard]] Vec3 ray(const Eye& eye, double x, double y) const;
  using Near = std::vector<const Cone*>;
  [[nodiscard]] Near near(const Eye& eye, const Region& tile) const;
  [[nodiscard]] Seen first(const Near& near, const Vec3& from, const Vec3& ray) const;
  [[nodiscard]] Colour colour_of(const Seen& seen, const Vec3& from, const Vec3& ray) const;
  [[nodiscard]] Colour wall_at(const Eye& eye, int x, int y, double sub_x, double sub_y) const;
  void paint_tile(const Eye& eye, const Region& tile, std::vector<Colour>& light) const;
  struct Counts {
    int all = 0, front = 0, coloured = 0, apart = 0;  // pixels
  };
  [[nodiscard]] Counts count_cap(std::size_t side, const Vec3& tip, double radius) const;
  void paint_eye(const Eye& eye, std::uint64_t key, Image& image) const;
  void cast_shadow();
  [[nodiscard]] double lit(double x, double y) const;  // the wall there: 1, or less in a shadow

  StereoRig rig_;
  Room room_;
  std::array<Eye, 2> eyes_;
  Colour skin_{};
  std::vector<Cone> cones_;
  std::vector<double> lit_;  // on a coarse grid of the wall
  Image last_;
};

// Sequences of painted hands by which vision is judged: five colours of skin, light from before and from
// below, walls with and without the hue of skin, the finger from each side, towards the camera and away from
// it, arms with and without a sleeve, a second hand, a finger that folds.
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
