#include "benchmarks/verdict/contradictions.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"

namespace enc::bench {
namespace {

constexpr double kHalfDigit = 0.5e-4;  // the tables are printed to four decimals
constexpr double kHalfTenth = 0.5e-1;  // the figure's means to one

// [VHMR Table 1], mm: the last row of each column says that it is the norm of the three above.
void norms(const Reference& table, std::vector<Contradiction>& list) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (table.text(i, "axis") != "norm") continue;
    const std::string& speed = table.text(i, "speed_mm_s");
    for (const auto& [statistic, column] : {std::pair{"RMSE", "rmse_mm"}, std::pair{"MAE", "mae_mm"}}) {
      const auto of = [&, column = column](const char* axis) {
        return table.number(table.row({{"speed_mm_s", speed}, {"axis", axis}}), column);
      };
      const double x = of("x");
      const double y = of("y");
      const double z = of("z");
      const double printed = table.number(i, column);
      const double norm = std::hypot(x, y, z);
      // How far the printed digits let either side be.
      const double room = kHalfDigit * ((x + y + z) / norm + 1.0);
      if (std::abs(printed - norm) <= room) continue;
      list.push_back({fmt::format("table1.{}.norm.{}", statistic, speed),
                      fmt::format("Table 1, {} at {} mm/s, last row", statistic, speed),
                      fmt::format("{:.4f} mm as the norm of {:.4f}, {:.4f} and {:.4f} mm", printed, x, y, z),
                      fmt::format("their norm is {:.4f} mm", norm)});
    }
  }
}

// [VHMR Table 2], N. |mean e| <= mean |e| <= rms. And with m the mean of |e| and r the rms: samples with |e|
// up to t make up at most t m of the mean square, so at least half of it comes from samples beyond
// t = r^2 / 2m, which are at most the share m / t = 2 (m / r)^2.
void force_errors(const Reference& table, std::vector<Contradiction>& list) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const std::string& indentation = table.text(i, "indentation");
    const std::string& way = table.text(i, "way");
    const double rmse = table.number(i, "rmse_N");
    const double mae = table.number(i, "mae_N");
    Contradiction c{fmt::format("table2.{}.{}", indentation, way),
                    fmt::format("Table 2, indentation {}, {}", indentation, way),
                    fmt::format("MAE {:.4f} N, RMSE {:.4f} N", mae, rmse),
                    {}};
    const double share = 2.0 * std::pow(mae / rmse, 2);
    if (mae - kHalfDigit > rmse + kHalfDigit)
      c.found = fmt::format(
          "impossible: neither mean |error| nor |mean error| can exceed the RMSE, here it would be {:.2f} "
          "times as large",
          mae / rmse);
    else if (share < 0.01)
      c.found = fmt::format(
          "as mean |error|, at least half of the mean square would come from at most {:.2f} % of the "
          "samples, each off by more than {:.1f} N, where the paper's repeatability is 0.2 N: possible only "
          "as |mean error|",
          100.0 * share, rmse * rmse / (2.0 * mae));
    if (!c.found.empty()) list.push_back(c);
  }
}

// [VHMR 4.4]: the text tells what everybody answered to item 10, [VHMR Fig 14] has the mean.
void questionnaire(const Reference& figure, const Reference& text, std::vector<Contradiction>& list) {
  const double printed = figure.number(figure.row({{"item", "10"}}), "mean");
  double sum = 0.0;
  double people = 0.0;
  std::string answers;
  for (std::size_t i = 0; i < text.rows(); ++i) {
    const double n = text.number(i, "people");
    const double points = text.number(i, "points");
    sum += n * points;
    people += n;
    answers +=
        i == 0 ? fmt::format("{:g} answers of {:g}", n, points) : fmt::format(", {:g} of {:g}", n, points);
  }
  if (std::abs(sum / people - printed) <= kHalfTenth) return;
  list.push_back({"fig14.item10", "Fig 14 and its text, item 10 of the questionnaire",
                  fmt::format("mean {:.1f} in the figure; {} in the text", printed, answers),
                  fmt::format("these answers have the mean {:.1f}", sum / people)});
}

}  // namespace

std::vector<Contradiction> contradictions(const std::string& models) {
  std::vector<Contradiction> list;
  norms(Reference::load(models, "table1.csv"), list);
  force_errors(Reference::load(models, "table2.csv"), list);
  questionnaire(Reference::load(models, "fig14.csv"), Reference::load(models, "fig14_item10.csv"), list);
  return list;
}

}  // namespace enc::bench
