// The window's view of a run or a record: the picture of a moment, status, charts, the bar of time. It turns
// events into requests, and carries out those that concern only the picture.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "app/window/controls.h"
#include "app/window/feed.h"
#include "app/window/history/history.h"
#include "sim/window/window.h"
#include "trial/operator/run_watch.h"

namespace enc::app {

class Show {
 public:
  struct ShowOptions {
    Controls::RunKind of = Controls::RunKind::simulated;
    bool recording = false;        // a restart would replace the record
    bool cameras = false;          // the scene's camera has images
    std::size_t most_stills = 0;   // number of stills kept; the oldest go first
    std::size_t most_samples = 0;  // number of chart samples kept; the oldest go first
  };

  // The trial must have a twin. It and the window must outlive this.
  Show(trial::Trial& trial, sim::ViewWindow& window, const ShowOptions& what);

  void add(const RunSnapshot& still);
  void add(const ChartSample& sample) { charts_.add(sample); }
  void add(CameraFeed::Pictures&& pictures);
  [[nodiscard]] bool shows(Controls::Insets insets) const;  // true for pictures of the present
  [[nodiscard]] Timeline& timeline() { return timeline_; }
  [[nodiscard]] Controls& controls() { return *controls_; }  // valid once there is a still
  [[nodiscard]] bool empty() const { return timeline_.empty(); }
  void say(const std::string& message) {
    message_ = message;
  }  // shown until the next message; empty: no message

  // Handles events in order; returns the wishes for the run. Valid once there is a still.
  [[nodiscard]] RunRequests see(const std::vector<sim::WindowEvent>& events);
  // `status`: status of the present; null for a record.
  void draw(const RunRequests& wishes, const trial::RunStatus* status);

 private:
  using Wall = std::chrono::steady_clock;
  [[nodiscard]] Surroundings around();
  [[nodiscard]] std::optional<Point<'W'>> above(double x, double y);
  [[nodiscard]] std::optional<Point<'W'>> over(int object) const;
  void inset(const Moment& m, sim::ViewRequest& request) const;
  void write(const Moment& m, const RunRequests& wishes, const trial::RunStatus* status,
             sim::ViewRequest& request);
  [[nodiscard]] std::string hand_text(const Moment& m, const RunRequests& wishes);
  [[nodiscard]] std::string time_text(const Moment& m, const RunRequests& wishes);

  trial::Trial& trial_;
  sim::ViewWindow& window_;
  ShowOptions what_;
  sim::DataPtr data_;  // the shown moment
  Timeline timeline_;
  Charts charts_;
  std::optional<Controls> controls_;
  std::string message_;
  CameraFeed::Pictures pictures_;  // newest of each kind
  Wall::time_point paced_from_ = Wall::now();
  double paced_at_ = 0.0, pace_ = 1.0;
};

}  // namespace enc::app
