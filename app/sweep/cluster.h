// The shard of a process on a cluster, by the environment that its launcher sets, and the batch script.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "trial/sweep/shard.h"

namespace enc::app {

struct SweepOptions;

// How a process takes part in a sweep.
struct SweepShare {
  trial::ShardNumber shard;
  std::size_t workers = 1;
  bool alone = false;  // no --shard: this process does everything, results too
};
// Of the words of --shard: "", "2/7", "auto" or "auto/7". Throws Error.
[[nodiscard]] SweepShare share_of(const std::string& words);

// The script for `sbatch`; --shard names the number of shards, "auto/7".
[[nodiscard]] std::string slurm_script(const SweepOptions& options, const std::string& program);

}  // namespace enc::app
