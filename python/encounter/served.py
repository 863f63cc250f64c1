"""A run in step with Python."""
import contextlib
import csv
import os
import subprocess
import sys
import tempfile
import threading
import weakref

from .columns import value
from .program import TEXT, program_file, refusal, run_of, run_words

_servers = weakref.WeakSet()


def _drop(program, said, owner):
    """Ends a run without its report; its record is sealed. A forked child only lets go of it."""
    if os.getpid() == owner:
        program.terminate()
        try:
            program.wait(10)  # s
        except subprocess.TimeoutExpired:
            program.kill()
            program.wait()
    for stream in (program.stdin, program.stdout, said):
        with contextlib.suppress(OSError):  # of a line that the program did not take
            stream.close()


def _let_go():
    for served in list(_servers):
        served._give_up()


if hasattr(os, "register_at_fork"):
    # Else the program would wait for input as long as the child lives.
    os.register_at_fork(after_in_child=_let_go)


class Served:
    """A run in the twin that waits for each step. End it with close(), or use it in a `with` block.

    row: the newest row, values by name: the table of `encounter export --truth`; None: the run is over. An unknown number is
    NaN. run: the Run, once it is over; None: it was broken off, by an exception or because nobody refers to it any more.
    """

    def __init__(self, scene, set=None, *, every_ms=0, rig=None, seed=1, for_s=None, record=None, force=False):
        words = run_words("serve", scene, set, every_ms=every_ms, rig=rig, seed=seed, for_s=for_s, record=record, force=force)
        self._record, self.row, self.run, self._lock = record, None, None, threading.RLock()
        self._said = tempfile.TemporaryFile("w+", **TEXT)
        self._program = subprocess.Popen([program_file(), *words], **TEXT,
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said)
        self._drop = weakref.finalize(self, _drop, self._program, self._said, os.getpid())
        _servers.add(self)
        names = self._program.stdout.readline()
        if not names:
            self._end()
        self._names = next(csv.reader([names]))
        self._read()

    def step(self, place_mm=None):
        """Goes on to the next row and returns it; None: the run is over.

        place_mm: x, y and z in W where the hand shall bring the tool's tip; None: as before.
        """
        line = "" if place_mm is None else " ".join(repr(float(x)) for x in place_mm)
        with self._lock, self._whole():
            if self.row is None:
                return None
            with contextlib.suppress(BrokenPipeError):  # it has ended; its output says why
                self._program.stdin.write(line + "\n")
                self._program.stdin.flush()
            self._read()
            return self.row

    def close(self):
        """Ends the run and returns it."""
        with self._lock, self._whole():
            if self.row is not None:
                with contextlib.suppress(BrokenPipeError):
                    self._program.stdin.close()
            while self.row is not None:
                self._read()
            return self.run

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.close()
        else:
            self._give_up()

    def _give_up(self):
        self.row = None
        self._drop()

    @contextlib.contextmanager
    def _whole(self):
        """A step that is broken off, as by Ctrl-C, ends the run: rows and lines no longer belong together."""
        try:
            yield
        except BaseException:
            self._give_up()
            raise

    def _read(self):
        line = self._program.stdout.readline()
        if line.strip() and line.endswith("\n"):
            self.row = {name: value(name, cell) for name, cell in zip(self._names, next(csv.reader([line])))}
        else:
            self.row = None
            self._end()

    def _end(self):
        text = self._program.stdout.read()
        code = self._program.wait()
        self._said.seek(0)
        said = self._said.read()
        self._drop()
        if code not in (0, 1, 4):
            raise refusal(said, code)
        sys.stderr.write(said)
        self.run = run_of(text, self._record, code)


def serve(scene, set=None, **options):
    """Begins a run that goes on by `step`; options: those of `run`, and every_ms, the time between two rows (0: each tick)."""
    return Served(scene, set, **options)
