// A scene with more in it than it needs. Nothing of it may change what the hand feels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "core/record/record.h"
#include "core/record/state_hash.h"
#include "trial/camera/vision.h"
#include "trial/device_log.h"
#include "trial/run_measures.h"
#include "trial/trial.h"

namespace enc::bench::ablation {

// What can be left out of a scene, each with a cost of its own.
enum class Part : std::uint8_t {
  display,   // a device: the headset, and the surface that it draws
  camera,    // images and vision beside the tracker that the scene has: a device, buffers and libraries
  pictures,  // elements of the physics: the bodies, meshes and lights that are only looked at
  features,  // of the physics: contacts and constraints, where nothing can touch
  counts,    // what `run` counts: presses, touches, the energy ledger
  record,    // each tick into a file
};
inline constexpr std::array kParts{Part::display,  Part::camera, Part::pictures,
                                   Part::features, Part::counts, Part::record};
[[nodiscard]] const char* name_of(Part part);
// What the scene leaves out.
[[nodiscard]] std::vector<Part> left_out(const BenchContext& context, const std::string& scene);

// A run of a scene with some of them. What touches, where everything is and what is commanded goes into a
// hash, tick for tick.
class Form {
 public:
  Form(const BenchContext& context, const std::string& scene, const std::vector<Part>& with, double seconds);
  Form(const Form&) = delete;
  Form& operator=(const Form&) = delete;
  ~Form();

  void run(int ticks);
  [[nodiscard]] std::uint64_t felt() const { return felt_.value; }
  [[nodiscard]] int elements() const { return trial_->world().physics().elements(); }
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  [[nodiscard]] sim::World& world() { return trial_->world(); }

 private:
  void see(const trial::Glance& glance);

  models::Setup setup_;
  std::unique_ptr<trial::RunMeasures> counts_;
  std::unique_ptr<trial::Trial> trial_;
  trial::DeviceLog log_;
  std::unique_ptr<PoseTracker> vision_;
  int file_ = -1;  // in memory
  std::unique_ptr<RecordWriter> record_;
  Stamped<TrackedTool> unused_;
  StateHash felt_;
};

}  // namespace enc::bench::ablation
