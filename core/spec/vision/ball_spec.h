// The ball that stands for the arm's tip while camera and arm are registered: part of the rig table [vision].
#pragma once

namespace enc {

struct BallSpec {
  double radius = 0.012;          // m
  double hue = 6.11;              // rad: a red beside purple, which neither skin nor much of a room has
  double hue_within = 0.26;       // rad, either way
  double least_saturation = 0.5;  // of its pixels: chroma over the brightest channel
};

}  // namespace enc
