// The ball that replaces the arm's tip during the registration of camera and arm: part of the rig table
// [vision].
#pragma once

namespace enc {

struct BallSpec {
  double radius = 0.012;          // m
  double hue = 6.11;              // rad: a red beside purple, which is rare in skin and in rooms
  double hue_within = 0.26;       // rad, either way
  double least_saturation = 0.5;  // least saturation of its pixels: chroma over the brightest channel
};

}  // namespace enc
