// The options of `calibrate`, one struct for each subject.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace enc::app {

struct TrackerOptions {
  std::string log;
  std::optional<double> rate;  // Hz, expected rate of the rows
  bool json = false;
};
struct TipOptions {
  std::string log;
  bool json = false;
};
struct CameraOptions {
  std::string what;  // pairs of points, or a rig whose arm is driven
  std::optional<std::uint64_t> seed;
  bool json = false;
  // Rig only.
  std::string out;
  bool force = false;
  std::optional<std::size_t> pairs, frames;
  std::vector<std::string> set;
  bool through_images = false;  // the tip is detected in pictures; otherwise it is a point
};
struct RigOptions {
  std::string rig;
  std::string scene;  // scene with the clamped tool; empty: clamped_tool
  std::optional<std::size_t> poses;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;
  std::string out;
  bool force = false, json = false;
  bool armed = false, lockstep = false, yes = false, not_real_time = false;
  std::function<void()> catch_signals{};  // stop() reports signals from here on
  std::function<bool()> stop{};
  // Asks the operator if necessary, and reads keys from then on; false: the machine must not move.
  std::function<bool(const std::string& question)> confirm{};
};
struct StereoOptions {
  std::string folder;
  std::optional<double> square_mm;
  std::string corners = "9x6";
  std::string out, picture;
  bool force = false, json = false;
};
struct SkinOptions {
  std::string folder, masks;
  std::string out;
  bool force = false, json = false;
};

}  // namespace enc::app
