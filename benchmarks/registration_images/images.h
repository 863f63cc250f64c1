// Parts of the benchmark `registration_images`: the guided registration, seen in pictures of the twin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/kit.h"
#include "sim/camera/stage.h"
#include "trial/identify/camera/tip_eyes.h"

namespace enc::bench::registration_images {

// One registration.
struct Asked {
  const sim::CameraModule* camera = nullptr;
  const models::Setup* setup = nullptr;
  const std::vector<trial::TipVisit>* visits = nullptr;
  const std::vector<Point<'W'>>* targets = nullptr;  // all over the volume in view
  std::uint64_t seed = 1;                            // of scenery and noise
  int samples = 0;                                   // of a pixel
  double rod = 0.0;  // m, radius of one from the tip to the arm's base, in the twin's picture; 0: none
};

// The frames of a place: off the truth as the believed head would see it; px of column, row and disparity,
// and m along C.
struct PlaceSeen {
  double depth = kUnset;  // m
  Vec3 bias_px{kUnset, kUnset, kUnset}, scatter_px{kUnset, kUnset, kUnset};
  Vec3 bias{kUnset, kUnset, kUnset}, scatter{kUnset, kUnset, kUnset};
};
struct Seen {
  Vec3 left_over{kUnset, kUnset, kUnset};  // mean |error| at the pairs, m; NaN: too few places were seen
  Vec3 elsewhere{kUnset, kUnset, kUnset};  // all over the volume in view
  std::vector<PlaceSeen> places;
  std::size_t frames = 0, found = 0, other = 0;  // other: more than 5 mm from where it is
  std::vector<double> seconds;                   // CPU time of finding it in a pair
};
[[nodiscard]] Seen registered(const Asked& asked);

// A pair with the outline that was found, as a PNG.
[[nodiscard]] std::string marked_pair(const Asked& asked);

}  // namespace enc::bench::registration_images
