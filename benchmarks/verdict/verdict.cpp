#include "benchmarks/verdict/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"
#include "core/base/error.h"

namespace enc::bench {
namespace {

constexpr double kHalfDigit = 0.5e-4;  // the tables have four decimals
constexpr double kHalfTenth = 0.5e-1;  // the figure's means have one decimal

// [VHMR Table 1], mm: the last row of each column is labelled as the norm of the three above.
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
      // Largest deviation that the printed digits allow.
      const double room = kHalfDigit * ((x + y + z) / norm + 1.0);
      if (std::abs(printed - norm) <= room) continue;
      list.push_back({fmt::format("table1.{}.norm.{}", statistic, speed),
                      fmt::format("Table 1, {} at {} mm/s, last row", statistic, speed),
                      fmt::format("{:.4f} mm as the norm of {:.4f}, {:.4f} and {:.4f} mm", printed, x, y, z),
                      fmt::format("their norm is {:.4f} mm", norm)});
    }
  }
}

// [VHMR Table 2], N. |mean e| <= mean |e| <= rms. Let m be the mean of |e| and r the rms. Samples with |e| up
// to t make up at most t m of the mean square. So at least half of it comes from samples beyond t = r^2 / 2m,
// and their share is at most m / t = 2 (m / r)^2.
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

// [VHMR 4.4]: the text lists the answers to item 10, [VHMR Fig 14] has the mean.
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

// [VisHap 2.1.2]: limits of steps 5 and 7 of the fingertip's pseudo-code.
void fingertip_steps(const Reference& steps, std::vector<Contradiction>& list) {
  const auto row = [&](const char* step, const char* limit) {
    return steps.row({{"step", step}, {"limit", limit}});
  };
  const std::size_t circle = row("5", "least"), least = row("7", "least"), most = row("7", "most");
  if (steps.number(circle, "factor") >= 1.0)
    list.push_back(
        {"vishap.step5", "VisHap 2.1.2, steps 5 and 10", steps.text(circle, "words"),
         "each candidate then has the score S_filled / area = 1, and the highest score, by which the "
         "paper chooses, chooses nothing"});
  constexpr double kSides = 4.0;      // length of S, in its side
  constexpr double kCrossings = 2.0;  // width of the finger, in r, which is less than r2
  if (steps.number(most, "factor") >= kSides || steps.number(least, "factor") >= kCrossings)
    list.push_back(
        {"vishap.step7", "VisHap 2.1.2, steps 6 and 7", steps.text(least, "words"),
         fmt::format(
             "with r2 the side, S has {:g} r2 pixels, and never more are skin; with r2 half a side, an "
             "upright finger crosses S along {:g} r, always less than {:g} r2",
             kSides, kCrossings, steps.number(least, "factor"))});
}

constexpr double kLeastDrawn = 0.01;  // error over threshold: smaller values are drawn at the edge

[[noreturn]] void refuse(const std::string& name, std::size_t row, const std::string& what) {
  throw Error(fmt::format("{}: row {}: {}", name, row + 1, what));
}

// A share of the size at which the error occurs [Weber], with a floor below which the share does not hold.
void fill_share(const Reference& table, std::size_t row, Threshold& t) {
  const auto number = [&](const char* column) { return table.number(row, column); };
  const double floor = number("floor");
  const auto of = [&](const char* share, const char* at) {
    return std::max(floor, 0.01 * number(share) * number(at));
  };
  t.value = of("threshold", "at");
  t.least = of("least", "at_least");
  t.most = of("most", "at_most");
  t.rule = fmt::format("{:g} % ({:g} .. {:g}) of {:g} {} ({:g} .. {:g}), at least {:g}", number("threshold"),
                       number("least"), number("most"), number("at"), t.unit, number("at_least"),
                       number("at_most"), floor);
}

Threshold threshold_of(const Reference& table, std::size_t row, const std::string& name) {
  Threshold t;
  t.figure = table.text(row, "figure");
  t.compares = table.text(row, "compares");
  t.unit = table.text(row, "unit");
  t.source = table.text(row, "source");
  t.confidence = table.text(row, "confidence");
  const std::string& sign = table.text(row, "sign");
  if (sign != "any" && sign != "+" && sign != "-")
    refuse(name, row, "sign '" + sign + "'; expected any, + or -");
  t.sign = sign == "any" ? 0 : sign == "+" ? 1 : -1;
  const std::string& kind = table.text(row, "kind");
  if (kind == "none") return t;
  if (kind != "absolute" && kind != "strictest" && kind != "share")
    refuse(name, row, "kind '" + kind + "'; expected absolute, strictest, share or none");
  t.strictest = kind == "strictest";
  if (kind == "share") {
    fill_share(table, row, t);
  } else {
    t.value = table.number(row, "threshold");
    t.least = table.number(row, "least");
    t.most = table.number(row, "most");
  }
  if (!(t.least > 0.0) || t.value < t.least || t.most < t.value)
    refuse(name, row, "expected 0 < least <= threshold <= most");
  return t;
}

std::vector<Threshold> thresholds_of(const Reference& table, const std::string& name) {
  std::vector<Threshold> all;
  all.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) all.push_back(threshold_of(table, row, name));
  return all;
}

bool right_sign(double error, const Threshold& t) { return t.sign == 0 || t.sign * error >= 0.0; }

std::string range_of(const Threshold& t) {
  if (!std::isfinite(t.value)) return "";
  const std::string value = fmt::format("{:.3g}", t.value);
  return t.least == t.most ? value : fmt::format("{} ({:.3g} .. {:.3g})", value, t.least, t.most);
}
std::string short_word(double x) { return std::isfinite(x) ? fmt::format("{:.3g}", x) : ""; }

bool same(const Threshold& a, const Threshold& b) { return a.figure == b.figure && a.sign == b.sign; }

// The worst judged figure of each threshold, in the order of the first of each.
std::vector<const FigureVerdict*> worst_of_each(const std::vector<FigureVerdict>& all) {
  std::vector<const FigureVerdict*> worst;
  for (const FigureVerdict& j : all) {
    if (!std::isfinite(j.over)) continue;
    const auto found = std::find_if(worst.begin(), worst.end(),
                                    [&](const FigureVerdict* w) { return same(w->threshold, j.threshold); });
    if (found == worst.end())
      worst.push_back(&j);
    else if (j.over > (*found)->over)
      *found = &j;
  }
  return worst;
}

}  // namespace

std::vector<Contradiction> contradictions(const std::string& models) {
  std::vector<Contradiction> list;
  norms(Reference::load(models, "table1.csv"), list);
  force_errors(Reference::load(models, "table2.csv"), list);
  questionnaire(Reference::load(models, "fig14.csv"), Reference::load(models, "fig14_item10.csv"), list);
  fingertip_steps(Reference::load(models, "fingertip_steps.csv"), list);
  return list;
}

const char* felt_name(Perception felt) {
  constexpr std::array kNames{"not felt", "in between", "felt", "not comparable"};
  return kNames[static_cast<std::size_t>(felt)];
}

std::vector<Threshold> parse_thresholds(const std::string& text, const std::string& name) {
  return thresholds_of(Reference::parse(text, name), name);
}
std::vector<Threshold> load_thresholds(const std::string& models) {
  const std::string name = "thresholds.csv";
  return thresholds_of(Reference::load(models, name), name);
}

// Each '*' matches as little as possible; if the rest then does not fit, the last one takes one more
// character.
bool matches(const std::string& pattern, const std::string& id) {
  std::size_t p = 0;
  std::size_t star = std::string::npos;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < id.size();) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = i;
    } else if (p < pattern.size() && pattern[p] == id[i]) {
      ++p;
      ++i;
    } else if (star != std::string::npos) {
      p = star + 1;
      i = ++taken;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

Perception felt(double error, const Threshold& t) {
  if (!std::isfinite(error) || !std::isfinite(t.value) || !right_sign(error, t))
    return Perception::not_comparable;
  const double size = std::abs(error);
  if (size <= t.least) return Perception::no;
  if (t.strictest) return Perception::not_comparable;
  return size > t.most ? Perception::yes : Perception::between;
}

std::vector<FigureVerdict> judged(const std::vector<BenchResult>& results,
                                  const std::vector<Threshold>& thresholds) {
  std::vector<FigureVerdict> all;
  for (const BenchResult& result : results)
    for (const Figure& f : result.figures) {
      if (!std::isfinite(f.twin)) continue;
      const auto t = std::find_if(thresholds.begin(), thresholds.end(), [&](const Threshold& one) {
        return matches(one.figure, f.id) && one.unit == f.unit && right_sign(f.twin, one);
      });
      if (t == thresholds.end()) continue;
      FigureVerdict j{f, *t, felt(f.twin, *t), felt(f.paper, *t), std::abs(f.twin) / t->value, kUnset};
      if (j.paper != Perception::not_comparable) j.paper_over = std::abs(f.paper) / t->value;
      all.push_back(std::move(j));
    }
  return all;
}

Table verdict_table(const std::vector<FigureVerdict>& all) {
  Table table{"verdict",
              "Felt or not",
              {"figure", "error", "unit", "threshold", "error over threshold", "verdict", "paper's error",
               "paper's verdict"},
              {},
              "Threshold: its typical value, and the range over studies, people and places. Not felt: below "
              "the range. Felt: above it. In between: some people, or in some places. Not comparable: nobody "
              "has measured what a person can tell there."};
  for (const FigureVerdict& j : all)
    table.rows.push_back({j.figure.id, short_word(j.figure.twin), j.figure.unit, range_of(j.threshold),
                          short_word(j.over), felt_name(j.felt), short_word(j.figure.paper),
                          std::isfinite(j.paper_over) ? felt_name(j.paper) : ""});
  return table;
}

Table threshold_table(const std::vector<FigureVerdict>& all) {
  Table table{"verdict_thresholds",
              "What a person can tell",
              {"figures", "threshold", "unit", "what a person compares", "rule", "source", "how sure"},
              {},
              "Those of benchmarks/reference/thresholds.csv that were used above."};
  std::vector<const Threshold*> seen;
  for (const FigureVerdict& j : all) {
    const Threshold& t = j.threshold;
    const bool there = std::any_of(seen.begin(), seen.end(), [&](const Threshold* s) { return same(*s, t); });
    if (there) continue;
    seen.push_back(&t);
    table.rows.push_back({t.figure, range_of(t), t.unit, t.compares, t.rule, t.source, t.confidence});
  }
  return table;
}

Plot verdict_plot(const std::vector<FigureVerdict>& all) {
  Plot plot{"verdict",
            "Errors beside what a person can tell",
            "error over threshold",
            "",
            true,
            false,
            {},
            "The worst error of each kind. Left of the bar: not felt. Right of it: felt. The bar is how far "
            "studies, people and places differ; 1 is the typical threshold. Less than 0.01 stands at 0.01."};
  Series range{"range of the threshold"};
  Series twin{.name = "twin", .mark = Mark::points};
  Series paper{.name = "paper", .mark = Mark::points, .paper = true};
  const std::vector<const FigureVerdict*> worst = worst_of_each(all);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const FigureVerdict& j = *worst[i];
    const auto y = static_cast<double>(i);
    plot.y_names.push_back(j.figure.id);
    for (const double x :
         {j.threshold.least / j.threshold.value, j.threshold.most / j.threshold.value, kUnset}) {
      range.add(x, y);
    }
    twin.add(std::max(j.over, kLeastDrawn), y);
    paper.add(j.paper_over, y);
  }
  const double below = static_cast<double>(worst.size()) - 0.4;
  plot.series = {std::move(range), std::move(twin), {"threshold", {1, 1}, {-0.6, below}}, std::move(paper)};
  return plot;
}

std::string verdict_line(const std::vector<FigureVerdict>& all) {
  std::string line;
  for (const Perception felt :
       {Perception::no, Perception::between, Perception::yes, Perception::not_comparable}) {
    std::size_t count = 0;
    std::string which;
    for (const FigureVerdict& j : all) {
      if (j.felt != felt) continue;
      ++count;
      which += (which.empty() ? "" : ", ") + j.figure.id;
    }
    if (count == 0) continue;
    line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count, felt_name(felt));
    if (felt == Perception::yes) line += " (" + which + ")";
  }
  return line;
}

}  // namespace enc::bench
