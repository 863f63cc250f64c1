// What becomes of a run whose devices are behind the wires of the laboratory: slower set-points, faults.
#include "benchmarks/kit/kit.h"
#include "benchmarks/wires/parts.h"

namespace enc::bench::wires {
namespace {

void run(Bench& bench) {
  add_cycles(bench);
  add_safety(bench);
  if (!bench.context.quick) add_loop(bench);
  bench.result.note =
      "Cycles and faults in virtual time, through the drivers and their fakes over the wires' own bytes; the "
      "truth "
      "is the twin's." +
      bench.result.note;
}

const Entry kEntry{"wires", "tennis_ball", "devices behind their wires: slower cycles, faults", run};

}  // namespace
}  // namespace enc::bench::wires
