// What a set of points tells of its own registration: how far off each pair is by the registration of the
// others, how sure the pose is, how much averaging frames and more places help.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "models/identify/block_error.h"
#include "models/identify/camera/point_set.h"

namespace enc::trial {

// Errors along the axes of W, m.
struct AxisBand {
  Vec3 median{kUnset, kUnset, kUnset}, low{kUnset, kUnset, kUnset},
      high{kUnset, kUnset, kUnset};  // 2.5, 97.5 %
};
[[nodiscard]] AxisBand band_of(const std::vector<Vec3>& values);

struct FewerPoints {
  std::size_t pairs = 0, frames = 0;
  AxisBand error;  // of mean |error| at the pairs that were left out
};

struct PointStudy {
  models::Registration found;
  std::array<models::Interval, 3> position;  // of X_WC, m
  std::array<models::Interval, 3> turn;      // about W's axes, rad: value 0, only the half is of use
  models::Interval scale;                    // 1 for rigid frames
  // Mean |error| of each pair by the registration of all the others: what a point that was not used would
  // show.
  std::array<models::Interval, 3> left_out;
  std::size_t worst = 0;                     // the pair of the largest such error
  double worst_error = kUnset;               // m
  double usual_error = kUnset;               // m, median of the others
  double frames = 0.0;                       // of a pair, on average
  Vec3 frame_noise{kUnset, kUnset, kUnset};  // rms of a single frame; unset where no pair has two
  Vec3 standing{kUnset, kUnset, kUnset};     // rms of what is left over and no averaging of frames takes away
  std::vector<FewerPoints> fewer;
};

// Intervals from leaving out one pair at a time (jackknife). Fewer points: at random, by the seed.
[[nodiscard]] PointStudy study_points(const models::PointSet& places, std::uint64_t seed = 1);

}  // namespace enc::trial
