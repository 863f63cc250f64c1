#include "benchmarks/vishap/vishap.h"

namespace enc::bench::vishap {
namespace {

void run(Bench& bench) {
  add_whole_stack(bench);
  add_device_removal(bench);
}

const Entry kEntry{"vishap", "camera/wall", "the whole stack of VisHap: a finger that is seen meets the prop",
                   run};

}  // namespace
}  // namespace enc::bench::vishap
