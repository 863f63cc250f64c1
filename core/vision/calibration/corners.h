// A chessboard as calibration sees it: its inner corners, found to a fraction of a pixel.
#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/vision/image.h"

namespace enc {

struct Board {
  int columns = 9, rows = 6;  // inner corners: where two black squares touch
  double square = kUnset;     // m, side

  [[nodiscard]] std::size_t corners() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

// px, row by row of the board; the centre of the first pixel is (0, 0).
using Corners = std::vector<Eigen::Vector2d>;

// Nothing where the whole board is not seen.
[[nodiscard]] std::optional<Corners> find_corners(const ImageView& image, const Board& board);

// One board in both images, in the same order.
struct PairCorners {
  Corners left, right;
};

// A finder may begin at either end of a board: turns the right corners round where they run against the left.
// Two cameras of a head are never rolled by more than 90 deg against each other.
[[nodiscard]] PairCorners in_one_order(Corners left, Corners right);

}  // namespace enc
