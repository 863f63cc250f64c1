#include "sim/window/overlay.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "sim/picture/picture.h"

namespace enc::sim {
namespace {

constexpr float kLineColours[][3] = {
    {0.85F, 0.10F, 0.15F}, {0.16F, 0.42F, 0.72F}, {0.10F, 0.55F, 0.35F}, {0.90F, 0.55F, 0.20F}};

}  // namespace

void draw_chart(const ViewChart& chart, const mjrRect& where, mjvFigure& figure, const mjrContext& context) {
  mjv_defaultFigure(&figure);
  std::strncpy(figure.title, chart.title.c_str(), sizeof(figure.title) - 1);
  figure.flg_legend = 1;
  figure.flg_extend = 1;
  figure.flg_ticklabel[0] = figure.flg_ticklabel[1] = 1;
  figure.linewidth = 1.0F;
  figure.gridsize[0] = 6;
  figure.gridsize[1] = 5;
  std::strncpy(figure.xformat, "%.0f", sizeof(figure.xformat) - 1);
  std::strncpy(figure.yformat, "%.1f", sizeof(figure.yformat) - 1);
  for (int i = 0; i < 2; ++i) {
    const auto at = static_cast<std::size_t>(i);
    figure.range[0][i] = chart.across[at];
    figure.range[1][i] = chart.up[at];
  }
  figure.figurergba[0] = figure.figurergba[1] = figure.figurergba[2] = 0.12F;
  figure.figurergba[3] = 0.75F;
  if (chart.cursor) {
    figure.flg_selection = 1;
    figure.selection = *chart.cursor;
  }
  for (std::size_t l = 0; l < std::min(chart.lines.size(), std::size(kLineColours)); ++l) {
    const ViewLine& line = chart.lines[l];
    std::strncpy(figure.linename[l], line.name.c_str(), sizeof(figure.linename[l]) - 1);
    std::copy_n(kLineColours[l], 3, figure.linergb[l]);
    const std::size_t count = std::min<std::size_t>(line.xy.size() / 2, mjMAXLINEPNT - 1);
    figure.linepnt[l] = static_cast<int>(count);
    std::copy_n(line.xy.begin(), 2 * count, figure.linedata[l]);
  }
  mjr_figure(where, &figure, &context);
}

void draw_bar(const ViewBar& bar, const mjrRect& all) {
  const int side = static_cast<int>(kBarSide), height = static_cast<int>(kBarHeight);
  const mjrRect where{side, side, std::max(1, all.width - 2 * side), height};
  mjr_rectangle(where, 0.12F, 0.12F, 0.12F, 0.55F);
  const auto along = [&](float share) { return static_cast<int>(share * static_cast<float>(where.width)); };
  for (const ViewBar::Mark& mark : bar.marks) {
    const int from = along(mark.from), to = std::max(from + 2, along(mark.to));
    mjr_rectangle({where.left + from, where.bottom, to - from, height}, mark.colour[0], mark.colour[1],
                  mark.colour[2], 0.9F);
  }
  mjr_rectangle({where.left + along(bar.at) - 2, where.bottom - 3, 5, height + 6}, 0.16F, 0.42F, 0.72F, 1.0F);
}

void draw_image(const Image& picture, int left, int bottom, const mjrContext& context) {
  Image turned = picture;  // OpenGL's first row is the lowest
  flip(turned);
  const mjrRect where{left, bottom, turned.width, turned.height};
  mjr_drawPixels(turned.rgb.data(), nullptr, where, &context);
}

Image resized(const Image& from, int width, int height) {
  Image to(std::max(1, width), std::max(1, height));
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      std::copy_n(from.view().at(x * from.width / to.width, y * from.height / to.height), 3, to.at(x, y));
  return to;
}

std::pair<std::string, std::string> halves(const std::string& text) {
  const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
  std::size_t at = 0;
  for (std::ptrdiff_t i = 0; i < (lines + 1) / 2; ++i) {
    at = text.find('\n', at);
    if (at == std::string::npos) return {text, ""};
    ++at;
  }
  return {text.substr(0, at - 1), text.substr(at)};
}

void draw_tiles(const ViewPage& page, const mjrRect& all, const mjrContext& context) {
  const TileGrid grid(page.tiles.size(), all.width, all.height);
  mjr_rectangle(all, 0.96F, 0.965F, 0.97F, 1.0F);
  const int gap = static_cast<int>(TileGrid::kGap), name = static_cast<int>(TileGrid::kName);
  for (std::size_t i = 0; i < page.tiles.size(); ++i) {
    const ViewTile& tile = page.tiles[i];
    const mjrRect where{static_cast<int>(grid.left(i)),
                        all.height - static_cast<int>(grid.top(i) + grid.height),
                        static_cast<int>(grid.width), static_cast<int>(grid.height)};
    if (i == page.chosen) mjr_rectangle(where, 0.16F, 0.42F, 0.72F, 1.0F);
    const int x = where.left + gap / 2, y = where.bottom + gap / 2;
    if (tile.picture.width > 0)
      draw_image(resized(tile.picture, grid.picture_width(), grid.picture_height()), x, y + name, context);
    else
      mjr_rectangle({x, y + name, grid.picture_width(), grid.picture_height()}, 1, 1, 1, 1);
    mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, {x, y, where.width - gap, name}, tile.name.c_str(), nullptr,
                &context);
  }
  mjr_overlay(mjFONT_NORMAL, mjGRID_TOPLEFT, all, page.title.c_str(), nullptr, &context);
  mjr_overlay(mjFONT_NORMAL, mjGRID_BOTTOMLEFT, all, page.line.c_str(), nullptr, &context);
}

}  // namespace enc::sim
