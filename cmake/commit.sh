#!/usr/bin/env bash
# The commit of the sources: "HASH DAY", with -dirty behind the hash where code was changed since; "unknown unknown" where
# this folder is not a repository of its own, as of a tarball. commit.sh prints it. commit.sh FILE writes it into FILE as
# C++, and leaves a FILE alone that has it already, so that a build compiles one small file anew, and only when needed.
set -euo pipefail
root=$(CDPATH="" cd -- "$(dirname -- "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd -P)

# A repository around this folder, or one that a hook names in the environment, is another one. Continuous integration
# often owns the folder as another user.
git() { env -u GIT_DIR -u GIT_WORK_TREE -u GIT_INDEX_FILE GIT_OPTIONAL_LOCKS=0 git -c safe.directory="$root" -C "$root" "$@" 2>/dev/null; }

commit="unknown unknown"
if command -v git >/dev/null && [[ $(git rev-parse --show-toplevel) == "$root" ]] &&
  found=$(git -c core.abbrev=12 log -1 --date=short --format='%h %cd'); then
  commit=$found
  [[ -z $(git status --porcelain -- core sim models trial hw_drivers app benchmarks cmake CMakeLists.txt CMakePresets.json) ]] ||
    commit="${commit/ /-dirty }"
fi
[[ $# -gt 0 ]] || { echo "$commit"; exit 0; }

text="// Written by cmake/commit.sh: the commit that is built.
#include \"trial/provenance/provenance.h\"

enc::trial::BuiltCommit enc::trial::built_commit() noexcept { return {\"${commit% *}\", \"${commit#* }\"}; }"
[[ -e $1 && $(<"$1") == "$text" ]] || echo "$text" >"$1"
