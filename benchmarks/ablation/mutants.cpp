// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::ablation {
namespace {

const Mutants kMutants{
    "ablation",
    {{.what = "the other forms with another seed, and without the record that they ask for",
      .changes = {"other_seed", "no_record"},
      .kills = {"*.equal", "*.idle"}}}};

}  // namespace
}  // namespace enc::bench::ablation
