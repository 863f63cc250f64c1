#include "app/sweep/cluster.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "app/common/words.h"
#include "app/sweep/sweep_options.h"
#include "app/sweep/workers.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/tables/number_text.h"
#include "trial/sweep/spec.h"

namespace enc::app {
namespace {

using Number = std::optional<std::int64_t>;
constexpr std::int64_t kNoNumber = -1;

Number number_of(std::string_view text) { return models::number_in<std::int64_t>(text); }
Number variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::nullopt : number_of(value);
}

// Slurm counts an array from any number in any step.
std::optional<SweepShare> slurm_array() {
  const Number task = variable("SLURM_ARRAY_TASK_ID"), count = variable("SLURM_ARRAY_TASK_COUNT");
  if (!task || !count) return std::nullopt;
  const std::int64_t first = variable("SLURM_ARRAY_TASK_MIN").value_or(0);
  const std::int64_t step = std::max<std::int64_t>(1, variable("SLURM_ARRAY_TASK_STEP").value_or(1));
  return SweepShare{{(*task - first) / step, *count}, usable_cores()};
}

// Launchers of MPI, and srun, start a process for each core.
std::optional<SweepShare> ranks() {
  struct RankNames {
    const char *rank, *size;
  };
  for (const RankNames& of : {RankNames{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                              RankNames{"PMI_RANK", "PMI_SIZE"}, RankNames{"SLURM_PROCID", "SLURM_NTASKS"}})
    if (const Number rank = variable(of.rank), size = variable(of.size); rank && size)
      return SweepShare{{*rank, *size}, 1};
  return std::nullopt;
}

// HTCondor describes the job in a file: "ProcId = 3".
std::optional<SweepShare> condor() {
  const char* path = std::getenv("_CONDOR_JOB_AD");
  if (path == nullptr) return std::nullopt;
  Number process, count;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t sign = line.find(" = ");
    if (sign == std::string::npos) continue;
    const std::string key = line.substr(0, sign), value = line.substr(sign + 3);
    if (key == "ProcId") process = number_of(value);
    if (key == "TotalSubmitProcs") count = number_of(value);
  }
  if (!process || !count) return std::nullopt;
  return SweepShare{{*process, *count}, static_cast<std::size_t>(variable("OMP_NUM_THREADS").value_or(1))};
}

// GNU parallel counts from 1 and does not tell how many there are.
std::optional<SweepShare> gnu_parallel(std::int64_t count) {
  const Number job = variable("PARALLEL_SEQ");
  if (!job || count == 0) return std::nullopt;
  return SweepShare{{*job - 1, count}, 1};
}

// count 0: not given.
SweepShare automatic(const std::string& words, std::int64_t count) {
  std::optional<SweepShare> share = slurm_array();
  if (!share) share = ranks();
  if (!share) share = condor();
  if (!share) share = gnu_parallel(count);
  if (!share)
    throw Error(
        fmt::format("--shard {}: this process is in no Slurm array, MPI launcher, HTCondor job or job of GNU "
                    "parallel (which needs auto/N); expected one; give --shard I/N",
                    words));
  if (count != 0 && count != share->shard.count)
    throw Error(fmt::format("--shard {}: the launcher started {} processes; expected {}; leave /{} out",
                            words, share->shard.count, count, count));
  return *share;
}

}  // namespace

SweepShare share_of(const std::string& words) {
  if (words.empty()) return {{}, usable_cores(), true};
  const std::size_t slash = words.find('/');
  const std::string head = words.substr(0, slash);
  std::int64_t count = 0;
  if (slash != std::string::npos)
    count = number_of(std::string_view(words).substr(slash + 1)).value_or(kNoNumber);
  SweepShare share;
  if (head == "auto" && (slash == std::string::npos || count > 0)) {
    share = automatic(words, count);
  } else {
    const Number index = number_of(head);
    if (!index || slash == std::string::npos || count == kNoNumber)
      throw Error(fmt::format("--shard {}: expected I/N, such as 0/7 to 6/7, or auto, or auto/7; correct it",
                              models::quoted(words)));
    share = {{*index, count}, usable_cores()};
  }
  const auto [index, all] = share.shard;
  if (all < 1 || all > trial::kMostRuns || index < 0 || index >= all)
    throw Error(fmt::format("--shard {}: shard {} of {}; expected a number from 0 to {}; correct it", words,
                            index, all, all - 1));
  return share;
}

std::string slurm_script(const SweepOptions& options, const std::string& program) {
  constexpr std::string_view kAuto = "auto/";
  const Number count = options.shard.starts_with(kAuto)
                           ? number_of(std::string_view(options.shard).substr(kAuto.size()))
                           : std::nullopt;
  if (!count || *count < 1)
    throw Error("--submit: the number of shards is missing; expected --shard auto/N; add it");
  for (const std::string& name : {options.spec, options.out})
    if (models::printable(name) != name)
      throw Error(
          fmt::format("--submit: {} cannot stand in a script; expected printable text on one line; "
                      "choose another name",
                      models::quoted(name)));
  std::string log = options.out;  // a percent sign begins a name of Slurm's
  for (std::size_t at = 0; (at = log.find('%', at)) != std::string::npos; at += 2) log.insert(at, 1, '%');
  const std::string command = fmt::format("{} sweep {} --out {}", shell_word(program),
                                          shell_word(options.spec), shell_word(options.out));
  return fmt::format(
      "#!/bin/sh\n"
      "#SBATCH --job-name=sweep\n"
      "#SBATCH --array=0-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task=1\n"
      "#SBATCH --requeue\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --output={}\n"
      "# A shard that was killed goes on where it stopped. When all are whole: {} --merge\n"
      "exec {} --shard \"$SLURM_ARRAY_TASK_ID/{}\"\n",
      *count - 1, shell_word(log + "-%a.log"), command, command, *count);
}

}  // namespace enc::app
