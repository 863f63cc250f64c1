// One run of a sweep in this process, and its line in the results.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "models/setup/scene_file.h"
#include "trial/certificates.h"
#include "trial/sweep/design.h"
#include "trial/sweep/spec.h"

namespace enc::app {

class SweepRunner {
 public:
  explicit SweepRunner(const trial::SweepSpec& spec) : spec_(spec), design_(spec) {}
  SweepRunner(const SweepRunner&) = delete;
  SweepRunner& operator=(const SweepRunner&) = delete;

  // Throws Error with the place if a kept measure is none of this scene's runs.
  void check_measures();
  // Runs it. An error of the run is in the line.
  [[nodiscard]] std::string line(std::int64_t run);
  // The line of a run whose process was killed `times` times by a signal.
  [[nodiscard]] std::string line_of_killed(std::int64_t run, int signal, int times) const;

 private:
  // Set-up and certificates of a point, prepared once for all of its seeds.
  struct PreparedPoint {
    std::int64_t point = -1;
    models::Setup setup;
    std::optional<std::vector<trial::ObjectCertificate>> certificates;
  };
  void prepare(std::int64_t point);

  const trial::SweepSpec& spec_;
  trial::Design design_;
  PreparedPoint now_;
};

// The scene of a sweep with these values of its axes (none: as its files are), loaded as `run --set` does.
// Throws Error if a device is real.
[[nodiscard]] models::Setup sweep_setup(const trial::SweepSpec& spec, const std::vector<std::string>& values);

}  // namespace enc::app
