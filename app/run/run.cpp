#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "app/built.h"
#include "app/common/options.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "app/run/console.h"
#include "app/run/live_run.h"
#include "app/run/run_files.h"
#include "app/run/run_report.h"
#include "app/run/run_window.h"
#include "app/stability_text.h"
#include "core/base/error.h"
#include "models/files.h"
#include "trial/measure/run_measures.h"
#include "trial/operator/operator.h"
#include "trial/provenance/provenance.h"
#include "trial/steered/steering.h"
#include "trial/time/real_time.h"
#include "trial/trial.h"

namespace enc::app {
namespace {

double pace_of(const std::string& text) {
  if (text == "free") return 0.0;
  if (text == "wall") return 1.0;
  double factor = 0.0;
  const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), factor);
  if (bad != std::errc() || end != text.data() + text.size() || !(factor > 0.0) || !std::isfinite(factor))
    throw Error("--pace '" + text + "': expected free, wall, or a positive number such as 0.1 or 10");
  return factor;
}

void check_options(const RunOptions& options) {
  if (options.seconds && !(*options.seconds > 0.0 && *options.seconds < 1e6))
    throw Error("--for-s: expected a positive number of seconds below a million");
  if (!options.live.empty()) static_cast<void>(live_address(options.live));
}

// Warnings about unstable rendering, printed before anything moves.
std::vector<std::string> beyond(const models::Setup& setup,
                                const std::vector<trial::ObjectCertificate>& certificates) {
  std::vector<std::string> lines;
  for (const trial::ObjectCertificate& one : certificates)
    if (one.beyond()) lines.push_back("beyond what is stable: " + trial::refusal_text(setup, one));
  return lines;
}

int diverged(const trial::TrialResult& result, const models::Setup& setup) {
  fmt::print(stderr, "encounter: the physics diverged at tick {}: {}; try a smaller {}.timestep_us\n",
             result.diverged_at, result.divergence, setup.twin.stepping(setup.scene).table);
  return 4;
}

trial::TrialOptions trial_options(const RunOptions& options, trial::Operator& person) {
  trial::TrialOptions all;
  all.seed = options.seed;
  all.seconds = options.seconds.value_or(kUnset);
  all.pace = pace_of(options.pace);
  if (!options.live.empty() && all.pace == 0.0) all.pace = 1.0;
  all.drivers = load_module;
  all.armed = options.armed;
  all.lockstep = options.lockstep;
  all.real_time = true;  // also for a dry run: late ticks cause a hold
  all.needs_real_time = !options.not_real_time;
  all.certify = true;
  all.frames = options.frames;
  all.begins = [&person] { person.begin(); };
  all.stop = [&person] { return person.stop(); };
  all.hand = [&person] { return person.next(); };
  return all;
}

// Shows an armed run while it happens.
class RunDisplay {
 public:
  RunDisplay(trial::TrialOptions& options, trial::Operator& person) : person_(person) {
    options.watch = [this, counts = std::move(options.watch)](const trial::Glance& glance) {
      counts(glance);
      watch_.see(glance);
    };
    person.acts = [this](trial::Hand hand, bool suspended) {
      using Kind = trial::RunEvent::Kind;
      if (hand != trial::Hand::resume)
        watch_.note(suspended ? Kind::suspended : Kind::halted);
      else if (watch_.halted())
        watch_.note(Kind::resumed);
    };
    person.pauses = [this] {
      if (console_) console_->flush();
    };
  }
  RunDisplay(const RunDisplay&) = delete;
  RunDisplay& operator=(const RunDisplay&) = delete;
  void begin(const models::Setup& setup) {
    std::vector<std::string> objects;
    for (const ObjectSpec& object : setup.scene.objects) objects.push_back(object.name);
    console_.emplace(watch_, std::move(objects), [this] { return person_.reads_keys(); });
  }
  void end() {
    if (person_.signal() != 0 || person_.quits()) watch_.note(trial::RunEvent::Kind::ends, person_.signal());
    console_.reset();
  }

 private:
  trial::Operator& person_;
  trial::RunWatch watch_;
  std::optional<Console> console_;
};

// Adds the window's hooks to those of the terminal. The window is asked first.
void join(const RunWindow& window, trial::Operator& person, trial::TrialOptions& options) {
  if (window.watch)
    options.watch = [counts = std::move(options.watch), &window](const trial::Glance& glance) {
      counts(glance);
      window.watch(glance);
    };
  options.look = window.look;
  if (window.stop)
    options.stop = [asked = std::move(options.stop), &window] {
      do
        if (asked() || window.stop()) return true;
      while (window.waits && window.waits());
      return false;
    };
  if (window.hand)
    options.hand = [asked = std::move(options.hand), &window, &person] {
      const trial::Hand hand = asked();
      if (hand != trial::Hand::none) return hand;
      const trial::Hand here = window.hand();
      if (here != trial::Hand::none && person.acts) person.acts(here, false);
      return here;
    };
  options.draw_all = window.draws;
  if (std::isnan(options.seconds)) options.seconds = std::numeric_limits<double>::infinity();
}

// A played hand needs a simulated hand, and the ticks of its record.
void check_played(const RunOptions& options, const models::Setup& setup, const trial::SteeredRun& played) {
  if (!setup.scene.user || trial::moves_device(setup))
    throw Error(options.hand +
                ": is played by a simulated hand, and this run has none; expected a scene with [user] on a "
                "simulated rig; leave --hand out");
  if (std::abs(played.period * setup.rig.loop.rate - 1.0) > 1e-6)
    throw Error(
        fmt::format("{}: was steered at {:.6g} Hz and this rig's loop runs at {:.6g} Hz; expected the "
                    "same; set rig.loop.rate_hz",
                    options.hand, 1.0 / played.period, setup.rig.loop.rate));
  if (played.seed != std::to_string(options.seed))
    print_notes({"the hand of " + options.hand + " was steered with --seed " + played.seed});
}

// The hand steered by a window or a record, with the part of it that this run's record keeps.
class Steering {
 public:
  Steering(const RunOptions& options, const models::Setup& setup, const RunWindow* window,
           trial::TrialOptions& how) {
    if (!options.hand.empty()) {
      trial::SteeredRun played = trial::steered_run(options.hand);
      check_played(options, setup, played);
      if (!options.seconds) how.seconds = played.duration;
      played_ = std::move(played.log);
      how.steer = [this](std::int64_t tick) { return kept(tick, played_.at(tick)); };
    } else if (window != nullptr && window->steer) {
      how.steer = [this, window](std::int64_t tick) { return kept(tick, window->steer(tick)); };
    }
  }
  Steering(const Steering&) = delete;
  Steering& operator=(const Steering&) = delete;
  [[nodiscard]] const trial::SteeringLog& log() const { return log_; }

 private:
  std::optional<trial::HandWord> kept(std::int64_t tick, const std::optional<trial::HandWord>& word) {
    if (word) log_.add(tick, *word);
    return word;
  }
  trial::SteeringLog played_, log_;
};

// Calls the window's begins() and ends(); the window uses the trial in between.
struct WindowScope {
  WindowScope(const RunWindow* by, trial::Trial& trial) : window(by) {
    if (window != nullptr && window->begins) window->begins(trial);
  }
  ~WindowScope() {
    if (window != nullptr && window->ends) window->ends();
  }
  WindowScope(const WindowScope&) = delete;
  WindowScope& operator=(const WindowScope&) = delete;
  const RunWindow* window;
};

// Asks the person beside a machine that will move. 0: it may move; else the exit code.
int asked_first(trial::Operator& person, const trial::Trial& trial) {
  const trial::Answer answer =
      person.confirm(trial::motion_question(trial.setup(), trial.scene(), trial.result().devices));
  if (answer == trial::Answer::yes) return 0;
  fmt::print(stderr, "\nencounter: not begun; nothing has moved\n");
  return answer == trial::Answer::stopped ? 128 + person.signal() : 2;
}

RecordTexts end_texts(const std::string& ledger, const trial::SteeringLog& hand) {
  RecordTexts texts;
  if (!ledger.empty()) texts["ledger"] = ledger;
  if (!hand.empty()) texts["hand"] = hand.text();
  return texts;
}

// Seals the files with the texts that only the end of the run provides.
void seal(RunFiles& files, const trial::RunMeasures& measured, const trial::SteeringLog& hand) {
  const auto contacts = measured.ledger.contacts();
  files.end(end_texts(contacts.empty() ? std::string() : trial::ledger_table(contacts), hand));
}

// The run's surroundings besides the loop; null: absent.
struct RunSurroundings {
  trial::Operator& person;
  const RunWindow* window;
  RunDisplay* shown;
  bool terminal;
  const trial::RunMeasures& measured;
  const trial::SteeringLog& hand;
};
struct RunOutcome {
  double started;  // CPU s from the start of the process to the first tick
  trial::TrialResult result;
};
RunOutcome run_to_end(trial::Trial& trial, RunFiles& files, const RunSurroundings& beside) {
  trial.record_to(files.record());
  beside.person.listen();
  if (beside.shown != nullptr) beside.shown->begin(trial.setup());
  const WindowScope watched(beside.window, trial);
  const double started = cpu_seconds();
  trial::TrialResult result = trial.run();
  // Seal first, because a terminal may block the printing.
  seal(files, beside.measured, beside.hand);
  beside.person.end_listening();
  if (beside.shown != nullptr) beside.shown->end();
  if (beside.terminal && beside.shown == nullptr) clear_progress();
  return {started, std::move(result)};
}

void print(const RunReport& report) {
  const std::string text = report.asked.json ? run_json(report) : run_text(report);
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);  // while signals are handled, a pipe without a reader is only an error
}

int ended(const RunReport& report, const trial::Operator& person) {
  if (report.result.diverged_at >= 0) return diverged(report.result, report.setup);
  return person.signal() != 0 ? 128 + person.signal() : exit_code(report);
}

}  // namespace

int run(const RunOptions& options) { return run(options, nullptr); }

int run(const RunOptions& options, const RunWindow* window) {
  trial::Operator person;
  models::Setup setup = load_setup(options);
  if (window != nullptr && window->adapts) window->adapts(setup);
  check_options(options);
  const bool moves = options.armed && trial::moves_device(setup);
  const bool attended = moves && !options.lockstep;  // lockstep runs have only fakes
  if (attended && !options.yes) trial::refuse_unasked();
  if (attended) person.stops_when_suspended();
  trial::TrialOptions how = trial_options(options, person);
  trial::RunMeasures measured(setup, how);
  RunFiles files(options);
  files.watch(how);
  if (window != nullptr) join(*window, person, how);
  const Steering steering(options, setup, window, how);
  std::optional<RunDisplay> shown;
  if (moves) shown.emplace(how, person);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal && !shown && window == nullptr) how.progress = show_progress;
  trial::Trial trial(setup, how);  // refuses bad input before a record is begun
  print_notes(setup.notes);        // only for an accepted scene
  print_notes(beyond(setup, trial.certificates()));
  if (attended && !options.yes)
    if (const int code = asked_first(person, trial); code != 0) return code;
  const trial::WallTime begun = trial::wall_time();
  files.begin(trial, begun);
  const RunSurroundings beside{person, window, shown ? &*shown : nullptr, terminal, measured, steering.log()};
  const auto [started, result] = run_to_end(trial, files, beside);
  const std::vector<trial::ArmStrength> strengths = trial::strengths_of(setup, trial.scene());
  RunReport report{setup, trial.scene(), result, measured, strengths, trial.certificates(), options};
  report.started = started;
  report.begun = begun;
  report.steered = !steering.log().empty();
  complete(trial, report);
  print(report);
  if (const std::string error = files.record_error(); !error.empty())
    throw Error(error + "; replay --partial reads what was written");
  return ended(report, person);
}

}  // namespace enc::app
