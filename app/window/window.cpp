#include "app/window/window.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/built.h"
#include "app/common/words.h"
#include "app/modules/modules.h"
#include "app/run/run_window.h"
#include "app/view/moment/depict.h"
#include "app/view/recorded/source.h"
#include "app/window/feed.h"
#include "app/window/link.h"
#include "app/window/show.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/scene_names.h"
#include "sim/window/window.h"
#include "trial/assemble/assemble.h"
#include "trial/operator/operator.h"

namespace enc::app {
namespace {

// The thread of all runs of a window. It is made before the window's thread lowers its priority, because
// threads inherit a lower priority and cannot raise it again.
class RunThread {
 public:
  RunThread() : thread_([this] { work(); }) {}
  ~RunThread() {
    tell(nullptr, true);
    thread_.join();
  }
  RunThread(const RunThread&) = delete;
  RunThread& operator=(const RunThread&) = delete;

  void begin(std::function<void()> run) { tell(std::move(run), false); }  // after wait()
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !run_; });
  }

 private:
  void tell(std::function<void()> run, bool ends) {
    const std::lock_guard lock(mutex_);
    run_ = std::move(run);
    ends_ = ends;
    changed_.notify_all();
  }
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ends_ || run_; });
      if (ends_) return;
      lock.unlock();
      run_();
      lock.lock();
      run_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> run_;  // unset: no work
  bool ends_ = false;
  std::thread thread_;
};

// ---- the page of a window without a scene

using sim::Key;
using sim::WindowEvent;

constexpr std::int64_t kMostTicks = 20'000;  // most ticks to the moment of a picture

// Picture of the scene at its first touch.
Image picture_of(const std::string& name, sim::ViewWindow& window, int width, int height) {
  models::Setup setup = models::load(name, {}, {});
  leave_out_vision(setup);
  trial::TrialOptions options;
  options.draw_all = true;
  trial::Trial trial(setup, options);
  while (trial.result().ticks < kMostTicks && trial.tick() && !trial.truth().touching) {
  }
  const Moment moment = moment_of(trial);
  mjData* data = trial.world().physics().data();
  shift_objects(moment, data);
  sim::ViewRequest request = depict(moment, camera_for(moment, false), false);
  request.data = data;
  return window.snap(request, width, height);
}

class Page {
 public:
  explicit Page(sim::ViewWindow& window)
      : window_(window), listed_(models::listed_scenes(models::models_dir())) {
    std::erase_if(listed_, [](const models::ListedScene& scene) { return !scene.mistake.empty(); });
    page_.title = "Encounter: choose a scene (mouse or arrow keys, then Enter; Q ends)";
    for (const models::ListedScene& scene : listed_) page_.tiles.push_back({{}, scene.name});
    if (page_.tiles.empty()) throw no_scenes();
    // Preselect the scene that a newcomer starts with.
    for (std::size_t i = 0; i < listed_.size(); ++i)
      if (listed_[i].name == "tennis_ball") page_.chosen = i;
  }

  std::optional<std::string> run() {
    std::vector<WindowEvent> events;
    bool ends = false;
    std::size_t drawn = 0;
    while (window_.poll(events) && !ends) {
      for (const WindowEvent& event : events) {
        if (see(event, ends)) return listed_[page_.chosen].name;
      }
      page_.line = listed_[page_.chosen].title;
      window_.draw_page(page_);
      if (drawn < listed_.size())
        draw(drawn++);
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
    return {};
  }

 private:
  [[nodiscard]] sim::TileGrid grid() const {
    return {listed_.size(), static_cast<double>(window_.width()), static_cast<double>(window_.height())};
  }
  void draw(std::size_t i) {
    try {
      page_.tiles[i].picture =
          picture_of(listed_[i].name, window_, grid().picture_width(), grid().picture_height());
    } catch (const Error&) {  // the error is shown when the scene is chosen
    }
  }
  void choose(std::ptrdiff_t by) {
    const auto last = static_cast<std::ptrdiff_t>(listed_.size()) - 1;
    const auto wanted = static_cast<std::ptrdiff_t>(page_.chosen) + by;
    if (wanted >= 0 && wanted <= last) page_.chosen = static_cast<std::size_t>(wanted);
  }
  // Returns true if the user starts the chosen scene.
  bool see(const WindowEvent& event, bool& ends) {
    const sim::TileGrid tiles = grid();
    const auto row = static_cast<std::ptrdiff_t>(tiles.columns);
    const std::size_t under = tiles.at(event.x, event.y, listed_.size(), listed_.size());
    if (event.kind == WindowEvent::Kind::move) {
      // The first position of the mouse is not a choice.
      if (moved_ && under < listed_.size()) page_.chosen = under;
      moved_ = true;
    }
    if (event.kind == WindowEvent::Kind::button)
      return event.code == WindowEvent::kLeft && !event.down && under < listed_.size();
    if (event.kind != WindowEvent::Kind::key || !event.down) return false;
    const auto is = [&](Key key) { return event.code == static_cast<std::int32_t>(key); };
    if (is(Key::left)) choose(-1);
    if (is(Key::right)) choose(1);
    if (is(Key::up)) choose(-row);
    if (is(Key::down)) choose(row);
    if (is(Key::escape) || event.code == 'Q') ends = true;
    return is(Key::enter);
  }

  sim::ViewWindow& window_;
  bool moved_ = false;  // the mouse
  std::vector<models::ListedScene> listed_;
  sim::ViewPage page_;
};

// The name of the chosen scene; unset: the window was closed. Pictures are made while the page is shown.
std::optional<std::string> choose_scene(sim::ViewWindow& window) { return Page(window).run(); }

// ---- a run, or a record, in the window

using Wall = std::chrono::steady_clock;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr int kWidth = 1280, kHeight = 720;  // px
constexpr milliseconds kPicture{16};         // between two pictures

// Interval between checks for a new version of the scene file.
constexpr milliseconds kLook{500};
// 4096 stills are 68 s at 60 pictures a second, and take some 60 MB.
constexpr std::size_t kStills = 4096, kSamples = 100'000;

// The next picture is due kPicture after the last one, or at once.
class Pictures {
 public:
  void wait() {
    next_ = std::max(next_ + kPicture, Wall::now());
    std::this_thread::sleep_until(next_);
  }

 private:
  Wall::time_point next_ = Wall::now();
};

// Detects new versions of a scene file, and checks that they can run.
class SceneFile {
 public:
  explicit SceneFile(const RunOptions& options) : options_(options), seen_(written()) {}
  // Returns true if a new version was saved that can run. `message` describes the mistake in one that cannot.
  bool renewed(std::string& message) {
    if (Wall::now() < next_) return false;
    next_ = Wall::now() + kLook;
    const auto now = written();
    if (!now || now == seen_) return false;
    seen_ = now;
    try {
      models::Setup setup = models::load(options_.scene, options_.rig, options_.set);
      const Scene scene = trial::prepare_setup(setup);
      (void)trial::make_world(setup, scene, options_.seed, true);
      return true;
    } catch (const Error& e) {
      message = e.what();
      return false;
    }
  }

 private:
  using FileTime = std::optional<std::filesystem::file_time_type>;
  [[nodiscard]] FileTime written() const {
    std::error_code none;
    const auto time = std::filesystem::last_write_time(models::scene_file_of(options_.scene), none);
    return none ? FileTime() : FileTime(time);
  }
  const RunOptions& options_;
  FileTime seen_;
  Wall::time_point next_ = Wall::now();
};

// Thrown on the run's thread when its window could not be opened.
struct WindowFailure {};

// One run on its own thread.
class Run {
 public:
  Run(const RunOptions& options, RunThread& thread) : options_(options), thread_(thread) {
    hooks_.adapts = [](models::Setup& setup) {
      const bool drawn = setup.scene.camera && setup.rig.camera.driver == "sim";
      if (drawn && !module_there("vision")) leave_out_vision(setup);
    };
    hooks_.begins = [this](trial::Trial& trial) { begin(trial); };
    hooks_.ends = [this] { link_.wait_for_close(); };
    hooks_.watch = [this](const trial::Glance& glance) {
      link_.see(glance);
      feed_->see(glance);
      if (cameras_) cameras_->see();
    };
    hooks_.look = [this](const Measurement<StereoFrame>& frame) {
      if (cameras_) cameras_->look(frame);
    };
    hooks_.stop = [this] { return link_.ends(); };
    hooks_.waits = [this] {
      if (!link_.waits(dt_)) return false;
      feed_->catch_up();
      return true;
    };
    hooks_.hand = [this] { return link_.machine(); };
    hooks_.steer = [this](std::int64_t) { return link_.hand(); };
    thread_.begin([this] {
      try {
        code_ = app::run(options_, &hooks_);
      } catch (const WindowFailure&) {  // the window's thread reports it
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
  [[nodiscard]] CameraFeed* cameras() { return cameras_ ? &*cameras_ : nullptr; }
  [[nodiscard]] trial::Trial& trial() { return *trial_; }
  [[nodiscard]] bool real() const { return real_; }
  // Ends the run and waits until its record is sealed and its report is printed.
  void join() {
    link_.end();
    link_.let_go();
    link_.closed();
    thread_.wait();
  }
  // The exit code; rethrows the run's exception.
  int code() {
    join();
    if (failed_) std::rethrow_exception(failed_);
    return code_;
  }

 private:
  void begin(trial::Trial& trial) {
    if (!trial.has_world())
      throw Error(
          "no device of this rig is simulated, so there is nothing to draw; expected a rig with a "
          "simulated "
          "device, such as the display; use encounter run");
    real_ = trial.result().keeps_wall_time || trial::moves_device(trial.setup());
    dt_ = trial.scene().dt;
    trial_ = &trial;
    feed_.emplace(trial);
    if (trial.setup().scene.camera && trial.setup().rig.camera.driver == "sim") cameras_.emplace(trial);
    if (!link_.begin(trial.result().keeps_wall_time)) throw WindowFailure{};
  }

  RunOptions options_;
  RunWindow hooks_;
  Link link_;
  std::optional<Feed> feed_;
  std::optional<CameraFeed> cameras_;
  trial::Trial* trial_ = nullptr;
  bool real_ = false;
  double dt_ = 1e-3;
  int code_ = 0;
  std::exception_ptr failed_;
  RunThread& thread_;
};

// Shows a run until it ends or the window is closed. Returns true if the user wants a restart.
bool show_run(Run& run, Show& show, sim::ViewWindow& window, SceneFile* file) {
  Feed& feed = run.feed();
  Link& link = run.link();
  std::vector<sim::WindowEvent> news, events;  // kept until there is a still to show
  Pictures pictures;
  std::string message;
  while (!link.ended()) {
    if (!window.poll(news)) link.end();
    events.insert(events.end(), news.begin(), news.end());
    if (feed.take() && feed.newest().still.now.t != Time{}) show.add(feed.newest().still);
    for (ChartSample one; feed.next(one);) show.add(one);
    if (show.empty()) {
      std::this_thread::sleep_for(milliseconds(2));
      continue;
    }
    if (link.take_event()) show.controls().paused_at_event();
    const RunRequests wishes = show.see(events);
    events.clear();
    link.wish(wishes);
    if (wishes.restarts || (file != nullptr && file->renewed(message))) {
      link.end();
      return true;
    }
    if (CameraFeed* cameras = run.cameras()) {
      cameras->want(show.shows(Controls::Insets::pair), show.shows(Controls::Insets::augmented));
      if (auto made = cameras->take()) show.add(std::move(*made));
    }
    show.say(message);
    show.draw(wishes, &feed.newest().status);
    pictures.wait();
  }
  return false;
}

// Gives the loop precedence over drawing: this thread, and its threads for OpenGL, take a lower priority.
void yield() {
  constexpr int kNice = 10;
  // On failure it only competes with the loop.
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

// Clears the pointer to a run when the run is gone.
struct RunGuard {
  Run*& run;
  ~RunGuard() { run = nullptr; }
};

// Shows how much of a record is read. Returns false if the user cancels.
bool show_reading(double ticks, double all, Show& show, sim::ViewWindow& window) {
  std::vector<sim::WindowEvent> events;
  if (!window.poll(events)) return false;
  const RunRequests wishes = show.see(events);
  if (wishes.ends) return false;
  show.say(fmt::format("reading the record: {:.0f} %", 100.0 * ticks / all));
  show.draw(wishes, nullptr);
  return true;
}

// Plays the record from its beginning, under the user's control, until the window is closed.
void play(Show& show, sim::ViewWindow& window) {
  std::vector<sim::WindowEvent> events;
  Pictures pictures;
  show.timeline().seek(0.0);
  Wall::time_point before = Wall::now();
  while (window.poll(events)) {
    RunRequests wishes = show.see(events);
    if (wishes.ends) break;
    const Wall::time_point now = Wall::now();
    if (wishes.to_event) {
      show.timeline().to_change();
      show.controls().paused_at_event();
    } else if (!wishes.paused) {
      show.timeline().go_on(wishes.speed * duration<double>(now - before).count());
    }
    before = now;
    show.draw(wishes, nullptr);
    pictures.wait();
  }
}

// Shows a record until the window is closed.
int show_record(const std::string& path, const sim::WindowModule& module) {
  Playback playback(path);
  print_notes(playback.setup().notes);
  const auto window = module.open("Encounter: " + path, kWidth, kHeight, [] {
    fmt::print(stderr, "encounter: the display is lost\n");
    std::fflush(nullptr);
  });
  const std::int64_t each =
      std::max<std::int64_t>(10, playback.ticks() / static_cast<std::int64_t>(kStills) + 1);
  const auto samples = static_cast<std::size_t>(playback.ticks() / Sampler::kEach + 1);
  Show show(playback.trial(), *window,
            {Controls::RunKind::record, true, false, static_cast<std::size_t>(playback.ticks() / each + 2),
             samples});
  Sampler sampler;
  RunSnapshot still;
  std::int64_t ticks = 0;
  const auto see = [&](const trial::Glance& glance) {
    const ChartSample sample = sampler.sample(glance);
    if (ticks % Sampler::kEach == 0) show.add(sample);
    if (ticks % each == 0 || ticks + 1 == playback.ticks()) {
      take_still(playback.trial(), glance, playback.simulated(), still);
      show.add(still);
    }
    ++ticks;
  };
  Wall::time_point looked = Wall::now();
  while (playback.next(see)) {
    if (ticks % 100 != 0 || Wall::now() - looked < kLook) continue;
    if (!show_reading(static_cast<double>(ticks), static_cast<double>(playback.ticks()), show, *window))
      return 0;
    looked = Wall::now();
  }
  show.say(playback.doubt());
  play(show, *window);
  return 0;
}

// Restarts the run when its scene file is saved, unless it moves a machine or is recorded. Returns true if
// the user wants a restart.
bool show_live(Run& run, sim::ViewWindow& window, bool recording, SceneFile& file) {
  Show show(run.trial(), window,
            {run.real() ? Controls::RunKind::real : Controls::RunKind::simulated, recording,
             run.cameras() != nullptr, kStills, kSamples});
  return show_run(run, show, window, run.real() || recording ? nullptr : &file);
}

// Returns false if the user chose no scene.
bool let_choose(sim::ViewWindow& window, ViewOptions& options) {
  const auto chosen = choose_scene(window);
  if (!chosen) return false;
  options.scene = *chosen;
  window.set_title("Encounter: " + options.scene);
  return true;
}

}  // namespace

int window(const ViewOptions& asked) {
  const auto* module = static_cast<const sim::WindowModule*>(load_module("window").window);
  module->look();
  ViewOptions options = asked;
  if (is_record(options.scene)) return show_record(options.scene, *module);
  RunThread thread;
  Run* shown = nullptr;
  const auto lost = [&shown] {
    if (shown != nullptr) shown->join();
    fmt::print(stderr, "encounter: the display is lost{}\n",
               shown != nullptr ? "; the run was ended, its record is whole" : "");
    std::fflush(nullptr);
  };
  std::unique_ptr<sim::ViewWindow> window;
  if (options.scene.empty()) {
    window = module->open("Encounter", kWidth, kHeight, lost);
    if (!let_choose(*window, options)) return 0;
  }
  SceneFile file(options);
  for (;;) {
    Run run(options, thread);
    if (!run.link().wait_for_begin()) return run.code();
    shown = &run;
    const RunGuard forget{shown};
    if (!run.real()) yield();  // a real machine's run keeps its priority: the stop key must never wait
    try {
      if (!window) window = module->open("Encounter: " + options.scene, kWidth, kHeight, lost);
    } catch (...) {
      run.link().refuse();
      throw;
    }
    run.link().let_go();
    const bool again = show_live(run, *window, !options.record.empty(), file);
    if (!again) window.reset();
    const int code = run.code();
    if (!again) return code;
  }
}

}  // namespace enc::app
