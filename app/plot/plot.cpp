// Draws a record: force, deflection and gap over time with the modes behind, and force over deflection.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/common/options.h"
#include "app/common/words.h"
#include "app/plot/chart.h"
#include "app/process.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "trial/assemble/assemble.h"
#include "trial/measure/record_table.h"

namespace enc::app {
namespace {

// One light colour for each mode, in the order of the enum.
constexpr std::array<const char*, kModes> kBands{"#ffffff", "#dcebf5", "#f9dcc4", "#d9efe2",
                                                 "#e6c6d6", "#f9dcc4", "#efe6c0"};
constexpr double kWidth = 960.0, kHeight = 590.0, kTop = 46.0, kStrip = 138.0, kGapBetween = 16.0;  // px

struct Sample {
  double time, force, deflection, gap;  // s, N, mm, mm
  std::int32_t contact;                 // 0: none
  Mode mode;
};

// Passes each tick of the record to `take`, from the first on.
template <class Take>
void for_samples(RecordReader& record, const Scene& scene, const Take& take) {
  record.rewind();
  for (RecordedTick frame; record.next(frame);) {
    const Outputs& out = frame.out;
    take(Sample{seconds(frame.tick.t.time_since_epoch()), trial::pressing_force(scene, out),
                kMmPerM * out.deflection, kMmPerM * out.gap, trial::contact_number(out), out.mode});
  }
}

struct Charts {
  std::array<Chart, 3> over_time;
  Chart loop;
};

// The approach is tens of millimetres long, the press a few: the gap's axis ends where the press is still
// seen.
Range gap_range(Range gap) {
  if (gap.any && gap.least < 10.0) gap.most = std::min(gap.most, std::max(10.0, -3.0 * gap.least));
  return gap;
}

Charts charts_of(RecordReader& record, const Scene& scene) {
  Range time, force, deflection, gap, loop_force, loop_deflection;
  for_samples(record, scene, [&](const Sample& s) {
    time.see(s.time);
    force.see(s.force);
    deflection.see(s.deflection);
    gap.see(s.gap);
    if (s.contact == 0) return;
    loop_force.see(s.force);
    loop_deflection.see(s.deflection);
  });
  if (time.most <= time.least) time.most = time.least + 1e-3;
  Charts charts;
  const std::array ranges{force, deflection, gap_range(gap)};
  const std::array names{"force, N", "deflection, mm", "gap, mm"};
  for (std::size_t i = 0; i < ranges.size(); ++i)
    charts.over_time[i] = {66.0,
                           kTop + static_cast<double>(i) * (kStrip + kGapBetween),
                           540.0,
                           kStrip,
                           time,
                           rounded(ranges[i]),
                           i + 1 == ranges.size() ? "time, s" : "",
                           names[i]};
  charts.loop = {684.0,
                 kTop,
                 260.0,
                 3.0 * kStrip + 2.0 * kGapBetween,
                 rounded(loop_deflection),
                 rounded(loop_force),
                 "deflection, mm",
                 "force, N"};
  return charts;
}

// The modes as bands behind the charts over time, and their legend.
class Modes {
 public:
  explicit Modes(const std::array<Chart, 3>& charts) : charts_(charts) {}
  void see(double time, Mode mode) {
    if (any_ && mode == mode_) return;
    end(time);
    any_ = true;
    mode_ = mode;
    begin_ = time;
  }
  void end(double time) {
    if (!any_) return;
    const auto i = static_cast<std::size_t>(mode_);
    seen_[i] = true;
    for (const Chart& chart : charts_)
      bands_ += bar(chart.px(begin_), chart.top, chart.px(time) - chart.px(begin_), chart.height, kBands[i]);
  }
  [[nodiscard]] const std::string& bands() const { return bands_; }
  [[nodiscard]] std::string legend() const {
    std::string text;
    double x = charts_[0].left;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (!seen_[i]) continue;
      text += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='14' height='14' fill='{}' stroke='#999999'/>\n",
                          x, kHeight - 26.0, kBands[i]);
      text += label(x + 20.0, kHeight - 14.0, mode_name(static_cast<Mode>(i)));
      x += 90.0;
    }
    return text;
  }

 private:
  const std::array<Chart, 3>& charts_;
  std::string bands_;
  std::array<bool, kModes> seen_{};
  Mode mode_ = Mode::away;
  double begin_ = 0.0;
  bool any_ = false;
};

std::string picture(RecordReader& record, const Scene& scene, const std::string& title) {
  const Charts charts = charts_of(record, scene);
  Modes modes(charts.over_time);
  std::vector<Trace> traces(charts.over_time.begin(), charts.over_time.end());
  Path loop;
  double last = 0.0;
  std::int32_t contact = 0;
  for_samples(record, scene, [&](const Sample& s) {
    modes.see(s.time, s.mode);
    const std::array values{s.force, s.deflection, s.gap};
    for (std::size_t i = 0; i < values.size(); ++i) traces[i].add(s.time, values[i]);
    last = s.time;
    if (s.contact != contact) loop.lift();
    contact = s.contact;
    if (contact != 0 && std::isfinite(s.force) && std::isfinite(s.deflection))
      loop.add(charts.loop.px(s.deflection), charts.loop.py(s.force));
  });
  modes.end(last);
  std::string text = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
      "font-family='sans-serif' "
      "font-size='13' fill='#333333'>\n<rect width='{0}' height='{1}' fill='#ffffff'/>\n",
      kWidth, kHeight);
  text += label(66.0, 26.0, title, "font-size='16'") + modes.bands();
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const std::string clip = fmt::format("c{}", i);
    text += axes(charts.over_time[i], clip) + line(traces[i].text(), clip);
  }
  text += axes(charts.loop, "loop") + line(loop.text(), "loop");
  return text + modes.legend() + "</svg>\n";
}

}  // namespace

int plot(const PlotOptions& options) {
  models::note_input(options.record);
  RecordReader record(options.record, options.partial ? PartialRead::yes : PartialRead::no);
  const models::Setup setup = models::setup_of(record.texts(), options.record);
  const Scene scene = trial::prepare_setup(setup);
  if (record.ticks() == 0)
    throw Error(options.record + ": holds no whole tick; there is nothing to draw; record it again");
  const std::string svg = picture(record, scene, models::printable(setup.scene.title));
  if (options.svg == "-")
    std::fwrite(svg.data(), 1, svg.size(), stdout);
  else
    models::write_file(options.svg, svg, models::existing(options.force));
  if (const std::string lack = lack_of(record, "picture"); !lack.empty())
    fmt::print(stderr, "encounter: {}: {}\n", options.record, lack);
  return record.damage().empty() ? 0 : 1;
}

}  // namespace enc::app
