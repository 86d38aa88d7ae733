"""
Start of every command: Ctrl-C ends it without a traceback, also while modules load.

The console script `phase-resonance NAME` starts every command, and `python -m comparison.run` the study. The script
does not look for modules in the working directory, where a file `reference.py` of the user would be taken for this
project.
This module imports nothing of the project, so that loading it takes no time.
"""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import time
import warnings
from contextlib import suppress
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import NamedTuple, NoReturn

SCRIPT_NAME = "phase-resonance"  # name of the console script
# Thresholds of Python's garbage collector, high so that it runs rarely: checking imported objects, which stay anyway,
# would take a tenth of the time of a command that only reads stored results.
COLLECTOR_THRESHOLDS = 50_000, 20, 100

# Environment variables that libraries (Numba, NumPy, Matplotlib) read as whole numbers: smallest and largest allowed
ENVIRONMENT = {"NUMBA_NUM_THREADS": (1, 10**6), "SOURCE_DATE_EPOCH": (0, 253_402_300_799)}

# Environment variables that Numba hands to its compiler (LLVM), by the compiler's argument; it alone can check them
COMPILER_VARIABLES = {"cpu": "NUMBA_CPU_NAME", "features": "NUMBA_CPU_FEATURES"}
# Program that makes the compiler check one of COMPILER_VARIABLES: the compiler reports a wrong value on standard error
COMPILER_QUESTION = """
import os, llvmlite.binding as binding
binding.initialize_native_target()
binding.Target.from_default_triple().create_target_machine({argument}=os.environ["{name}"])
"""

PACKAGE_FOLDER = Path(__file__).parents[1]  # folder of the package `comparison`


class Command(NamedTuple):
    """Command of the program: module with its function `main`, and purpose in words."""

    module: str
    purpose: str


COMMANDS = {  # commands whose module is not a `command.py` in a folder of the package
    "run": Command("comparison.run", "compare the equations with Exudyn and write the report"),
    "init": Command("comparison.cli.init", "a directory with a study to start from"),
    "animate": Command("multibody.animate", "a film of the motion"),
}


def list_commands() -> dict[str, Command]:
    """Return all commands by name: COMMANDS, then one for each `command.py` in a folder of the package."""
    found = dict(COMMANDS)
    for file in sorted(PACKAGE_FOLDER.glob("*/*/command.py"), key=lambda file: file.parent.name):
        folder = ".".join(file.parent.relative_to(PACKAGE_FOLDER.parent).parts)
        found[file.parent.name] = Command(f"{folder}.command", _read_purpose(folder))
    return found


def _read_purpose(package: str) -> str:
    """Return a package's docstring as the help lists it: small first letter, no final period."""
    text = import_module(package).__doc__ or ""
    return f"{text[:1].lower()}{text[1:].strip().rstrip('.')}"


class Clock(NamedTuple):
    """Wall time and processor time, s, of this process and its workers; those that still run count on Linux only."""

    wall: float
    processor: float

    @classmethod
    def now(cls) -> Clock:
        """Return wall time and processor time of this moment."""
        return cls(time.monotonic(), sum(os.times()[:4]) + _read_processor_time_of_children())

    def since(self, earlier: Clock) -> Clock:
        """Return the wall time and processor time that passed since an earlier reading of the clock."""
        return Clock(self.wall - earlier.wall, self.processor - earlier.processor)


def _read_processor_time_of_children() -> float:
    """Return the processor time so far of worker processes still running, s; 0 if the system does not report it."""
    seconds = 0.0
    for child in sys.modules["multiprocessing"].active_children() if "multiprocessing" in sys.modules else ():
        with suppress(OSError):
            fields = Path(f"/proc/{child.pid}/stat").read_text().rpartition(")")[2].split()
            seconds += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds


_started: list[Clock] = []  # the time at which this process's command started, until it is read; else empty


def find_command_start() -> Clock:
    """Return the time at which this process's command started, or that of now if a program called its function."""
    return _started.pop() if _started else Clock.now()


def run_command(module: str) -> NoReturn:
    """Import a command by its full name, run its `main` and end the process with its exit code."""
    _started.append(Clock.now())
    gc.set_threshold(*COLLECTOR_THRESHOLDS)
    _refuse_environment()
    if not sys.warnoptions:  # Hide warnings of libraries: the commands report themselves what a user must know.
        warnings.simplefilter("ignore")
        os.environ.setdefault("PYTHONWARNINGS", "ignore")  # hide them in worker processes as well
    sys.modules["__main__"].__spec__ = __spec__  # makes worker processes import this module, not the command's
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        main = import_module(module).main
    except Exception as error:  # any error: a library may raise any while it loads
        what = "" if isinstance(error, ImportError) else f"{type(error).__name__}: "
        print(f"{SCRIPT_NAME} cannot start: {what}{' '.join(str(error).split())}", file=sys.stderr)
        raise SystemExit(3) from None
    import_module("reference.support.command").run_command(main)
    raise AssertionError("run_command ends the process")


def _refuse_environment() -> None:
    """End the process, with a line for each, if environment variables have values that libraries cannot use."""
    wrong = {}
    for name, (least, most) in ENVIRONMENT.items():
        text = os.environ.get(name)
        if text is None or (text.isascii() and text.isdigit() and len(text) < 20 and least <= int(text) <= most):
            continue
        wrong[name] = f"must be a whole number from {least} to {most}"
    for argument, name in COMPILER_VARIABLES.items():
        if os.environ.get(name):
            words = [sys.executable, "-c", COMPILER_QUESTION.format(argument=argument, name=name)]
            if said := subprocess.run(words, capture_output=True, text=True, check=False).stderr.strip():
                wrong[name] = said.splitlines()[-1].partition(" (ignoring")[0]
    for name, rule in wrong.items():
        value = f"{os.environ[name][:80]!r}: {rule}"
        print(f"environment: {name} = {value}: correct this environment variable, or remove it", file=sys.stderr)
    if wrong:
        raise SystemExit(2)


def main() -> NoReturn:
    """Run the console script `phase-resonance`: its first argument names the command, the others are passed on."""
    name = sys.argv[1] if len(sys.argv) > 1 else "help"
    known = list_commands()
    if name in ("-h", "--help", "help"):
        print(
            f"usage: {SCRIPT_NAME} COMMAND [options]; {SCRIPT_NAME} COMMAND --help lists the options; "
            f"{SCRIPT_NAME} --version\n"
        )
        print("\n".join(f"  {name:12s} {command.purpose}" for name, command in known.items()))
        raise SystemExit(0)
    if name == "--version":
        print(f"{SCRIPT_NAME} {import_module('reference').__version__}")
        raise SystemExit(0)
    if name not in known:
        nearest = get_close_matches(name, known, n=1)
        rule = f"did you mean {nearest[0]}?" if nearest else f"must be one of {', '.join(known)}"
        print(f"command line: COMMAND = {name!r}: {rule}", file=sys.stderr)
        raise SystemExit(2)
    sys.argv = [f"{SCRIPT_NAME} {name}", *sys.argv[2:]]
    run_command(known[name].module)
