#include "benchmarks/segmentation/thresholds.h"

#include <algorithm>

#include <fmt/format.h>

namespace enc::bench::segmentation {
namespace {

constexpr std::array<double, 8> kMatch{0.1, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.96};
constexpr std::array<double, 8> kChange{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0};
constexpr std::array<double, 6> kSkin{1.5, 2.0, 2.5, 3.0, 3.5, 4.0};
const std::array<sim::Light, 4> kLights{{{}, {.gain = 0.8}, {.side = 0.3}, {.colour = {1.2F, 1.0F, 0.8F}}}};
constexpr double kLeastRate = 1e-6;  // for a logarithmic axis

std::vector<RocPoint> points_of(const Place& like, SegmentationMethod method,
                                std::span<const SegmentationPair> pairs) {
  return method == SegmentationMethod::ours ? roc(spec_of(like.skin, method), pairs, kChange, kSkin)
                                            : roc(spec_of(like.skin, method), pairs, kMatch, kSkin);
}

double wrong(const RocPoint& point) { return 1.0 - point.found.correct(); }

void plot(Bench& bench, const char* name, SegmentationMethod method, const std::vector<RocPoint>& points,
          const RocPoint& shipped) {
  std::vector<Series> lines;
  for (const double skin : kSkin) {
    Series line{.name = fmt::format("skin {:g}", skin), .mark = Mark::both};
    for (const RocPoint& point : points)
      if (point.skin == skin)
        line.add(std::max(kLeastRate, point.found.false_positive_rate()), point.found.true_positive_rate());
    lines.push_back(std::move(line));
  }
  Series mark{.name = fmt::format("shipped: {:g}, {:g}", shipped.foreground, shipped.skin),
              .mark = Mark::points};
  mark.add(std::max(kLeastRate, shipped.found.false_positive_rate()), shipped.found.true_positive_rate());
  lines.push_back(std::move(mark));
  bench.plot(
      {.id = fmt::format("roc_{}", name),
       .title = fmt::format("Thresholds of {}, training seeds",
                            method == SegmentationMethod::ours ? kMethods[ours] : kMethods[published]),
       .x_label = "false positives, share of what is no skin",
       .y_label = "true positives, share of skin",
       .log_x = true,
       .series = std::move(lines),
       .caption = "Three sceneries in four lights. Along a line the threshold of the foreground changes."});
}

}  // namespace

void judge_thresholds(Bench& bench, const Place& like) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < 12; ++i) {
    places.push_back(like);
    places.back().scenery = static_cast<sim::Scenery>(i % 3);
    places.back().seed = staged::kTraining + 300 + i;
    places.back().takes = {{.row = "", .tone = static_cast<sim::Tone>(i % 4), .light = kLights[i / 3]}};
  }
  const auto materials =
      bench.each(places, [](const Place& place) { return material(place, place.takes.front()); });
  std::vector<SegmentationPair> pairs;
  pairs.reserve(materials.size());
  for (const Material& each : materials) pairs.push_back(each.pair());
  Table table{"thresholds", "Wrong pixels over the thresholds, training seeds (%)", {"method", "foreground"}};
  for (const double skin : kSkin) table.columns.push_back(fmt::format("skin {:g}", skin));
  const SegmentationSpec spec;
  for (const auto& [method, name, foreground] :
       {std::tuple{SegmentationMethod::published, "published", spec.match},
        std::tuple{SegmentationMethod::ours, "ours", spec.change}}) {
    const auto points = points_of(like, method, pairs);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i % kSkin.size() == 0) table.rows.push_back({name, fmt::format("{:g}", points[i].foreground)});
      table.rows.back().push_back(fmt::format("{:.3f}", 1e2 * wrong(points[i])));
    }
    const RocPoint shipped =
        roc(spec_of(like.skin, method), pairs, std::array{foreground}, std::array{spec.skin})[0];
    const RocPoint best = *std::min_element(points.begin(), points.end(),
                                            [](const auto& a, const auto& b) { return wrong(a) < wrong(b); });
    bench.figure(
        fmt::format("thresholds.{}.wrong.mean", name), 1e2 * wrong(shipped), "%",
        fmt::format("of all pixels with the shipped thresholds, training seeds; the least of the ROC is "
                    "{:.3f} % at {:g}, {:g}",
                    1e2 * wrong(best), best.foreground, best.skin));
    plot(bench, name, method, points, shipped);
  }
  bench.table(std::move(table));
}

}  // namespace enc::bench::segmentation
