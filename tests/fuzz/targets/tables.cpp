// Tables: loops of `fit`, points of `calibrate`, logs of a tracker. What is accepted holds finite numbers.
#include <cmath>
#include <regex>

#include <fmt/format.h>

#include "models/identify/camera/point_set.h"
#include "models/identify/response/loop_csv.h"
#include "models/identify/tip/pivot_log.h"
#include "models/identify/tracker/tracker_log.h"
#include "models/mesh_files/mesh_places.h"
#include "tests/fuzz/machine/target.h"

namespace enc::fuzz {
namespace {

const std::vector<std::string>& csv_tokens() {
  static const std::vector<std::string> kAll{",",     ",,",          ";",      "\"",     "#",
                                             "# a\n", " ",           "time_s", "repeat", "source",
                                             "pair",  "tool_time_s", "0.5,",   "1e-9",   "1e9"};
  return kAll;
}
void expect_finite(const Vec3& v, const char* what) {
  expect(v.allFinite(), fmt::format("{} is not finite", what));
}

// Two presses to 6 mm and back.
Target loop() {
  Target target;
  std::string text = "# a loop\ntime_s,deflection_mm,force_N,repeat,source\n";
  for (int press = 0; press < 2; ++press)
    for (int i = 0; i <= 60; ++i) {
      const double d = 0.2 * std::min(i, 60 - i);
      text += fmt::format("{:.2f},{:.3f},{:.4f},{},rig\n", press * 7 + 0.1 * i, d, (i <= 30 ? 1.2 : 1.0) * d,
                          press + 1);
    }
  target.seeds = {text, "time_s,deflection_mm,force_N,repeat\n0,0,,\n1,1,1,1\n"};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    const models::LoopData read = models::parse_loop(input, "fuzz.csv", 6e-3);
    expect(!read.presses.empty() && read.presses.size() == read.moving.size(), "it has no presses");
    for (const auto& press : read.presses)
      for (const models::LoopPoint& p : press)
        expect(std::isfinite(p.deflection) && p.deflection > 0.0 && std::isfinite(p.force),
               "a reading is not finite");
    return true;
  };
  return target;
}

Target points() {
  Target target;
  std::string one = "camera_x_m,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m\n";
  std::string frames = "camera_x_m,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m,pair\n";
  for (int i = 0; i < 8; ++i) {
    const double x = 0.03 * (i % 2), y = 0.05 * (i / 2 % 2), z = 0.5 + 0.04 * (i / 4);
    one += fmt::format("{},{},{},{},{},{}\n", x, y, z, 0.1 + z, 0.2 - x, 0.3 - y);
    for (int k = 0; k < 2; ++k)
      frames += fmt::format("{},{},{},{},{},{},{}\n", x + 1e-4 * k, y, z, 0.1 + z, 0.2 - x, 0.3 - y, i);
  }
  target.seeds = {one, frames};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    static_cast<void>(models::is_point_set(input));
    const models::PointSet places = models::parse_points(input, "fuzz.csv");
    for (const models::SeenPlace& place : places)
      for (const models::PointPair& frame : place.frames) {
        expect_finite(frame.camera.e(), "a place");
        expect_finite(frame.device.e(), "a place");
      }
    const models::Registration found = models::register_points(models::averages(places));
    expect_finite(found.X_WC.p(), "the camera's pose");
    const models::PointSet again = models::parse_points(models::points_text(places), "again.csv");
    expect(again.size() == places.size(), "what is written of it has another number of places");
    return true;
  };
  return target;
}

Target tracker_log() {
  Target target;
  const std::string head = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm";
  std::string sparse = "# a rig\n" + head + "\n", full = head + ",tool_time_s\n";
  for (int n = 0; n < 120; ++n) {
    sparse += fmt::format("{:.3f},{:.3f},0,0,", n * 1e-3, n * 1e-3) +
              (n % 10 == 0 ? fmt::format("{:.3f},0.1,0\n", n * 1e-3) : ",,\n");
    full += fmt::format("{:.3f},{},0,0,{},0,0,{:.3f}\n", n * 1e-3, n, n / 8, n / 8 * 8e-3);
  }
  target.seeds = {sparse, full};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    const models::TrackerLog log = models::parse_tracker_log(input, "fuzz.csv");
    expect(log.time.size() == log.tip.size() && log.time.size() >= 2, "it has too few rows");
    expect(log.period > 0.0 && std::isfinite(log.period), "its period is no time");
    expect(log.packet_period > 0.0 && std::isfinite(log.packet_period),
           "the period of its packets is no time");
    const models::TipPath path(log);
    for (const models::TrackerPacket& packet : log.packets) {
      expect_finite(packet.tool, "a packet");
      if (path.knows(packet.time)) expect_finite(path.velocity(packet.time), "a velocity");
    }
    return true;
  };
  return target;
}

// 6 s of a pen that swings about its tip.
Target pivot_log() {
  Target target;
  const std::string columns = "time_s,tool,P_x_mm,P_y_mm,P_z_mm,P_qx,P_qy,P_qz,P_qw";
  for (const char* prefix : {"tool", "markers"}) {
    std::string text = std::regex_replace(columns, std::regex("P"), prefix) + "\n";
    for (int n = 0; n < 60; ++n) {
      const double x = 0.3 * std::sin(0.4 * n), y = 0.3 * std::sin(0.3 * n + 1.0);
      const double w = std::sqrt(1.0 - x * x - y * y);
      text += fmt::format("{:.1f},pen,{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},0,{:.6f}\n", 0.1 * n, 200 * w * y,
                          -200 * w * x, 200 * w * w, x, y, w);
    }
    target.seeds.push_back(text);
  }
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    static_cast<void>(models::is_pivot_log(input));
    const models::PivotLog log = models::parse_pivot_log(input, "fuzz.csv");
    for (const models::PivotPose& pose : log.poses)
      expect(pose.X_CT.valid() && std::isfinite(pose.time), "a pose is none");
    const models::PivotFit fit = models::fit_pivot(log.poses);
    expect(fit.point().finite() && fit.dimple.finite() && std::isfinite(fit.rms), "the tip is not finite");
    for (const models::Interval& axis : fit.tip)
      expect(std::isfinite(axis.half), "an interval is not finite");
    return true;
  };
  return target;
}

Target places() {
  Target target;
  target.seeds = {"x_m,y_m,z_m\n0,0,0\n1,-2.5,3e-2\r\n+4,5,6\n\n"};
  target.tokens = csv_tokens();
  target.run = [](const std::string& input) {
    for (const Vec3& place : models::parse_places(input, "fuzz.csv"))
      expect(place.allFinite() && place.cwiseAbs().maxCoeff() <= 1e6, "a place is too far away");
    return true;
  };
  return target;
}

const Offer kPlaces("places", &places);
const Offer kLoop("loop", &loop), kPoints("points", &points), kTrackerLog("tracker_log", &tracker_log);
const Offer kPivotLog("pivot_log", &pivot_log);

}  // namespace
}  // namespace enc::fuzz
