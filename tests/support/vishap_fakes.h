// `encounter fake fakes_vishap` in a process of its own, at free places: the arm, the cameras and the
// headset.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "hw_drivers/net/socket.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {

class VisHapFakes {
 public:
  // `set` and `seed` are for both programs. Waits until the fakes listen.
  VisHapFakes(bool lockstep, std::vector<std::string> set, const std::string& scene = kScene, int seed = 1)
      : set_(std::move(set)), seed_(std::to_string(seed)), child_(words(lockstep, scene)) {
    std::string text;
    std::array<char, 256> bytes{};
    for (int i = 0; i < 600 && !child_.closed() && text.find("ends with SIGINT") == std::string::npos; ++i)
      text.append(bytes.data(), child_.read(bytes, 100));
    if (text.find("ends with SIGINT") == std::string::npos) throw std::runtime_error("no fakes: " + text);
  }

  // `encounter run` of the scene; `simulated`: the roles that the twin of the run fills.
  [[nodiscard]] tests::Result run(const std::vector<std::string>& simulated,
                                  const std::vector<std::string>& more) const {
    std::vector<std::string> all{"run", kScene, "--rig", "fakes_vishap", "--seed", seed_};
    for (const std::string& role : simulated) all.insert(all.end(), {"--set", "rig." + role + ".driver=sim"});
    put_settings(all, simulated);
    all.insert(all.end(), more.begin(), more.end());
    return tests::run_program(all, {}, 300);
  }
  // A run that must end well, as its JSON object. `stalled`: why a run says nothing, or ""; that run does not
  // count, and is repeated, three runs in all.
  [[nodiscard]] nlohmann::json result(
      const std::vector<std::string>& simulated, std::vector<std::string> more,
      const std::function<std::string(const nlohmann::json&)>& stalled = {}) const {
    more.emplace_back("--json");
    for (int runs = 1;; ++runs) {
      const tests::Result result = run(simulated, more);
      nlohmann::json json = nlohmann::json::parse(result.out, nullptr, false);
      const std::string why = stalled && json.is_object() && runs < 3 ? stalled(json) : "";
      if (why.empty()) {
        EXPECT_EQ(result.code, 0) << result.out << result.err;
        return json;
      }
      std::cout << "asked again: " << why << std::endl;
    }
  }

  inline static const std::string kScene = tests::source_dir() + "/models/scenes/camera/wall.toml";

 private:
  [[nodiscard]] std::vector<std::string> words(bool lockstep, const std::string& scene) {
    const std::string here = "@encounter_" + std::to_string(getpid());
    for (const std::string& place :
         {"phantom.device=127.0.0.1:" + std::to_string(net::bind_udp("127.0.0.1", 0).port()),
          "hand.port=" + std::to_string(net::bind_udp("127.0.0.1", 0).port()), "v4l2.left=" + here + "_left",
          "v4l2.right=" + here + "_right"})
      set_.push_back("rig.driver." + place);
    std::vector<std::string> all{
        tests::program_file(), "fake", "fakes_vishap", "--scene", scene, "--seed", seed_};
    put_settings(all, {});
    if (lockstep) all.emplace_back("--lockstep");
    return all;
  }
  // Settings of a driver without a role would be refused.
  void put_settings(std::vector<std::string>& words, const std::vector<std::string>& simulated) const {
    for (const std::string& one : set_) {
      const auto unused = [&](const std::string& role) {
        const std::string driver = role == "arm" ? "phantom" : role == "camera" ? "v4l2" : "hand";
        return one.starts_with("rig.driver." + driver + ".");
      };
      if (std::none_of(simulated.begin(), simulated.end(), unused)) words.insert(words.end(), {"--set", one});
    }
  }

  std::vector<std::string> set_;
  std::string seed_;
  tests::PipedChild child_;
};

}  // namespace enc::test
