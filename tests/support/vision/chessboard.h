// Chessboards before a stereo head that is known: where their corners are seen, and how the whole board
// looks.
#pragma once

#include "core/devices/stereo_rig.h"
#include "core/vision/calibration/corners.h"

namespace enc::test {

// A head with distortion, its right camera turned by a degree or two.
[[nodiscard]] StereoRig known_head(int width, int height);

// px. `p` in the camera, m.
[[nodiscard]] Eigen::Vector2d seen(const Lens& lens, const Vec3& p);

// Boards at half a metre or so in all parts of the image, tilted to all sides; the first corner is the
// origin.
[[nodiscard]] std::vector<Pose<'C', 'O'>> tilted_boards(const Board& board, std::size_t count);

[[nodiscard]] PairCorners projected(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO);

// Each pixel is the mean of 4 x 4 rays.
[[nodiscard]] Image drawn(const Lens& lens, int width, int height, const Board& board, const Quat& turn,
                          const Vec3& place);
struct DrawnPair {
  Image left, right;
};
[[nodiscard]] DrawnPair drawn(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO);

}  // namespace enc::test
