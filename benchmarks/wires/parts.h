// Parts of the benchmark `wires`; each adds its figures and tables.
#pragma once

#include "benchmarks/kit/kit.h"

namespace enc::bench::wires {

// What the cycle of set-points does to a press, to Table 1, Fig 3 and Table 2.
void add_cycles(Bench& bench);
// The safety matrix.
void add_safety(Bench& bench);
// The loop on the wall clock, through real sockets, beside a bare one.
void add_loop(Bench& bench);

}  // namespace enc::bench::wires
