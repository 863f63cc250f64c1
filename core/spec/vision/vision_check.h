// What vision cannot work with, said once: of a rig file before anything is made, and by whoever makes a
// part.
#pragma once

#include "core/spec/vision/stereo_rig.h"
#include "core/spec/vision/vision_rig.h"

namespace enc {

inline constexpr int kMostDisparity = 512;  // px: so many places a block is compared with at once

// Each throws Error in one line with the key of the rig file.
void check(const SegmentationSpec& spec);
// `per_disparity`: px of radius for a px of disparity, R / B; `r_most`, px: of the nearest depth.
void check(const FingertipSpec& spec, double per_disparity, double r_most);
void check(const TrackSpec& spec);
void check(const BallSpec& spec);
// `product`, px m: focal length times baseline.
void check(const MatchSpec& spec, double product);
// Of rate and latency.
void check_timing(const StereoRig& camera);
// All of them, with what camera and vision are to each other. The camera's own numbers are
// models/setup/stereo_file.h's.
void check(const StereoRig& camera, const VisionRig& vision);

}  // namespace enc
