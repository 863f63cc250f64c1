// The options of `encounter sweep`.
#pragma once

#include <string>

namespace enc::app {

struct SweepOptions {
  std::string spec, out;     // out: folder; empty: the spec's name with "_sweep"
  std::string shard;         // "2/7", "auto", "auto/7"; empty: everything
  std::string submit, only;  // "slurm"; "failed"
  bool merge = false, status = false;
};

int sweep(const SweepOptions& options);

}  // namespace enc::app
