"""Draws a record with matplotlib, which `pip install encounter[plot]` brings."""
import numpy

from .record import Record, read

_COLOURS = {
    "away": "#ffffff",
    "follow": "#dcebf5",
    "contact": "#f9dcc4",
    "restore": "#d9efe2",
    "hold": "#e6c6d6",
    "probe": "#f9dcc4",
    "travel": "#efe6c0",
}


def _shade_modes(axes, time, mode):
    """Bands for the modes; returns one handle for each mode."""
    begins = numpy.flatnonzero(numpy.concatenate(([True], mode[1:] != mode[:-1])))
    handles = {}
    for begin, end in zip(begins, numpy.append(begins[1:], len(mode) - 1)):
        band = axes.axvspan(time[begin], time[end], color=_COLOURS[mode[begin]], lw=0)
        handles.setdefault(str(mode[begin]), band)
    return handles


def plot(record):
    """Force, deflection and gap over time, with the modes behind, and force over deflection. Returns the figure.

    record: a file, or what read() returned.
    """
    from matplotlib import pyplot

    if not isinstance(record, Record):
        record = read(record)
    time = record["time_s"]
    figure = pyplot.figure(figsize=(11, 6), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(2, 1))
    above = None
    for row, name in enumerate(("force_N", "deflection_mm", "gap_mm")):
        axes = above = figure.add_subplot(grid[row, 0], sharex=above)
        handles = _shade_modes(axes, time, record["mode"])
        axes.plot(time, record[name], lw=0.8)
        axes.set_ylabel(name.replace("_", ", "))
    axes.set_xlabel("time, s")
    figure.legend(handles.values(), handles.keys(), loc="outside lower left", ncols=len(handles))
    axes = figure.add_subplot(grid[:, 1])
    touched = numpy.isin(record["mode"], ("contact", "probe"))
    axes.plot(record["deflection_mm"][touched], record["force_N"][touched], lw=0.8)
    axes.set(xlabel="deflection, mm", ylabel="force, N")
    return figure
