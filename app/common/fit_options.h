// The options of `fit` and `shadow`: a part of options.h.
#pragma once

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

}  // namespace enc::app
