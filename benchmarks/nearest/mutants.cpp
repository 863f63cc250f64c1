// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::nearest {
namespace {

const Mutants kMutants{"nearest",
                       {{.what = "Embree and ours exchanged; its answers to the next query; the hand's way "
                                 "left in; four times the work; kept twice",
                         .changes = {"exchange_race", "next_query", "way_left", "four_times", "kept_twice"},
                         .kills = {"ball_100k.ratio_to_embree.median", "ball_100k.apart_from_embree.max",
                                   "ball_100k.point_jump.max", "growth_1k_to_1M.median",
                                   "ball_1M.build_over_yardstick.total", "ball_1M.memory"}}}};

}  // namespace
}  // namespace enc::bench::nearest
