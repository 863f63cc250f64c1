// MuJoCo behind RAII. The only file that includes <mujoco/mujoco.h>.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/base/frames.h"

namespace enc::sim {

struct MjDelete {
  void operator()(mjSpec* s) const { mj_deleteSpec(s); }
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};
using SpecPtr = std::unique_ptr<mjSpec, MjDelete>;
using ModelPtr = std::unique_ptr<mjModel, MjDelete>;
using DataPtr = std::unique_ptr<mjData, MjDelete>;

// A compiled model with its data. Autoreset is off: a divergence stays visible instead of causing a silent
// restart.
class Physics {
 public:
  // Throws Error with MuJoCo's own message if the spec does not compile.
  explicit Physics(SpecPtr spec);

  [[nodiscard]] mjModel* model() const { return model_.get(); }
  [[nodiscard]] mjData* data() const { return data_.get(); }
  // One step. Returns false from the first step whose state is unreliable: MuJoCo counted a warning, or a
  // number is not finite.
  bool step() {
    mj_step(model_.get(), data_.get());
    ++steps_;
    unsolved_ += solved() ? 0 : 1;
    return !warned();
  }
  // Number of steps, and of steps whose contacts did not reach the tolerance within the solver's iterations.
  // For a step with several stages (RK4) the last one counts.
  [[nodiscard]] std::int64_t steps() const noexcept { return steps_; }
  [[nodiscard]] std::int64_t unsolved() const noexcept { return unsolved_; }
  [[nodiscard]] bool warned() const noexcept {
    int count = 0;
    for (const mjWarningStat& w : data_->warning) count += w.number;
    return count != 0;
  }
  [[nodiscard]] std::string warning_text() const;
  // Number of bodies, joints, geoms, sites, sensors, actuators, tendons and equalities that the scene caused.
  [[nodiscard]] int elements() const {
    const mjModel& m = *model_;
    return m.nbody + m.njnt + m.ngeom + m.nsite + m.nsensor + m.nu + m.ntendon + m.neq;
  }
  [[nodiscard]] std::string xml() const;                      // its MJCF, for MuJoCo's own programs
  [[nodiscard]] int id(mjtObj type, const char* name) const;  // throws Error if missing

  [[nodiscard]] std::vector<double> save() const;
  void restore(const std::vector<double>& state);

 private:
  [[nodiscard]] bool solved() const noexcept;

  SpecPtr spec_;
  ModelPtr model_;
  DataPtr data_;
  std::int64_t steps_ = 0, unsolved_ = 0;
};

// MuJoCo's classic renderer and its scene, drawing into the current OpenGL context: into its window, or off
// the screen. Frees both, the drawing context first, while OpenGL's still exists.
struct Renderer {
  mjvScene scene;
  mjrContext context;

  // `room`: most geoms. `width`, `height`: px off the screen; 0: into the window.
  Renderer(const mjModel* model, int room, mjtFontScale letters, int width, int height) {
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_makeScene(model, &scene, room);
    mjr_makeContext(model, &context, letters);
    const bool off_screen = width > 0 && height > 0;
    if (off_screen) mjr_resizeOffscreen(width, height, &context);
    mjr_setBuffer(off_screen ? mjFB_OFFSCREEN : mjFB_WINDOW, &context);
  }
  ~Renderer() {
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
};

// Sets three numbers of a MuJoCo array.
inline void set3(double* to, const Vec3& v) noexcept { std::copy_n(v.data(), 3, to); }

// Process-wide. Without them mju_error would end the program with code 1, which means "the answer is no"
// (sources/twin 4).
void install_mujoco_handlers();
[[nodiscard]] std::string mujoco_version();
// The reason why MuJoCo of this version (4000001 is 4.0.1) is not allowed, and the remedy; empty: allowed.
[[nodiscard]] std::string mujoco_problem(int version = mj_version());

}  // namespace enc::sim
