// Scene, rig, behaviours, response, directions, --set: read and checked as for a run, and what is accepted is
// written and read again.
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/directions/directions.h"
#include "models/setup/driver_table.h"
#include "models/setup/scene_file.h"
#include "tests/fuzz/machine/target.h"
#include "tests/fuzz/targets/seeds.h"
#include "tests/support/variable.h"
#include "trial/assemble/prepare.h"

namespace enc::fuzz {
namespace {

using models::Setup;

const Folder& model_folder() {
  static const ModelsFolder kFolder;
  return kFolder;
}

// What step() needs can be made of it, and as a text it is itself again.
bool sane(const Setup& setup) {
  static_cast<void>(trial::prepare_setup(setup));
  const std::string text = models::resolved(setup);
  std::string again;
  try {
    again = models::resolved(models::parse_resolved(text, "resolved"));
  } catch (const Error& e) {
    throw Broken(fmt::format("what is written of it is refused: {}", e.what()));
  }
  expect(again == text, "what is written of it is read as another");
  return true;
}

Target scene() {
  Target target;
  for (const char* name : {"tennis_ball", "wall", "keypad", "session", "rig_A", "rig_identify", "tracking",
                           "two_objects", "reaching", "synchrony", "camera/wall"})
    target.seeds.push_back(file_text(fmt::format("models/scenes/{}.toml", name)));
  target.seeds.push_back(mesh_scene());
  target.seeds.push_back(file_text("tests/golden/tennis_ball.resolved.toml"));
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    return sane(models::load(model_folder().write("scenes/fuzz.toml", input), ""));
  };
  target.inputs = 700;
  return target;
}

Target rig() {
  Target target;
  target.seeds = file_texts("models/rigs", ".toml");
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    const std::string path = model_folder().write("rigs/fuzz.toml", input);
    static_cast<void>(models::load_rig_setup(path));
    const bool arm = input.find("\n[arm]") != std::string::npos;
    return sane(
        models::load(model_folder().path(arm ? "scenes/wall.toml" : "scenes/tennis_ball.toml"), path));
  };
  target.inputs = 500;
  return target;
}

Target behaviours() {
  Target target;
  target.seeds = {file_text("models/behaviours.toml")};
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    static const ModelsFolder kOwn;
    kOwn.write("behaviours.toml", input);
    const test::Variable models("ENCOUNTER_MODELS", kOwn.path(""));
    return sane(models::load(kOwn.path("scenes/two_objects.toml"), ""));
  };
  target.inputs = 500;
  return target;
}

Target response() {
  Target target;
  target.seeds = file_texts("models/responses", ".toml");
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    static const ModelsFolder kOwn;
    const ResponseSpec read = models::load_response(kOwn.write("responses/tennis_ball.toml", input));
    const std::string text = models::response_text(read, "fuzz");
    kOwn.write("responses/again.toml", text);
    expect(models::response_text(models::load_response(kOwn.path("responses/again.toml")), "fuzz") == text,
           "what is written of it is read as another");
    const test::Variable models("ENCOUNTER_MODELS", kOwn.path(""));
    return sane(models::load(kOwn.path("scenes/tennis_ball.toml"), ""));
  };
  target.inputs = 500;
  return target;
}

Target directions() {
  Target target;
  target.seeds = file_texts("models/directions", ".toml");
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    const std::vector<models::Direction> all = models::read_directions(input, "fuzz.toml");
    double sum = 0.0;
    for (const double weight : models::weights(all, {0.2, 0.1})) {
      expect(weight >= 0.0, fmt::format("a weight is {}", weight));
      sum += weight;
    }
    expect(std::abs(sum - 1.0) < 1e-9, fmt::format("the weights are {} together", sum));
    return true;
  };
  return target;
}

Target set() {
  Target target;
  target.seeds = {"object.ball.radius_mm=30",
                  "truth.tracker.bias_mm=[0,0,0.3]",
                  "rig.force.filter_hz=20",
                  "behaviour.tennis_ball.response=tennis_ball_B",
                  "rig.tracker.driver=sample",
                  "rig.driver.sample.rate_Hz=100",
                  "title=\"a\"",
                  "object.ball.shape=sphere",
                  "user.depth_mm=unset"};
  target.tokens = toml_tokens();
  target.run = [](const std::string& input) {
    static const Setup kSetup = models::load(model_folder().path("scenes/tennis_ball.toml"), "");
    Setup setup = kSetup;
    models::set(setup, input);
    models::settle_drivers(setup);
    models::check(setup);
    return sane(setup);
  };
  return target;
}

const Offer kScene("scene", &scene), kRig("rig", &rig), kBehaviours("behaviours", &behaviours),
    kResponse("response", &response), kDirections("directions", &directions), kSet("set", &set);

}  // namespace
}  // namespace enc::fuzz
