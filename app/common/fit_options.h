// What the command line said to `fit`, `calibrate` and `shadow`: a part of options.h.
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
  // The ball behind the loops instead of a response.
  bool ball = false, json = false;
  std::vector<std::string> hold, free;  // "wall_mm=3.4", "wall_mm"
};
struct CalibrateOptions {
  std::string log;             // a tracker's log, a swung tool's poses, points, a rig, or a folder of images
  std::optional<double> rate;  // Hz, of the rows, as expected
  bool pivot = false;          // of a table that is a tracker's log and has poses, too: these are meant
  bool json = false;
  // Of a rig: the guided procedure.
  std::string out;
  bool force = false;
  std::optional<std::size_t> pairs, frames;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;
  bool through_images = false;  // the tip is found in pictures; else it is seen as a point
  // Of a rig with a hexapod, with `out`, `force`, `seed` and `set`.
  std::string scene;  // whose clamped tool is carried; empty: clamped_tool
  std::optional<std::size_t> poses;
  bool armed = false, lockstep = false, yes = false, not_real_time = false;
  std::function<void()> catch_signals{};  // from here on stop() reports them
  std::function<bool()> stop{};
  // Asks, unless there is nothing to ask, and reads keys from then on; false: the machine must not move.
  std::function<bool(const std::string& question)> confirm{};
  // Of a folder of images, with `out`, `force` and `json`.
  std::optional<double> square_mm;
  std::optional<std::string> corners;  // "9x6"
  std::string picture;
  std::string skin;  // a folder of masks of hands: the images are of hands, not of a board
};
struct ShadowOptions {
  std::string record;
  std::vector<std::string> set;  // of the twin, "name=value"
  bool partial = false, json = false;
};

}  // namespace enc::app
