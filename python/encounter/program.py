"""Finds and starts the program."""
import dataclasses
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TEXT = {"encoding": "utf-8", "errors": "backslashreplace"}  # whatever the locale
_HERE = pathlib.Path(__file__).resolve().parent


class Error(Exception):
    """The program refused its input or failed; the text is the program's own line. `code` is its exit code."""

    def __init__(self, text, code):
        super().__init__(text)
        self.code = code


def program_file():
    """The program: $ENCOUNTER_PROGRAM, else that of the wheel, else that of this checkout, else that on PATH."""
    named = os.environ.get("ENCOUNTER_PROGRAM")
    if named:
        return named
    for place in (_HERE / "program_files/bin/encounter", _HERE.parents[1] / "build/release/encounter"):
        if place.exists():
            return str(place)
    found = shutil.which("encounter")
    if found is None:
        raise FileNotFoundError("no program `encounter`; build it, or set ENCOUNTER_PROGRAM to its file")
    return found


def refusal(said, code):
    """The Error for what the program said."""
    return Error(said.strip().removeprefix("encounter: ") or f"exit code {code}", code)


def call(*words, good=(0,), progress=None):
    """Standard output of the program; Error for an exit code that is not good. Its notes go to our standard error at its end,
    and its lines that are progress, as the function says, at once."""
    said = ""
    with tempfile.TemporaryFile("w+", **TEXT) as output:
        program = subprocess.Popen([program_file(), *map(str, words)], **TEXT,
                                   stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.PIPE)
        with program.stderr:
            try:
                for line in program.stderr:
                    if progress is not None and progress(line):
                        sys.stderr.write(line)
                        sys.stderr.flush()
                    else:
                        said += line
            except BaseException:  # such as Ctrl-C
                program.terminate()
                raise
            finally:
                code = program.wait()
        output.seek(0)
        text = output.read()
    if code not in good:
        raise refusal(said, code)
    sys.stderr.write(said)
    return code, text


def value_text(value):
    """A value as --set reads it."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if value is None:
        return "unset"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if hasattr(value, "__iter__"):
        return "[" + ",".join(map(value_text, value)) + "]"
    return repr(float(value)) if isinstance(value, float) else str(value)


@dataclasses.dataclass(frozen=True)
class Run:
    """A run of a scene."""

    figures: dict  # the report of `run --json`; each key ends in its unit
    state_hash: str
    record: "str | None"  # file of the record, if one was asked for
    code: int  # 0; 1: a limit of the scene was crossed; 4: ended in hold, or the physics diverged


def run_words(command, scene, set, **options):
    """The words of a command that runs a scene; an option that is None or False is left out."""
    words = [command, scene]
    for name, value in (set or {}).items():
        words += ["--set", f"{name}={value_text(value)}"]
    for name, value in options.items():
        if value is not None and value is not False:
            words += ["--" + name.replace("_", "-")] + ([] if value is True else [value])
    return [str(word) for word in words]


def run_of(text, record, code):
    """The Run that a report tells of; Error if there is none."""
    if not text:  # the physics diverged
        raise Error("the run has no report; see the lines above", code)
    figures = json.loads(text)
    return Run(figures, figures["state_hash"], None if record is None else str(record), code)


def run(scene, set=None, *, rig=None, seed=1, for_s=None, record=None, force=False):
    """Runs a scene (a shipped name or a file) in the twin and returns a Run.

    set: {"object.ball.radius_mm": 30}, any name of `encounter params SCENE`. for_s: length in s of simulated time.
    record: file to write; force: replace it.
    """
    words = run_words("run", scene, set, seed=seed, rig=rig, for_s=for_s, record=record, force=force, json=True)
    code, text = call(*words, good=(0, 1, 4))
    return run_of(text, record, code)


def main():
    """The command `encounter` of an installed wheel."""
    program = program_file()
    os.execv(program, ["encounter", *sys.argv[1:]])
