#include "app/window/window.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <thread>

#include <fmt/format.h>

#include "app/modules/modules.h"
#include "app/run/percentiles.h"
#include "app/run/run_window.h"
#include "app/view/depict.h"
#include "app/window/controls.h"
#include "app/window/feed.h"
#include "app/window/link.h"
#include "core/error.h"
#include "sim/window/window.h"
#include "trial/operator/consent.h"

namespace enc::app {
namespace {

using Wall = std::chrono::steady_clock;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr int kWidth = 1280, kHeight = 720;  // px
constexpr milliseconds kPicture{16};         // between two pictures
constexpr float kChartTime = 6.0F;           // s
constexpr double kHover = 0.015;             // m above a place that was clicked

// Draws one run and passes on the user's wishes.
class Show {
 public:
  Show(Feed& feed, sim::ViewWindow& window, bool real, bool recording)
      : feed_(feed), window_(window), real_(real), recording_(recording) {
    window_.forget();
  }

  // Draws until the run ends or the window is closed. True: the user wants a restart.
  bool run(Link& link) {
    std::vector<sim::WindowEvent> news, events;  // kept until there is something to see
    Wall::time_point next = Wall::now();
    while (!link.ended()) {
      if (!window_.poll(news)) link.end();
      events.insert(events.end(), news.begin(), news.end());
      if (feed_.take()) shift_objects(feed_.moment(), feed_.newest().data.get());
      if (!controls_ && feed_.newest().now.t != Time{}) controls_.emplace(camera_for(feed_.moment(), false));
      if (!controls_) {
        std::this_thread::sleep_for(milliseconds(2));
        continue;
      }
      for (const sim::WindowEvent& event : events) controls_->see(event, around());
      events.clear();
      if (link.take_event()) controls_->paused_at_event();
      const Wishes wishes = controls_->take_wishes();
      link.wish(wishes);
      if (wishes.restarts) return true;
      draw(wishes);
      next = std::max(next + kPicture, Wall::now());
      std::this_thread::sleep_until(next);
    }
    return false;
  }

 private:
  [[nodiscard]] Surroundings around() {
    Surroundings around;
    around.width = window_.width();
    around.height = window_.height();
    around.tip = feed_.newest().truth.tool_tip;
    around.steerable = !real_ && feed_.newest().truth.tool >= 0;
    around.real = real_;
    around.recording = recording_;
    around.above = [this](double x, double y) { return above(x, y); };
    return around;
  }
  // The place kHover above the object seen at (x, y).
  [[nodiscard]] std::optional<Point<'W'>> above(double x, double y) {
    const auto seen = window_.seen_at(x, y, feed_.newest().data.get());
    if (!seen) return {};
    const Moment m = feed_.moment();
    std::optional<Point<'W'>> place;
    double least = 0.01;  // m: a point farther from every object belongs to the machine
    for (const Object& object : m.scene.objects) {
      const Nearest near = object.surface.nearest(object.X_WO.inverse() * *seen);
      if (!(std::abs(near.distance) < least)) continue;
      least = std::abs(near.distance);
      place = object.X_WO * near.point + kHover * (object.X_WO * near.normal);
    }
    return place;
  }

  void draw(const Wishes& wishes) {
    const Moment m = feed_.moment();
    controls_->follow(m.truth.tool_tip);
    sim::ViewRequest request = depict(m, controls_->camera(), false);
    request.labels.clear();
    request.data = feed_.newest().data.get();
    request.dent = [&m](mjModel* model) { return dent_object(m, model); };
    write(m, wishes, request);
    chart(request);
    window_.draw(request);
  }

  void write(const Moment& m, const Wishes& wishes, sim::ViewRequest& request) {
    const auto row = [&](const std::string& name, const std::string& value) {
      request.names += (request.names.empty() ? "" : "\n") + name;
      request.values += (request.values.empty() ? "" : "\n") + value;
    };
    const std::uint32_t why = m.out.why & kHoldReasons;
    row("mode", feed_.newest().status.halted
                    ? std::string("STOPPED BY HAND (R resumes)")
                    : std::string(mode_name(m.out.mode)) + (why != 0 ? ": " + why_text(why) : ""));
    const double force = m.out.mode == Mode::contact ? -m.out.force.xyz[2] : 0.0;
    row("force", fmt::format("{:.2f} N{}", force == 0.0 ? 0.0 : force, m.truth.touching ? ", felt" : ""));
    row("deflection", m.out.mode == Mode::contact ? fmt::format("{:.2f} mm", 1e3 * m.out.deflection) : "-");
    row("gap", std::isfinite(m.out.gap) ? fmt::format("{:.1f} mm", 1e3 * m.out.gap) : "-");
    row("hand", hand_text(m, wishes));
    const trial::RunStatus& status = feed_.newest().status;
    if (const Percentiles of = periods_of(status); !std::isnan(of.p99))
      row("period p99", fmt::format("{:.2f} ms", 1e-6 * of.p99));
    if (status.missed > 0) row("missed", std::to_string(status.missed));
    row("time", time_text(m, wishes));
    row("drawn by", window_.renderer());
    row("help", "H");
    if (!controls_->help()) return;
    for (const Controls::Help& line : Controls::help_lines(real_)) {
      request.help_keys += fmt::format("{}{}", request.help_keys.empty() ? "" : "\n", line.key);
      request.help += fmt::format("{}{}", request.help.empty() ? "" : "\n", line.what);
    }
  }

  std::string hand_text(const Moment& m, const Wishes& wishes) {
    if (real_) return "at the real devices";
    if (m.truth.tool < 0) return "none";
    if (!wishes.hand) return "the scene's: drag to take it";
    return controls_->grabbed() ? "yours (G lets go)" : "yours";
  }

  std::string time_text(const Moment& m, const Wishes& wishes) {
    if (wishes.paused) return "paused";
    const double t = seconds(m.now.t.time_since_epoch());
    const double wall = duration<double>(Wall::now() - paced_from_).count();
    if (wall > 0.5) {
      pace_ = (t - paced_at_) / wall;
      paced_from_ = Wall::now();
      paced_at_ = t;
    }
    return fmt::format("{:.2f} x real time", pace_);
  }

  // Strip charts of the last kChartTime seconds.
  void chart(sim::ViewRequest& request) {
    for (ChartSample one; feed_.next(one);) {
      if (controls_->frozen()) continue;
      samples_.push_back(one);
    }
    while (!samples_.empty() && samples_.front().t < samples_.back().t - kChartTime) samples_.pop_front();
    if (!controls_->charts() || samples_.empty()) return;
    const float end = samples_.back().t;
    const auto line = [&](const char* name, float ChartSample::*what) {
      sim::ViewLine drawn{name, {}};
      const std::size_t each = samples_.size() / 1000 + 1;
      for (std::size_t i = 0; i < samples_.size(); i += each) {
        drawn.xy.push_back(samples_[i].t - end);
        drawn.xy.push_back(samples_[i].*what);
      }
      return drawn;
    };
    request.charts = {{"deflection and gap, mm",
                       {line("deflection", &ChartSample::deflection), line("gap", &ChartSample::gap)},
                       {-kChartTime, 0},
                       {0, 10}},
                      {"force, N",
                       {line("measured", &ChartSample::measured), line("filtered", &ChartSample::filtered)},
                       {-kChartTime, 0},
                       {0, 5}}};
    if (feed_.newest().simulated)
      request.charts.back().lines.push_back(line("true", &ChartSample::true_force));
  }

  Feed& feed_;
  sim::ViewWindow& window_;
  bool real_, recording_;
  Wall::time_point paced_from_ = Wall::now();
  double paced_at_ = 0.0, pace_ = 1.0;
  std::optional<Controls> controls_;
  std::deque<ChartSample> samples_;
};

// Thrown on the run's thread when its window could not be opened.
struct NotShown {};

// One run on its own thread.
class Run {
 public:
  explicit Run(const RunOptions& options) : options_(options) {
    hooks_.adapts = leave_out_vision;
    hooks_.begins = [this](trial::Trial& trial) {
      if (!trial.has_world())
        throw Error(
            "no device of this rig is simulated, so there is nothing to draw; expected a rig with a "
            "simulated "
            "device, such as the display; use encounter run");
      real_ = trial.result().keeps_wall_time || trial::moves_device(trial.setup());
      dt_ = trial.scene().dt;
      feed_.emplace(trial);
      if (!link_.begin(trial.result().keeps_wall_time)) throw NotShown{};
    };
    hooks_.ends = [this] { link_.wait_for_close(); };
    hooks_.watch = [this](const trial::Glance& glance) {
      link_.see(glance);
      feed_->see(glance);
    };
    hooks_.stop = [this] { return link_.ends(); };
    hooks_.waits = [this] { return link_.waits(dt_); };
    hooks_.hand = [this] { return link_.machine(); };
    hooks_.steer = [this](std::int64_t) { return link_.hand(); };
    thread_ = std::thread([this] {
      try {
        code_ = app::run(options_, &hooks_);
      } catch (const NotShown&) {  // the window's thread reports it
      } catch (...) {
        failed_ = std::current_exception();
      }
      link_.over();
    });
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run() { join(); }

  [[nodiscard]] Link& link() { return link_; }
  [[nodiscard]] Feed& feed() { return *feed_; }
  [[nodiscard]] bool real() const { return real_; }
  // Ends the run and waits until its record is sealed and its report is printed.
  void join() {
    if (!thread_.joinable()) return;
    link_.end();
    link_.let_go();
    link_.closed();
    thread_.join();
  }
  // The exit code; rethrows the run's exception.
  int code() {
    join();
    if (failed_) std::rethrow_exception(failed_);
    return code_;
  }

 private:
  RunOptions options_;
  RunWindow hooks_;
  Link link_;
  std::optional<Feed> feed_;
  bool real_ = false;
  double dt_ = 1e-3;
  int code_ = 0;
  std::exception_ptr failed_;
  std::thread thread_;
};

}  // namespace

int window(const ViewOptions& options) {
  const auto* module = static_cast<const sim::WindowModule*>(load_module("window").window);
  module->look();
  Run* shown = nullptr;
  const auto lost = [&shown] {
    if (shown != nullptr) shown->join();
    fmt::print(stderr, "encounter: the display is lost; the run was ended, its record is whole\n");
    std::fflush(nullptr);
  };
  std::unique_ptr<sim::ViewWindow> window;
  for (;;) {
    Run run(options);
    if (!run.link().wait_for_begin()) return run.code();
    shown = &run;
    try {
      if (!window) window = module->open("Encounter: " + options.scene, kWidth, kHeight, lost);
    } catch (...) {
      run.link().refuse();
      throw;
    }
    run.link().let_go();
    const bool again = Show(run.feed(), *window, run.real(), !options.record.empty()).run(run.link());
    if (!again) window.reset();
    const int code = run.code();
    shown = nullptr;
    if (!again) return code;
  }
}

}  // namespace enc::app
