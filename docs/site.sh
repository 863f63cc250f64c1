#!/usr/bin/env bash
# Makes the documentation's site in build/site; needs mkdocs (apt-get install mkdocs). A link that leads nowhere is an error.
# Pages link to files all over the repository, so mkdocs reads a copy of them that is laid out as they are here.
set -euo pipefail
root=$(CDPATH="" cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root"
rm -rf build/pages && mkdir -p build/pages
cp -r --parents -t build/pages README.md CHANGELOG.md CITATION.cff LICENSE docs examples hw_drivers core/math cmake benchmarks/encounter models/{scenes,rigs,behaviours.toml}
exec mkdocs build --quiet --strict --config-file docs/mkdocs.yml
