#include "tests/support/vision/chessboard.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/rotation.h"

namespace enc::test {
namespace {

constexpr int kBackground = 90;

// Applies the lens to a point of the plane z = 1.
Eigen::Vector2d bent(const Lens& lens, const Eigen::Vector2d& p, Bend bend) {
  if (bend == Bend::fisheye) return p.norm() > 0.0 ? std::atan(p.norm()) / p.norm() * p : p;
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  const double r2 = p.squaredNorm(), x = p.x(), y = p.y();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

Vec3 ray_of(const Lens& lens, double x, double y, Bend bend) {
  constexpr double kWidest = 1.5;  // rad
  const Eigen::Vector2d bent_ray((x - lens.centre_x) / lens.focal_x, (y - lens.centre_y) / lens.focal_y);
  if (bend == Bend::fisheye) {
    const double angle = bent_ray.norm();
    const Eigen::Vector2d at = angle > 0.0 ? std::tan(std::min(angle, kWidest)) / angle * bent_ray : bent_ray;
    return {at.x(), at.y(), 1.0};
  }
  Eigen::Vector2d straight = bent_ray;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d off = bent_ray - bent(lens, straight, bend);
    straight += off;
    if (off.squaredNorm() < 1e-16) break;
  }
  return {straight.x(), straight.y(), 1.0};
}

// A board has one square more than inner corners, and half a square of white around it.
int brightness(double column, double row, const Board& board) {
  const bool on_sheet = column > -1.5 && row > -1.5 && column < board.columns + 0.5 && row < board.rows + 0.5;
  if (!on_sheet) return kBackground;
  const bool on_board = column > -1.0 && row > -1.0 && column < board.columns && row < board.rows;
  const bool black = (static_cast<int>(std::floor(column)) + static_cast<int>(std::floor(row))) % 2 == 0;
  return on_board && black ? 25 : 225;
}

// True if both cameras see the whole sheet.
bool both_see(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO, Bend bend) {
  const Pose<'D', 'C'> X_DC = rig.X_CD.inverse();
  for (const double c : {-1.5, 0.5 * (board.columns - 1), board.columns + 0.5})
    for (const double r : {-1.5, 0.5 * (board.rows - 1), board.rows + 0.5}) {
      const Point<'C'> p = X_CO * Point<'O'>(c * board.square, r * board.square, 0.0);
      for (const auto& [lens, at] : {std::pair{rig.left, Vec3(p.e())}, {rig.right, Vec3((X_DC * p).e())}}) {
        if (at.z() <= 0.0) return false;
        const Eigen::Vector2d px = seen(lens, at, bend);
        if (px.x() < 1.0 || px.y() < 1.0 || px.x() > static_cast<double>(rig.width) - 2.0 ||
            px.y() > static_cast<double>(rig.height) - 2.0)
          return false;
      }
    }
  return true;
}

}  // namespace

StereoRig known_head(int width, int height) {
  StereoRig rig;
  const double w = width, h = height;
  rig.width = width;
  rig.height = height;
  rig.left = {0.84 * w, 0.843 * w, 0.51 * w, 0.49 * h, {-0.21, 0.06, 0.0011, -0.0007, 0.0}};
  rig.right = {0.85 * w, 0.852 * w, 0.485 * w, 0.508 * h, {-0.23, 0.08, -0.0009, 0.0005, 0.0}};
  rig.X_CD = Pose<'C', 'D'>(rotation_xyz(Vec3(0.011, -0.023, 0.006)), Vec3(0.0904, 0.0006, -0.0011));
  return rig;
}

Eigen::Vector2d seen(const Lens& lens, const Vec3& p, Bend bend) {
  const Eigen::Vector2d at = bent(lens, p.head<2>() / p.z(), bend);
  return {lens.focal_x * at.x() + lens.centre_x, lens.focal_y * at.y() + lens.centre_y};
}

std::vector<Pose<'C', 'O'>> tilted_boards(const Board& board, std::size_t count) {
  const Vec3 middle = 0.5 * board.square * Vec3(board.columns - 1, board.rows - 1, 0);
  std::vector<Pose<'C', 'O'>> boards;
  for (std::size_t i = 0; i < count; ++i) {
    const double k = static_cast<double>(i), turn = 2.4 * k;  // a sunflower pattern: no two are alike
    const Vec3 tilt(0.55 * std::cos(turn), 0.55 * std::sin(turn), 0.15 * std::sin(1.7 * k));
    const double z = 0.50 + 0.08 * std::cos(1.1 * k);
    const Vec3 place(0.035 + 0.05 * std::cos(1.9 * k), 0.04 * std::sin(1.3 * k), z);
    const Quat q = rotation_xyz(tilt);
    boards.emplace_back(q, Vec3(place - q * middle));
  }
  return boards;
}

std::vector<Pose<'C', 'O'>> boards_all_over(const StereoRig& rig, const Board& board, std::size_t count,
                                            Bend bend) {
  constexpr double kShare = 0.42;  // the sheet's share of the image's width
  constexpr std::array<std::array<int, 2>, 9> kTowards{
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, 0}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  const Vec3 middle = 0.5 * board.square * Vec3(board.columns - 1, board.rows - 1, 0);
  const double z =
      (board.columns + 2) * board.square * rig.left.focal_x / (kShare * static_cast<double>(rig.width));
  std::vector<Pose<'C', 'O'>> boards;
  for (std::size_t i = 0; i < count; ++i) {
    const double k = static_cast<double>(i), turn = 2.4 * k;
    const Quat q = rotation_xyz(Vec3(0.45 * std::cos(turn), 0.45 * std::sin(turn), 0.15 * std::sin(1.7 * k)));
    const auto& [right, down] = kTowards[i % kTowards.size()];
    for (double out = 2.5;; out -= 0.02) {  // as far out as the whole sheet is visible
      const Vec3 place(0.045 + 0.5 * out * z * right * static_cast<double>(rig.width) / rig.left.focal_x,
                       0.5 * out * z * down * static_cast<double>(rig.height) / rig.left.focal_x,
                       z * (1.0 + 0.15 * std::cos(1.1 * k)));
      const Pose<'C', 'O'> X_CO(q, Vec3(place - q * middle));
      if (out > 0.0 && !both_see(rig, board, X_CO, bend)) continue;
      boards.push_back(X_CO);
      break;
    }
  }
  return boards;
}

PairCorners projected(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO, Bend bend) {
  PairCorners pair;
  const Pose<'D', 'C'> X_DC = rig.X_CD.inverse();
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c) {
      const Point<'C'> p = X_CO * Point<'O'>(c * board.square, r * board.square, 0.0);
      pair.left.push_back(seen(rig.left, p.e(), bend));
      pair.right.push_back(seen(rig.right, (X_DC * p).e(), bend));
    }
  return pair;
}

Image drawn(const Lens& lens, int width, int height, const Board& board, const Quat& turn, const Vec3& place,
            Bend bend) {
  constexpr int kRays = 4;
  Image image(width, height);
  const Mat3 back = turn.toRotationMatrix().transpose();
  const Vec3 origin = back * place;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int sum = 0;
      for (int k = 0; k < kRays * kRays; ++k) {
        const Vec3 ray = back * ray_of(lens, x - 0.5 + (k % kRays + 0.5) / kRays,
                                       y - 0.5 + (static_cast<double>(k / kRays) + 0.5) / kRays, bend);
        const double far = origin.z() / ray.z();
        if (far <= 0.0) {  // the board's plane is behind the camera there
          sum += kBackground;
          continue;
        }
        const Vec3 hit = far * ray - origin;
        sum += brightness(hit.x() / board.square, hit.y() / board.square, board);
      }
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(sum / (kRays * kRays));
    }
  return image;
}

DrawnPair drawn(const StereoRig& rig, const Board& board, const Pose<'C', 'O'>& X_CO, Bend bend) {
  const Pose<'D', 'O'> X_DO = rig.X_CD.inverse() * X_CO;
  const int width = static_cast<int>(rig.width), height = static_cast<int>(rig.height);
  return {drawn(rig.left, width, height, board, X_CO.q(), X_CO.p(), bend),
          drawn(rig.right, width, height, board, X_DO.q(), X_DO.p(), bend)};
}

}  // namespace enc::test
