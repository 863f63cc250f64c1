// Quality of a set of points for its own registration: the error of each pair by the registration of the
// others, the uncertainty of the pose, and the benefit of averaged frames and more positions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "models/identify/block_fit.h"
#include "models/identify/camera/register.h"

namespace enc::trial {

// Errors along the axes of W, m.
struct AxisBand {
  Vec3 median{kUnset, kUnset, kUnset}, low{kUnset, kUnset, kUnset},
      high{kUnset, kUnset, kUnset};  // 2.5, 97.5 %
};
[[nodiscard]] AxisBand band_of(const std::vector<Vec3>& values);

struct FewerPoints {
  std::size_t pairs = 0, frames = 0;
  AxisBand error;  // mean |error| at the pairs left out
};

struct PointStudy {
  models::Registration found;
  std::array<models::Interval, 3> position;  // X_WC's position, m
  std::array<models::Interval, 3> turn;      // about W's axes, rad: value 0, only the half is useful
  models::Interval scale;                    // 1 for rigid frames
  // Mean |error| of each pair by the registration of all the others: the error to expect at an unused point.
  std::array<models::Interval, 3> left_out;
  std::size_t worst = 0;                     // the pair of the largest such error
  double worst_error = kUnset;               // m
  double usual_error = kUnset;               // m, median of the others
  double frames = 0.0;                       // mean number of frames of a pair
  Vec3 frame_noise{kUnset, kUnset, kUnset};  // rms of a single frame; unset if no pair has two
  Vec3 standing{kUnset, kUnset, kUnset};     // rms of the residual that no averaging of frames removes
  std::vector<FewerPoints> fewer;
};

// Intervals by leaving out one pair at a time (jackknife). Fewer points: random, by the seed.
[[nodiscard]] PointStudy study_points(const models::PointSet& places, std::uint64_t seed = 1);

}  // namespace enc::trial
