#include "sim/bodies/mujoco.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/error.h"

namespace enc::sim {
namespace {

[[noreturn]] void on_error(const char* text) {
  throw Error(std::string("MuJoCo: ") + text, {}, ErrorKind::device);
}
void on_warning(const char*) {
}  // step() reads the counters in mjData; nothing is printed or written to a file

// A step works in an arena of megabytes: contacts from its start, temporary values from its end. Touch the
// pages now, so that the first contact does not wait for one. Shipped scenes use 18 kB.
void touch_arena(mjData& data) {
  constexpr std::size_t kUsed = 64 * 1024;  // bytes, at either end
  auto* arena = static_cast<std::byte*>(data.arena);
  const auto size = static_cast<std::size_t>(data.narena);
  const std::size_t part = std::min(kUsed, size / 2);
  std::fill_n(arena, part, std::byte{0});
  std::fill_n(arena + (size - part), part, std::byte{0});
}

}  // namespace

void install_mujoco_handlers() {
  // The first thread installs them, once; worlds run side by side.
  [[maybe_unused]] static const bool installed = [] {
    mju_user_error = on_error;
    mju_user_warning = on_warning;
    return true;
  }();
}

std::string mujoco_version() { return mj_versionString(); }

std::string mujoco_problem(int version) {
  if (version / 1'000'000 != 4) return "version 4 is needed; run ./encounter once more, it fetches it";
  // MuJoCo's issue 3767: rows of a sparse constraint Jacobian wrongly share a block of the Cholesky factor.
  if (version == 4'000'000)
    return "its solver factors a wrong Hessian, mended in 4.0.1; unset ENCOUNTER_MUJOCO or point it to a "
           "later "
           "one, and run ./encounter once more";
  return {};
}

Physics::Physics(SpecPtr spec) : spec_(std::move(spec)) {
  install_mujoco_handlers();
  if (const std::string problem = mujoco_problem(); !problem.empty())
    throw Error("MuJoCo " + mujoco_version() + ": " + problem);
  spec_->option.disableflags |= mjDSBL_AUTORESET;
  model_.reset(mj_compile(spec_.get(), nullptr));
  if (!model_) {
    std::string why = mjs_getError(spec_.get());
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw Error("the simulated world does not compile: " + why, "truth");
  }
  data_.reset(mj_makeData(model_.get()));
  if (!data_) throw Error("not enough memory for the simulated world");
  touch_arena(*data_);
}

// False if the solver used its last iteration without reaching the tolerance. The statistics of the pass
// against creep follow those of the solver, with a gradient of 0. Without a tolerance every solution counts.
bool Physics::solved() const noexcept {
  const mjOption& option = model_->opt;
  if (!(option.tolerance > 0.0)) return true;
  const int islands = std::clamp(data_->nisland, 1, static_cast<int>(mjNISLAND));
  for (int i = 0; i < islands; ++i) {
    const int most = option.iterations;
    if (data_->solver_niter[i] < most) continue;
    if (most > mjNSOLVER) {  // MuJoCo keeps no statistics beyond this number
      if (data_->solver_niter[i] >= most + option.noslip_iterations) return false;
      continue;
    }
    const mjSolverStat& last = data_->solver[i * mjNSOLVER + most - 1];
    if (last.improvement >= option.tolerance && last.gradient >= option.tolerance) return false;
  }
  return true;
}

std::string Physics::warning_text() const {
  std::string text;
  for (int i = 0; i < mjNWARNING; ++i) {
    if (data_->warning[i].number == 0) continue;
    if (!text.empty()) text += "; ";
    text += mju_warningText(i, static_cast<std::size_t>(data_->warning[i].lastinfo));
  }
  return text;
}

std::string Physics::xml() const {
  std::array<char, 500> why{};
  const int size = mj_saveXMLString(spec_.get(), nullptr, 0, why.data(), static_cast<int>(why.size()));
  std::string text(static_cast<std::size_t>(std::max(size, 0)) + 1, '\0');
  if (mj_saveXMLString(spec_.get(), text.data(), static_cast<int>(text.size()), why.data(),
                       static_cast<int>(why.size())) != 0)
    throw Error(std::string("the simulated world has no MJCF: ") + why.data());
  text.resize(text.find('\0'));
  return text;
}

int Physics::id(mjtObj type, const char* name) const {
  const int found = mj_name2id(model_.get(), type, name);
  if (found < 0) throw Error(std::string("the simulated world has no '") + name + "'");
  return found;
}

std::vector<double> Physics::save() const {
  std::vector<double> state(static_cast<std::size_t>(mj_stateSize(model_.get(), mjSTATE_INTEGRATION)));
  mj_getState(model_.get(), data_.get(), state.data(), mjSTATE_INTEGRATION);
  return state;
}

void Physics::restore(const std::vector<double>& state) {
  mj_setState(model_.get(), data_.get(), state.data(), mjSTATE_INTEGRATION);
  for (mjWarningStat& warning : data_->warning) warning = {};  // the restored state starts without warnings
}

}  // namespace enc::sim
