#include "benchmarks/report/contradictions.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace enc::bench {
namespace {

constexpr double kHalfDigit = 0.5e-4;  // the tables are printed to four decimals

struct NormRow {
  const char* statistic;
  int speed;  // mm/s
  double x, y, z, norm;
};
// [VHMR Table 1], mm; RMSE and MAE of the tool tip's position.
constexpr std::array<NormRow, 6> kTable1{{{"RMSE", 0, 0.0802, 0.0669, 0.1197, 0.1588},
                                          {"MAE", 0, 0.0779, 0.0659, 0.1192, 0.1579},
                                          {"RMSE", 20, 0.2734, 0.2746, 0.2494, 0.4609},
                                          {"MAE", 20, 0.2542, 0.2503, 0.2296, 0.4242},
                                          {"RMSE", 40, 0.5117, 0.4891, 0.4151, 0.8206},
                                          {"MAE", 40, 0.4883, 0.4675, 0.3761, 0.7736}}};

// The last row says that it is the norm of the three above.
void norms(std::vector<Contradiction>& list) {
  for (const NormRow& row : kTable1) {
    const double norm = std::hypot(row.x, row.y, row.z);
    // How far the printed digits let either side be.
    const double room = kHalfDigit * ((row.x + row.y + row.z) / norm + 1.0);
    if (std::abs(row.norm - norm) <= room) continue;
    list.push_back(
        {fmt::format("table1.{}.norm.{}", row.statistic, row.speed),
         fmt::format("Table 1, {} at {} mm/s, last row", row.statistic, row.speed),
         fmt::format("{:.4f} mm as the norm of {:.4f}, {:.4f} and {:.4f} mm", row.norm, row.x, row.y, row.z),
         fmt::format("their norm is {:.4f} mm", norm)});
  }
}

struct ForceCell {
  char indentation;
  const char* way;
  double rmse, mae;
};
// [VHMR Table 2], N.
constexpr std::array<ForceCell, 6> kTable2{{{'A', "press", 0.1081, 0.0793},
                                            {'A', "release", 0.0666, 0.1610},
                                            {'B', "press", 0.0900, 0.0359},
                                            {'B', "release", 0.1370, 0.0056},
                                            {'C', "press", 0.0950, 0.0881},
                                            {'C', "release", 0.1619, 0.1134}}};

// |mean e| <= mean |e| <= rms. And with m the mean of |e| and r the rms: samples with |e| up to t make up at
// most t m of the mean square, so at least half of it comes from samples beyond t = r^2 / 2m, which are at
// most the share m / t = 2 (m / r)^2.
void force_errors(std::vector<Contradiction>& list) {
  for (const ForceCell& cell : kTable2) {
    Contradiction c{fmt::format("table2.{}.{}", cell.indentation, cell.way),
                    fmt::format("Table 2, indentation {}, {}", cell.indentation, cell.way),
                    fmt::format("MAE {:.4f} N, RMSE {:.4f} N", cell.mae, cell.rmse),
                    {}};
    const double share = 2.0 * std::pow(cell.mae / cell.rmse, 2);
    if (cell.mae - kHalfDigit > cell.rmse + kHalfDigit)
      c.found = fmt::format(
          "impossible: neither mean |error| nor |mean error| can exceed the RMSE, here it would be {:.2f} "
          "times as "
          "large",
          cell.mae / cell.rmse);
    else if (share < 0.01)
      c.found = fmt::format(
          "as mean |error|, at least half of the mean square would come from at most {:.2f} % of the "
          "samples, each "
          "off by more than {:.1f} N, where the paper's repeatability is 0.2 N: possible only as |mean "
          "error|",
          100.0 * share, cell.rmse * cell.rmse / (2.0 * cell.mae));
    if (!c.found.empty()) list.push_back(c);
  }
}

// [VHMR 4.4]: what the 15 answered to item 10, as the text has it.
void questionnaire(std::vector<Contradiction>& list) {
  struct Answers {
    int people, points;
  };
  constexpr std::array<Answers, 3> kText{{{11, 6}, {2, 5}, {2, 7}}};
  constexpr double kFigure = 5.9;  // [VHMR Fig 14], printed to one decimal
  double sum = 0.0;
  int people = 0;
  for (const Answers& a : kText) {
    sum += a.people * a.points;
    people += a.people;
  }
  if (std::abs(sum / people - kFigure) <= 0.05) return;
  list.push_back({"fig14.item10", "Fig 14 and its text, item 10 of the questionnaire",
                  fmt::format("mean {:.1f} in the figure; {} answers of {}, {} of {}, {} of {} in the text",
                              kFigure, kText[0].people, kText[0].points, kText[1].people, kText[1].points,
                              kText[2].people, kText[2].points),
                  fmt::format("these answers have the mean {:.1f}", sum / people)});
}

}  // namespace

std::vector<Contradiction> contradictions() {
  std::vector<Contradiction> list;
  norms(list);
  force_errors(list);
  questionnaire(list);
  return list;
}

}  // namespace enc::bench
