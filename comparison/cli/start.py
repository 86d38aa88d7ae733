"""
How every command starts: Ctrl-C ends it without a traceback, also while modules load.

`python -m comparison.NAME` and the console script `phase-resonance NAME` start the same functions. The script does not
look for modules in the working directory, where a file `reference.py` of the user would be taken for this project.
This module imports nothing of the project, so that loading it takes no time.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import time
from contextlib import suppress
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import NamedTuple, NoReturn

SCRIPT = "phase-resonance"
# thresholds of Python's garbage collector: what is imported stays, and looking through it again and again takes a tenth
# of a command that only reads what is stored
COLLECTIONS = 50_000, 20, 100

COMMANDS = {  # module whose `main` is the command, and what it does
    "run": ("comparison.run", "compare the equations with Exudyn and write the report"),
    "claims": (
        "comparison.evidence.claims.command",
        "the paper's statements about its figures in both readings of (5.1)",
    ),
    "assumptions": ("comparison.analyses.assumptions.command", "how far the paper's assumptions hold"),
    "benchmarks": (
        "comparison.evidence.benchmarks.command",
        "numbers published elsewhere, by the equations and by the engine",
    ),
    "validation": ("comparison.evidence.validation.command", "measured motions, by the equations and by the engine"),
    "extremes": ("comparison.evidence.extremes.command", "every model at the extremes of every quantity"),
    "tradeoff": ("comparison.evidence.tradeoff.command", "error against compute time"),
    "ensemble": ("comparison.analyses.ensemble.command", "demands under a suite of motions at many intensities"),
    "init": ("comparison.cli.init", "a directory with a study to start from"),
    "animate": ("multibody.animate", "a film of the motion"),
}


class Clock(NamedTuple):
    """An instant: wall time, and processor time of this process and its children, s; on Linux also of running ones."""

    wall: float
    processor: float

    @classmethod
    def now(cls) -> Clock:
        """This instant."""
        return cls(time.monotonic(), sum(os.times()[:4]) + _of_children())

    def since(self, earlier: Clock) -> Clock:
        """The times that have passed since another instant."""
        return Clock(self.wall - earlier.wall, self.processor - earlier.processor)


def _of_children() -> float:
    """Processor time of the worker processes that run, s; 0 where the system does not tell."""
    seconds = 0.0
    for child in sys.modules["multiprocessing"].active_children() if "multiprocessing" in sys.modules else ():
        with suppress(OSError):
            fields = Path(f"/proc/{child.pid}/stat").read_text().rpartition(")")[2].split()
            seconds += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds


_started: list[Clock] = []


def start_time() -> Clock:
    """When the command of this process started, before its modules were loaded; now where a program calls it."""
    return _started.pop() if _started else Clock.now()


def start(module: str) -> NoReturn:
    """Import a command by its full name, run its `main` and end the process with its exit code."""
    _started.append(Clock.now())
    gc.set_threshold(*COLLECTIONS)
    sys.modules["__main__"].__spec__ = __spec__  # what worker processes load again: not the whole command
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        main = import_module(module).main
    except ImportError as error:
        print(f"{SCRIPT} cannot start: {' '.join(str(error).split())}", file=sys.stderr)
        raise SystemExit(3) from None
    import_module("reference.support.command").run_command(main)
    raise AssertionError("run_command ends the process")


def main() -> NoReturn:
    """Run the console script: its first word is the command, the others are for the command."""
    name = sys.argv[1] if len(sys.argv) > 1 else "--help"
    if name in ("-h", "--help"):
        print(f"usage: {SCRIPT} COMMAND [options]; {SCRIPT} COMMAND --help lists the options; {SCRIPT} --version\n")
        print("\n".join(f"  {command:12s} {purpose}" for command, (_, purpose) in COMMANDS.items()))
        raise SystemExit(0)
    if name == "--version":
        print(f"{SCRIPT} {import_module('reference').__version__}")
        raise SystemExit(0)
    if name not in COMMANDS:
        nearest = get_close_matches(name, COMMANDS, n=1)
        rule = f"did you mean {nearest[0]}?" if nearest else f"must be one of {', '.join(COMMANDS)}"
        print(f"command line: COMMAND = {name!r}: {rule}", file=sys.stderr)
        raise SystemExit(2)
    sys.argv = [f"{SCRIPT} {name}", *sys.argv[2:]]
    start(COMMANDS[name][0])
