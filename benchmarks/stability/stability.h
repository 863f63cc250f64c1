// Parts of the benchmark `stability`: the certificate's predictions beside what MuJoCo does.
#pragma once

#include "benchmarks/kit/kit.h"
#include "benchmarks/stability/slide.h"
#include "core/control/safety/certificate/certificate.h"

namespace enc::bench::stability {

// What the certificate is told of a device.
[[nodiscard]] certificate::SampledLoop loop_of(const Device& device);
[[nodiscard]] certificate::Steps steps_of(const Device& device);

// What MuJoCo does, in the certificate's words.
[[nodiscard]] certificate::Rest same_as(Outcome outcome);

// What was foretold of places, beside what became of them. What either does not know is not foretold.
struct Agreement {
  double places = 0.0, rest = 0.0, same = 0.0;  // rest: whether it rests; same: limit cycles told apart, too
  void see(certificate::Rest told, certificate::Rest seen);
};

// The larger of two; NaN where one is.
[[nodiscard]] double worse(double a, double b);

void add_linear_cases(Bench& bench);  // critical stiffness, its error, Gil and Hulin's
void add_integrators(Bench& bench);   // what each does to the boundary
void add_passivity(Bench& bench);     // what a wall gives out, with the core's controller in its loop
void add_spare(Bench& bench);         // the same of the hexapod, in the twin
void add_regions(Bench& bench);       // with friction and counts: damping x delay, and a map
void add_scenes(Bench& bench);        // the certificates of what ships

}  // namespace enc::bench::stability
