#!/usr/bin/env bash
# A sweep under a Slurm of this computer alone: cancelled in the middle and submitted again, its results are those of a sweep
# that nobody disturbed. `./check --full` runs it. Needs root, because slurmd starts the jobs, and Debian's slurm-wlm.
#   tests/slurm.sh COMMAND...   runs COMMAND (say, bash) beside this Slurm instead
set -euo pipefail
root=$(CDPATH="" cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
[[ $EUID -eq 0 ]] || { echo "slurm: left out; it needs root"; exit 0; }
program=${ENCOUNTER_PROGRAM:-$root/build/release/encounter}
work=$(mktemp -d)
daemons=()
clean() {
  kill "${daemons[@]}" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap clean EXIT

export SLURM_CONF=$work/slurm.conf
node=$(hostname -s)
mkdir "$work/state" "$work/spool"
cat >"$SLURM_CONF" <<CONF
ClusterName=encounter
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
KillWait=2
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES
CONF
echo "CgroupPlugin=cgroup/v1" >"$work/cgroup.conf"
head -c 128 /dev/urandom >"$work/munge.key"
chmod 600 "$work/munge.key"
munged --foreground --force --num-threads=1 --key-file="$work/munge.key" --socket="$work/munge.socket" \
  --pid-file="$work/munged.pid" --seed-file="$work/munge.seed" --log-file="$work/munged.log" 2>/dev/null &
daemons+=($!)
until [[ -S $work/munge.socket ]]; do sleep 0.1; done
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.log" 2>&1 &
daemons+=($!)
slurmd -D -f "$SLURM_CONF" >"$work/slurmd.log" 2>&1 &
daemons+=($!)
for ((i = 0; i < 300; ++i)); do
  if [[ $(sinfo -h -o %t 2>/dev/null) == idle ]]; then break; fi
  sleep 0.2
done
[[ $i -lt 300 ]] || { tail -n 20 "$work"/*.log; exit 1; }
if [[ $# -gt 0 ]]; then "$@"; exit; fi

cd "$work"
cat >s.toml <<'TOML'
format = 1
scene = "plane"
for_s = 2
seeds = 100
keep = "contacts modes_s.follow"
[[vary]]
name = "truth.tracker.latency_ms"
values = [3, 5]
TOML
lines() { cat under/shard-* 2>/dev/null | grep -c '"cpu_s"' || true; }
"$program" sweep s.toml --out whole >/dev/null 2>&1
"$program" sweep s.toml --out under --shard auto/7 --submit slurm >under.sh
sbatch --quiet under.sh
for ((i = 0; i < 600 && $(lines) < 40; ++i)); do sleep 0.1; done
scancel --signal=KILL --full --name=sweep || true
scancel --name=sweep
while [[ -n $(squeue -h) ]]; do sleep 0.2; done
cancelled_at=$(lines)
sbatch --quiet --wait under.sh || { tail -n 5 under-*.log; exit 1; }
"$program" sweep s.toml --out under --status
"$program" sweep s.toml --out under --merge >/dev/null
cmp whole/results.ndjson under/results.ndjson
cmp whole/results.csv under/results.csv
echo "slurm: cancelled after $cancelled_at of 200 runs, submitted again: results equal to the byte"
[[ $cancelled_at -gt 0 && $cancelled_at -lt 200 ]]
