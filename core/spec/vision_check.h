// Checks the limits of vision, in one place: for a rig file before any part is made, and for each part that
// is made.
#pragma once

#include "core/spec/optics_rig.h"
#include "core/spec/vision_rig.h"

namespace enc {

inline constexpr int kMostDisparity = 512;  // px: largest number of positions compared for a block

// Each function throws Error in one line with the key of the rig file.
void check(const SegmentationSpec& spec);
// `per_disparity`: px of radius for each px of disparity, R / B; `r_most`, px: radius at the nearest depth.
void check(const FingertipSpec& spec, double per_disparity, double r_most);
void check(const TrackSpec& spec);
void check(const BallSpec& spec);
// `product`, px m: focal length times baseline.
void check(const MatchSpec& spec, double product);
// Checks rate and latency.
void check_timing(const StereoRig& camera);
// Checks all of them, and camera against vision. models/setup/calibration_files.h checks the camera's own
// numbers.
void check(const StereoRig& camera, const VisionRig& vision);

}  // namespace enc
