// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::switching {
namespace {

const Mutants kMutants{
    "switching",
    {{.what = "answers judged beside the finger; hystereses, tiles and axes exchanged; belt turned; ball's "
              "speed doubled; each end of a contact counted; another plan; force steps over a second; three "
              "times the work",
      .changes = {"beside", "exchange_room", "exchange_tiles", "on_its_way", "across", "turned_belt",
                  "by_the_second", "double_speed", "ends_of_contacts", "one_hit", "three_times",
                  "few_objects"},
      .kills = {"right", "chatter.*", "tick_1000.over_yardstick.median", "brute_over_tick_1000.median",
                "farther_than_nearest.max", "keys.felt_is_meant", "hit.restitution_error.max",
                "hit.restitution_off.max", "hit.returned.max", "hit.contacts.*",
                "hit.impulse_over_momentum.*", "hit.energy_over_work.max", "hit.wrong_contacts.max", "tile.*",
                "drum.*", "drum.*.max"}}}};

}  // namespace
}  // namespace enc::bench::switching
