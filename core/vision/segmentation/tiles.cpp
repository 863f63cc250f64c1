#include "core/vision/segmentation/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace enc::segmentation {

Background::Background(const Grid& grid)
    : grid_(grid),
      sum_(3 * static_cast<std::size_t>(grid.whole().pixels())),
      squares_(3 * static_cast<std::size_t>(grid.whole().pixels())) {}

void Background::add(const ImageView& frame) {
  ++frames_;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const std::uint32_t value = frame.rgb[i];
    sum_[i] = static_cast<std::uint16_t>(sum_[i] + value);
    squares_[i] += value * value;
  }
}

Image Background::mean() const {
  Image image(grid_.width, grid_.height);
  for (std::size_t i = 0; i < sum_.size(); ++i)
    image.rgb[i] = static_cast<std::uint8_t>((sum_[i] + frames_ / 2) / frames_);
  return image;
}

std::vector<double> Background::noise() const {
  std::vector<double> noise;
  const auto n = static_cast<std::int64_t>(frames_);
  for (int row = 0; row < grid_.rows(); ++row)
    for (int column = 0; column < grid_.columns(); ++column) {
      const Region tile = grid_.tile_at(column, row);
      std::int64_t varied = 0;  // n times the sum of squares about the means
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = 3 * tile.x0; x < 3 * tile.x1; ++x) {
          const auto i = 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) +
                         static_cast<std::size_t>(x);
          varied += n * squares_[i] - std::int64_t{sum_[i]} * sum_[i];
        }
      const double free = 3.0 * static_cast<double>(tile.pixels() * n * std::max<std::int64_t>(1, n - 1));
      noise.push_back(std::max(kLeastNoise, std::sqrt(static_cast<double>(varied) / free)));
    }
  return noise;
}

double unrest(std::vector<double> noise) {
  if (noise.empty()) return 0.0;
  const auto middle = noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 2);
  std::nth_element(noise.begin(), middle, noise.end());
  const double usual = *middle;
  const auto moved = std::count_if(noise.begin(), noise.end(), [&](double s) { return s > 4.0 * usual; });
  return static_cast<double>(moved) / static_cast<double>(noise.size());
}

namespace {

// Bins 0, 2, 4, 6, then 1, 3, 5, 7; their order is irrelevant.
std::uint64_t spread(std::uint32_t fours) {
  constexpr std::uint32_t kEven = 0x0f0f0f0fU;
  return (std::uint64_t{fours >> 4 & kEven} << 32) | (fours & kEven);
}

}  // namespace

int needed(double match, int pixels) {
  return std::clamp(static_cast<int>(std::ceil(match * pixels - 1e-9)), 0, pixels + 1);
}

Tiles::Tiles(const Kernels& kernels, const Grid& grid, int bins)
    : kernels_(kernels),
      grid_(grid),
      bins_(bins),
      model_(static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows())),
      seen_(static_cast<std::size_t>(grid.columns())),
      columns_(static_cast<std::size_t>(grid.width)),
      found_(static_cast<std::size_t>(grid.columns())),
      wide_(static_cast<std::size_t>(grid.width) + 16) {}

void Tiles::histograms(const Region& tiles) {
  const int together = kMostTile / tiles.height();  // columns whose summed counts fit four bits
  std::size_t tile = 0;
  for (int x = 0; x < tiles.width(); x += grid_.tile) {
    const int end = std::min(x + grid_.tile, tiles.width());
    std::uint64_t sum = 0;
    for (int from = x; from < end; from += together) {
      std::uint32_t fours = 0;
      for (int k = from; k < std::min(from + together, end); ++k)
        fours += columns_[static_cast<std::size_t>(k)];
      sum += spread(fours);
    }
    seen_[tile++] = sum;
  }
}

void Tiles::match_tiles(const Region& tiles, double match) {
  const int first = tiles.x0 / grid_.tile;
  const int full = tiles.width() / grid_.tile, rest = tiles.width() % grid_.tile;
  const std::uint64_t* const model =
      model_.data() +
      static_cast<std::size_t>(tiles.y0 / grid_.tile) * static_cast<std::size_t>(grid_.columns()) + first;
  const int pixels = grid_.tile * tiles.height();
  kernels_.match_row(seen_.data(), model, full, pixels, needed(match, pixels), found_.data());
  if (rest == 0) return;
  const int fewer = rest * tiles.height();
  kernels_.match_row(seen_.data() + full, model + full, 1, fewer, needed(match, fewer), found_.data() + full);
}

// Writes a tile's byte for each of its pixels: two words of eight; the next tile overwrites the excess.
void Tiles::widen(int width) {
  std::uint8_t* to = wide_.data();
  for (const std::uint8_t* tile = found_.data(); to < wide_.data() + width; to += grid_.tile, ++tile) {
    const std::uint64_t eight = *tile != 0 ? ~std::uint64_t{0} : 0;
    std::memcpy(to, &eight, sizeof eight);
    std::memcpy(to + sizeof eight, &eight, sizeof eight);
  }
}

void Tiles::learn(const Image& mean, const Cut& cut) {
  const ImageView view = mean.view();
  Mask unused(grid_.width, grid_.tile);
  for (int y = 0; y < grid_.height; y += grid_.tile) {
    const Region row{0, y, grid_.width, std::min(y + grid_.tile, grid_.height)};
    kernels_.read_rows({view.at(0, y), grid_.width, row.height()}, grid_.width, bins_, cut, columns_.data(),
                       unused.row(0));
    histograms(row);
    std::copy(seen_.begin(), seen_.end(),
              model_.begin() + static_cast<std::ptrdiff_t>(y / grid_.tile) * grid_.columns());
  }
}

void Tiles::candidates(const ImageView& frame, const Region& region, double match, const Cut& cut,
                       Mask& out) {
  for (int y = region.y0; y < region.y1; y += grid_.tile) {
    const Region row{region.x0, y, region.x1, std::min(y + grid_.tile, region.y1)};
    kernels_.read_rows({frame.at(row.x0, y), grid_.width, row.height()}, row.width(), bins_, cut,
                       columns_.data(), out.row(y) + row.x0);
    histograms(row);
    match_tiles(row, match);
    widen(row.width());
    for (int line = row.y0; line < row.y1; ++line)
      kernels_.and_row(wide_.data(), row.width(), out.row(line) + row.x0);
  }
}

}  // namespace enc::segmentation
