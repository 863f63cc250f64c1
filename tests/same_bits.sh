#!/usr/bin/env bash
# The same bits on every processor: runs each scene here and in qemu as on three others, prints the hashes, and replays the
# record of here there. Exit code 1 if anything differs. Whole scenes take hours: qemu computes 100 times slower.
# tests/same_bits.sh [SECONDS | whole] [SCENE...]    from the root, after a build of `release`; 5 s of every scene by default
set -euo pipefail
cd "$(dirname -- "$(readlink -f "${BASH_SOURCE[0]}")")/.."
program=build/release/encounter seconds=${1:-5}
shift || true
length=(); [[ $seconds == whole ]] || length=(--for-s "$seconds")
scenes=("$@"); [[ $# -gt 0 ]] || for file in models/scenes/*.toml; do scenes+=("$(basename "$file" .toml)"); done
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT

hash_of() { sed -nE 's/.*state hash +([0-9a-f]{16}).*/\1/p'; }

differ=0
for scene in "${scenes[@]}"; do
  record=$work/$scene.encrec
  here=$("$program" run "models/scenes/$scene.toml" "${length[@]}" --record "$record" | hash_of)
  line="$scene: here $here"
  for cpu in SandyBridge Haswell max; do
    there=$(qemu-x86_64 -cpu "$cpu" "$program" run "models/scenes/$scene.toml" "${length[@]}" 2>/dev/null | hash_of)
    replayed=$(qemu-x86_64 -cpu "$cpu" "$program" replay "$record" 2>/dev/null | hash_of) || replayed="differs"
    line+=", $cpu ${there:-nothing} replay ${replayed:-nothing}"
    [[ $there == "$here" && $replayed == "$here" ]] || differ=1
  done
  echo "$line"
  rm -f "$record"
done
[[ $differ == 0 ]] && echo "all equal" || { echo "some differ"; exit 1; }
