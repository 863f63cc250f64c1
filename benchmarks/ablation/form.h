// A scene with more in it than it needs. Nothing of it may change what the hand feels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "core/record/record.h"
#include "core/record/state_hash.h"
#include "trial/assemble/vision.h"
#include "trial/devices/device_log.h"
#include "trial/run/run_measures.h"
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

// What a run has done, tick for tick, as hashes: what touches, where everything is and what is commanded; and
// all that the core knows and says.
struct Bits {
  std::uint64_t felt = 0, core = 0;
  bool operator==(const Bits&) const = default;
};

// A run of a scene with some of them.
class Form {
 public:
  Form(const BenchContext& context, const std::string& scene, const std::vector<Part>& with, double seconds);
  Form(const Form&) = delete;
  Form& operator=(const Form&) = delete;
  ~Form();

  void run(int ticks);
  [[nodiscard]] Bits bits() const { return {felt_.value, trial_->result().hash}; }
  [[nodiscard]] bool has(Part part) const;
  // Which of its parts did nothing so far, or are off: they would have cost nothing.
  [[nodiscard]] std::vector<Part> idle(const Form& minimal) const;
  [[nodiscard]] std::int64_t touched() const { return touched_; }  // ticks
  [[nodiscard]] int elements() const { return trial_->world().physics().elements(); }
  [[nodiscard]] const models::Setup& setup() const { return setup_; }
  [[nodiscard]] sim::World& world() { return trial_->world(); }

 private:
  void see(const trial::Glance& glance);
  [[nodiscard]] bool works(Part part, const Form& minimal) const;

  std::vector<Part> parts_;
  models::Setup setup_;
  std::unique_ptr<trial::RunMeasures> counts_;
  std::unique_ptr<trial::Trial> trial_;
  trial::DeviceLog log_;
  std::unique_ptr<PoseTracker> vision_;
  int file_ = -1;  // in memory
  std::unique_ptr<RecordWriter> record_;
  Stamped<TrackedTool> unused_;
  std::int64_t ticks_ = 0, touched_ = 0;
  std::int64_t pictures_ = 0, surfaces_ = 0;  // seen by vision; drawn by the display
  Time drawn_{};
  StateHash felt_;
};

}  // namespace enc::bench::ablation
