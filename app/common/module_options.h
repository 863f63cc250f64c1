// The options of the subcommands that live in modules: fit, shadow and calibrate.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace enc::app {

struct FitOptions {
  std::vector<std::string> loops;
  std::string out;
  std::string rig = "sim";
  double limit_mm = 6.0;
  std::optional<double> ceiling;  // N/mm
  bool force = false;
  // Fits the ball behind the loops instead of a response.
  bool ball = false, json = false;
  std::vector<std::string> hold, free;  // "wall_mm=3.4", "wall_mm"
};
struct ShadowOptions {
  std::string record;
  std::vector<std::string> set;  // the twin's, "name=value"
  bool partial = false, json = false;
};
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
  // Used for a rig only.
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
