// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::ledger {
namespace {

const Mutants kMutants{"ledger",
                       {{.what = "work of the hand with the other sign",
                         .changes = {"turned_hand"},
                         .kills = {"closure.*.worst", "closure.worst", "surplus.*.*.worst"}}}};

}  // namespace
}  // namespace enc::bench::ledger
