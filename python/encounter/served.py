"""A run in step with Python."""
import csv
import subprocess
import sys
import tempfile

from .columns import value
from .program import program_file, refusal, run_of, run_words


class Served:
    """A run in the twin that waits for each step. End it with close(), or use it in a `with` block.

    row: the newest row, values by name: the table of `encounter export --truth`; None: the run is over. An unknown number is
    NaN. run: the Run, once it is over.
    """

    def __init__(self, scene, set=None, *, every_ms=0, rig=None, seed=1, for_s=None, record=None, force=False):
        words = run_words("serve", scene, set, every_ms=every_ms, rig=rig, seed=seed, for_s=for_s, record=record, force=force)
        self._said = tempfile.TemporaryFile("w+", encoding="utf-8", errors="backslashreplace")
        self._program = subprocess.Popen([program_file(), *words], encoding="utf-8", errors="backslashreplace",
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said)
        self._record, self.run = record, None
        names = self._program.stdout.readline()
        if not names:
            self._end()
        self._names = next(csv.reader([names]))
        self._read()

    def step(self, place_mm=None):
        """Goes on to the next row and returns it; None: the run is over.

        place_mm: x, y and z in W where the hand shall bring the tool's tip; None: as before.
        """
        if self.row is None:
            return None
        line = "" if place_mm is None else " ".join(repr(float(x)) for x in place_mm)
        try:
            self._program.stdin.write(line + "\n")
            self._program.stdin.flush()
        except BrokenPipeError:  # it has ended; its output says why
            pass
        self._read()
        return self.row

    def close(self):
        """Ends the run and returns it."""
        if self.run is None and self._program.poll() is None:
            self._program.stdin.close()
            while self.row is not None:
                self._read()
        return self.run

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.close()
        elif self._program.poll() is None:
            self._program.kill()
            self._program.communicate()
            self._said.close()

    def _read(self):
        line = self._program.stdout.readline()
        if line.strip():
            self.row = {name: value(name, cell) for name, cell in zip(self._names, next(csv.reader([line])))}
        else:
            self.row = None
            self._end()

    def _end(self):
        text = self._program.stdout.read()
        self._program.stdin.close()
        self._program.stdout.close()
        code = self._program.wait()
        self._said.seek(0)
        said = self._said.read()
        self._said.close()
        if code not in (0, 1, 4):
            raise refusal(said, code)
        sys.stderr.write(said)
        self.run = run_of(text, self._record, code)


def serve(scene, set=None, **options):
    """Begins a run that goes on by `step`; options: those of `run`, and every_ms, the time between two rows (0: each tick)."""
    return Served(scene, set, **options)
