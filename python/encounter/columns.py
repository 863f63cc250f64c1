"""The program's tables as numpy arrays, a column each."""
import csv
import io
import math

import numpy

_TEXT = {"mode", "source", "tool", "object", "state_hash", "error"}
_WHOLE = {"repeat", "true_press", "true_touching", "contact", "rendered", "id", "point", "exit"}


def _numbers(cells):
    return numpy.array([float(cell) if cell else numpy.nan for cell in cells])


def _array(name, cells):
    if name in _TEXT:
        return numpy.array(cells, dtype=str)
    if name in _WHOLE:
        return numpy.array([int(cell) for cell in cells], dtype=numpy.int64)
    if name == "seed":
        return numpy.array([int(cell) for cell in cells], dtype=numpy.uint64)
    try:
        return _numbers(cells)
    except ValueError:  # words that a sweep varies
        return numpy.array(cells, dtype=str)


def value(name, cell):
    """The value of one cell: a text, a whole number, or a number; NaN for an unknown one."""
    if name in _TEXT:
        return cell
    if name in _WHOLE:
        return int(cell)
    return float(cell) if cell else math.nan


def columns(table):
    """Columns by name. Unknown numbers are NaN, unknown texts empty."""
    names, *rows = csv.reader(io.StringIO(table, newline=""))
    cells = zip(*rows) if rows else [()] * len(names)
    return {name: _array(name, column) for name, column in zip(names, cells)}
