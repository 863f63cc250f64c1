"""Encounter, a digital twin of encounter-type haptic displays, from Python.

    import encounter, numpy
    run = encounter.run("tennis_ball", record="ball.encrec")
    print(run.state_hash, numpy.nanmax(encounter.read(run.record)["force_N"]))

Each call starts the program `encounter`: a Python process would not take the program's elementary functions, on which
equal bits depend.
"""
from .drawing import plot
from .many import sweep
from .program import Error, Run, program_file, run
from .record import Record, read
from .served import Served, serve

__all__ = ["Error", "Record", "Run", "Served", "plot", "program_file", "read", "run", "serve", "sweep"]
