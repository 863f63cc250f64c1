"""Many runs (docs/guide/sweep.md)."""
import pathlib
import re

from .columns import columns
from .program import call

_is_progress = re.compile(r"encounter: \d+ of \d+ runs?\b").match


def sweep(spec, out, *, only=None, parquet=None):
    """Runs or continues the sweep of a spec file into a folder; returns columns by name, a value for each run.
    Standard error shows how far it is: a line each half minute. Ctrl-C stops it; the same call goes on.

    only: "failed" runs the failed runs again. parquet: file for the columns; needs pyarrow.
    """
    call("sweep", spec, "--out", out, *(["--only", only] if only else []), good=(0, 1), progress=_is_progress)
    table = columns((pathlib.Path(out) / "results.csv").read_text(encoding="utf-8"))
    if parquet is not None:
        import pyarrow.parquet

        pyarrow.parquet.write_table(pyarrow.table(table), parquet)
    return table
