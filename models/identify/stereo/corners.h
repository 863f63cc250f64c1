// A chessboard for calibration: its inner corners, located to a fraction of a pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"

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

// Quick: a tenth of a second for an image without the board. Thorough: up to two seconds, also for small and
// blurred boards.
enum class Search : std::uint8_t { quick, thorough };

// Empty if the whole board is not visible, or if it has more corners, because the found ones could then be
// any part.
[[nodiscard]] std::optional<Corners> find_corners(const ImageView& image, const Board& board,
                                                  Search search = Search::thorough);

// The board in an image: up to two columns and rows more or fewer than `near`, or clearly visible. Empty if
// no whole board is found.
[[nodiscard]] std::optional<Board> board_in(const ImageView& image, const Board& near);

// One board in both images, in one order.
struct PairCorners {
  Corners left, right;
};

// A finder may begin at either end of a board, and at any corner of a square one. This function rotates the
// right corners until their order is that of the left ones. Two cameras of a head are never rolled by more
// than 90 deg against each other (45 deg for a square board).
[[nodiscard]] PairCorners in_one_order(Corners left, Corners right, const Board& board);

}  // namespace enc
