// Chessboards before a known stereo head: the image places of their corners, and pictures of the whole board.
#pragma once

#include "core/spec/optics_rig.h"
#include "models/identify/stereo/corners.h"

namespace enc::test {

// A head with distortion, its right camera turned by a degree or two.
[[nodiscard]] StereoRig known_head(int width, int height);

// Model of a lens: with its distortion, or a fisheye. A fisheye's distance from the axis is focal length
// times angle, without distortion.
enum class Bend : std::uint8_t { distortion, fisheye };

// Image place in px. `p` in the camera, m.
[[nodiscard]] Eigen::Vector2d seen(const Lens& lens, const Vec3& p, Bend bend = Bend::distortion);

// Boards at half a metre or so in all parts of the image, tilted to all sides; the first corner is the
// origin.
[[nodiscard]] std::vector<Pose<'C', 'O'>> tilted_boards(const Board& board, std::size_t count);

// Boards that both cameras see whole, with the sheet around them, from the centre into the corners of their
// images.
[[nodiscard]] std::vector<Pose<'C', 'O'>> boards_all_over(const StereoRig& rig, const Board& board,
                                                          std::size_t count, Bend bend = Bend::distortion);

[[nodiscard]] PairCorners projected(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO,
                                    Bend bend = Bend::distortion);

// Each pixel is the mean of 4 x 4 rays.
[[nodiscard]] Image drawn(const Lens& lens, int width, int height, const Board& board, const Quat& turn,
                          const Vec3& place, Bend bend = Bend::distortion);
struct DrawnPair {
  Image left, right;
};
[[nodiscard]] DrawnPair drawn(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO,
                              Bend bend = Bend::distortion);

}  // namespace enc::test
