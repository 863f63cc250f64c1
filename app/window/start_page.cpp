#include "app/window/start_page.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "app/view/moment/depict.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/setup/scene_names.h"

namespace enc::app {
namespace {

using sim::Key;
using sim::WindowEvent;

constexpr std::int64_t kMostTicks = 20'000;  // until the moment of a picture

// The scene at its first touch.
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
    if (page_.tiles.empty())
      throw Error(
          fmt::format("{}/scenes: there are no scenes; expected the models of Encounter; see to "
                      "ENCOUNTER_MODELS, or leave it unset",
                      models::models_dir()));
    // First the scene that a newcomer should press.
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
    } catch (const Error&) {  // it says so when it is chosen
    }
  }
  void choose(std::ptrdiff_t by) {
    const auto last = static_cast<std::ptrdiff_t>(listed_.size()) - 1;
    const auto wanted = static_cast<std::ptrdiff_t>(page_.chosen) + by;
    if (wanted >= 0 && wanted <= last) page_.chosen = static_cast<std::size_t>(wanted);
  }
  // True: the chosen scene is wanted.
  bool see(const WindowEvent& event, bool& ends) {
    const sim::TileGrid tiles = grid();
    const auto row = static_cast<std::ptrdiff_t>(tiles.columns);
    const std::size_t under = tiles.at(event.x, event.y, listed_.size(), listed_.size());
    if (event.kind == WindowEvent::Kind::move) {
      // Where the mouse is at first is nobody's choice.
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

}  // namespace

std::optional<std::string> choose_scene(sim::ViewWindow& window) { return Page(window).run(); }

}  // namespace enc::app
