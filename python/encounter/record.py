"""Reads a record as numpy arrays, through `encounter export`: the program checks the file and knows the layout of its version,
so that columns are equal to its table to the digit."""
import collections.abc

from .columns import columns
from .program import call

_UNITS = ("s", "mm", "N", "mJ")


class Record(collections.abc.Mapping):
    """Columns of a record by name, one value a tick. Unknown numbers are NaN, unknown texts empty."""

    def __init__(self, path, table):
        self.path = path
        self.units = {name: unit for name in table if (unit := name.rpartition("_")[2]) in _UNITS}
        self._table = table

    def __getitem__(self, name):
        return self._table[name]

    def __iter__(self):
        return iter(self._table)

    def __len__(self):
        return len(self._table)

    def __repr__(self):
        return f"<Record {self.path}: {len(self['time_s'])} ticks, {len(self)} columns>"

    def ledger(self):
        """Energy balance of each contact, mJ: columns by name, from the twin's ground truth."""
        return columns(call("export", self.path, "--ledger")[1])


def read(record, *, truth=False, partial=False):
    """The ticks of a record.

    truth: also columns `true_...`, the twin's ground truth. The record does not hold them; the program runs the twin again
    and refuses a record whose bits it does not repeat. partial: the whole part of a cut-off or damaged record.
    """
    words = ["export", record] + ["--truth"] * truth + ["--partial"] * partial
    return Record(str(record), columns(call(*words, good=(0, 1) if partial else (0,))[1]))
