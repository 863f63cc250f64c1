#include "app/window/show.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "app/run/percentiles.h"
#include "app/view/moment/depict.h"
#include "core/base/error.h"
#include "trial/steered/steering.h"

namespace enc::app {
namespace {

constexpr int kChartsFrom = 850;  // px, width of a window with room for charts
constexpr double kHover = 0.015;  // m above a clicked place

// Draws the core's estimates: the tool's tip, the surface point below it, the gap between them, and the
// commanded haptic-tip.
void add_core(const Moment& m, sim::ViewRequest& request) {
  constexpr sim::Colour kTool{0.16F, 0.42F, 0.72F, 0.45F}, kGap{0.35F, 0.38F, 0.45F, 0.8F},
      kTarget{0.90F, 0.30F, 0.60F, 0.45F};
  constexpr double kBall = 0.006, kLine = 0.0006;  // m
  const auto ball = [&](const Point<'W'>& at, const sim::Colour& colour) {
    request.rods.push_back({at, at, kBall, colour});
  };
  const Point<'W'> tool = m.state.last_query, surface = m.state.last_point;
  if (m.out.view.tool >= 0 && tool.finite()) {
    ball(tool, kTool);
    if (surface.finite() && std::isfinite(m.out.gap)) request.rods.push_back({tool, surface, kLine, kGap});
  }
  const Point<'W'> target = m.look.target(m);
  if (target.finite()) ball(target, kTarget);
}

std::string mode_text(const RunSnapshot& still) {
  if (still.halted) return "STOPPED BY HAND (R resumes)";
  const std::uint32_t why = still.out.why & kHoldReasons;
  return std::string(mode_name(still.out.mode)) + (why != 0 ? ": " + why_text(why) : "");
}

std::string faults_text(std::uint8_t faults) {
  std::string text;
  for (const auto& [bit, words] : {std::pair{trial::kFrozenTracker, "tracker frozen"},
                                   {trial::kDroppedPackets, "packets lost"},
                                   {trial::kLateClock, "clock late"},
                                   {trial::kSaturated, "force saturates"}})
    if ((faults & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(words);
  return text;
}

}  // namespace

Show::Show(trial::Trial& trial, sim::ViewWindow& window, const ShowOptions& what)
    : trial_(trial),
      window_(window),
      what_(what),
      data_(mj_makeData(trial.world().physics().model())),
      timeline_(what.most_stills),
      charts_(what.most_samples) {
  if (!data_) throw Error("not enough memory for a window", {}, ErrorKind::device);
  window_.forget();
}

void Show::add(const RunSnapshot& still) {
  timeline_.add(still);
  if (!controls_) controls_.emplace(camera_for(moment_of(trial_, still, data_.get()), false));
}

void Show::add(CameraFeed::Pictures&& pictures) {
  if (pictures.augmented.width > 0)
    pictures_.augmented = std::move(pictures.augmented);
  else
    pictures_.pair = std::move(pictures.pair);
}

bool Show::shows(Controls::Insets insets) const {
  return controls_ && controls_->insets(what_.cameras) == insets && !timeline_.past();
}

// Small pictures along the bottom: other views of the scene, or images of the scene's own camera.
void Show::inset(const Moment& m, sim::ViewRequest& request) const {
  using Insets = Controls::Insets;
  const auto turned = [&](const char* name, double by) {
    sim::Camera camera = camera_for(m, false);
    camera.azimuth += by;
    request.insets.push_back({name, nullptr, camera});
  };
  const auto image = [&](const char* name, const Image& picture) {
    if (picture.width > 0 && !timeline_.past()) request.insets.push_back({name, &picture, {}});
  };
  switch (controls_->insets(what_.cameras)) {
    case Insets::none:
      break;
    case Insets::contact:
      request.insets.push_back({"contact", nullptr, camera_for(m, true)});
      break;
    case Insets::sides:
      turned("left", 0.5 * std::numbers::pi);
      turned("right", -0.5 * std::numbers::pi);
      break;
    case Insets::pair:
      image("left camera", pictures_.pair.left);
      image("right camera", pictures_.pair.right);
      break;
    case Insets::augmented:
      image("augmented view", pictures_.augmented);
      break;
  }
}

RunRequests Show::see(const std::vector<sim::WindowEvent>& events) {
  for (const sim::WindowEvent& event : events) controls_->see(event, around());
  const RunRequests wishes = controls_->take_wishes();
  if (wishes.newest) timeline_.show_newest();
  if (wishes.seek) timeline_.seek(*wishes.seek);
  if (wishes.stills != 0) timeline_.step(wishes.stills);
  return wishes;
}

Surroundings Show::around() {
  const RunSnapshot& shown = timeline_.shown();
  Surroundings around;
  around.width = window_.width();
  around.height = window_.height();
  around.tip = shown.truth.tool_tip;
  around.real = what_.of == Controls::RunKind::real;
  around.played = what_.of == Controls::RunKind::record;
  around.past = timeline_.past();
  // An empty hand on its way to the other tool can also be steered.
  const bool hand = trial_.setup().scene.user.has_value() && shown.truth.tool_tip.finite();
  around.steerable = what_.of == Controls::RunKind::simulated && hand && !around.past;
  around.recording = what_.recording;
  around.above = [this](double x, double y) { return above(x, y); };
  around.over = [this](int object) { return over(object); };
  return around;
}

// The place kHover above the object seen at (x, y).
std::optional<Point<'W'>> Show::above(double x, double y) {
  const auto seen = window_.seen_at(x, y, data_.get());
  if (!seen) return {};
  std::optional<Point<'W'>> place;
  double least = 0.01;  // m: a point farther from every object belongs to the machine
  for (const Object& object : trial_.scene().objects) {
    const SurfacePoint near = object.surface.nearest(object.X_WO.inverse() * *seen);
    if (!(std::abs(near.distance) < least)) continue;
    least = std::abs(near.distance);
    place = object.X_WO * near.point + kHover * (object.X_WO * near.normal);
  }
  return place;
}

// The place kHover above the point of an object that the simulated hand would press.
std::optional<Point<'W'>> Show::over(int object) const {
  const auto& objects = trial_.setup().scene.objects;
  if (objects.empty() || !trial_.setup().scene.user) return {};
  UserSpec user = *trial_.setup().scene.user;
  user.object = objects[static_cast<std::size_t>(object) % objects.size()].name;
  const PressPoint at = press_point(trial_.setup().scene, user);
  return at.point + kHover * at.normal;
}

void Show::draw(const RunRequests& wishes, const trial::RunStatus* status) {
  const RunSnapshot& shown = timeline_.shown();
  const Moment m = moment_of(trial_, shown, data_.get());
  controls_->follow(m.truth.tool_tip);
  sim::ViewRequest request = depict(m, controls_->camera(), false);
  name_objects(m, request);
  add_core(m, request);
  request.data = data_.get();
  if (m.out.mode == Mode::contact || m.out.mode == Mode::restore)
    request.dent = [&m](mjModel* model) { return dent_object(m, model); };
  write(m, wishes, status, request);
  if (controls_->help()) request.title.clear();
  if (controls_->charts() && !controls_->help() && window_.width() >= kChartsFrom)
    request.charts =
        charts_.until(seconds_of(shown), window_.chart_at(controls_->x(), controls_->y()), shown.simulated);
  inset(m, request);
  request.bar = timeline_.bar();
  request.message = message_;
  window_.draw(request);
}

void Show::write(const Moment& m, const RunRequests& wishes, const trial::RunStatus* status,
                 sim::ViewRequest& request) {
  const auto row = [&](const std::string& name, const std::string& value) {
    request.names += (request.names.empty() ? "" : "\n") + name;
    request.values += (request.values.empty() ? "" : "\n") + value;
  };
  // A real machine moves on while the user looks at the past, so its present mode comes first.
  const bool real = what_.of == Controls::RunKind::real;
  row("mode", mode_text(real ? timeline_.newest() : timeline_.shown()));
  if (real && timeline_.past()) row("shown", mode_text(timeline_.shown()));
  const double force = m.out.mode == Mode::contact ? -m.out.force.xyz[2] : 0.0;
  row("force", fmt::format("{:.2f} N{}", force == 0.0 ? 0.0 : force, m.truth.touching ? ", felt" : ""));
  row("deflection", m.out.mode == Mode::contact ? fmt::format("{:.2f} mm", 1e3 * m.out.deflection) : "-");
  row("gap", std::isfinite(m.out.gap) ? fmt::format("{:.1f} mm", 1e3 * m.out.gap) : "-");
  row("hand", hand_text(m, wishes));
  if (wishes.faults != 0) row("fault", faults_text(wishes.faults));
  if (status != nullptr) {
    if (const Percentiles of = periods_of(*status); !std::isnan(of.p99))
      row("period p99", fmt::format("{:.2f} ms", 1e-6 * of.p99));
    if (status->missed > 0) row("missed", std::to_string(status->missed));
  }
  row("time", time_text(m, wishes));
  row("drawn by", window_.renderer());
  row("help", "H");
  if (!controls_->help()) return;
  for (const Controls::Help& line : Controls::help_lines(what_.of)) {
    request.help_keys += fmt::format("{}{}", request.help_keys.empty() ? "" : "\n", line.key);
    request.help += fmt::format("{}{}", request.help.empty() ? "" : "\n", line.what);
  }
}

std::string Show::hand_text(const Moment& m, const RunRequests& wishes) {
  if (what_.of == Controls::RunKind::real) return "at the real devices";
  if (!trial_.setup().scene.user) return "none";
  std::string tool;
  if (m.truth.tool < 0)
    tool = "empty, ";
  else if (trial_.scene().tools.size() > 1)
    tool = trial_.setup().scene.tools[static_cast<std::size_t>(m.truth.tool)].name + ", ";
  if (what_.of == Controls::RunKind::record) return tool + "recorded";
  if (!wishes.hand) return tool + "the scene's: drag to take it";
  return tool + (controls_->grabbed() ? "yours (G lets go)" : "yours");
}

std::string Show::time_text(const Moment& m, const RunRequests& wishes) {
  const double t = seconds(m.now.t.time_since_epoch());
  if (what_.of == Controls::RunKind::record)
    return fmt::format("{:.3f} s{}", t,
                       wishes.paused ? ", stopped" : fmt::format(", x {:.3g}", wishes.speed));
  if (timeline_.past()) return fmt::format("{:.3f} s, {:.3f} s ago", t, seconds_of(timeline_.newest()) - t);
  if (wishes.paused) return fmt::format("{:.3f} s, paused", t);
  const double wall = std::chrono::duration<double>(Wall::now() - paced_from_).count();
  if (wall > 0.5) {
    pace_ = (t - paced_at_) / wall;
    paced_from_ = Wall::now();
    paced_at_ = t;
  }
  return fmt::format("{:.1f} s, {:.2f} x real time", t, pace_);
}

}  // namespace enc::app
