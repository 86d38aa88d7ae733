"""
What all commands share: the options with one meaning, the checks of their values, the exit codes, and the command that
goes on where one was ended.

A wrong option ends every command with exit code 2 and one line that names the option, its value and the rule.
"""

import argparse
import shlex
import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Concatenate, ParamSpec, TypeVar

from comparison.runner.attempts import attempt
from comparison.runner.cache import Cache
from comparison.runner.processes import count_cores
from comparison.runner.task import BATCH_KIND, RESULT_KIND
from reference.problem import SceneError
from reference.problem.families import BOUND_FACTOR
from reference.support.command import OneLineParser, UsageError

Parameters = ParamSpec("Parameters")
Value = TypeVar("Value", int, float)

BOUND_FACTORS = BOUND_FACTOR.lowest, BOUND_FACTOR.highest  # smallest and largest factor on friction in --bounds
# help text of --out for commands that write only stored results
STORED_RESULTS_HELP = "report whose stored results, in DIR.tiles, are used and added to"


class EndedEarlyError(RuntimeError):
    """Error that ends a command with `code` before its work is done; `str(error)` is one line that says why."""

    def __init__(self, code: int, line: str) -> None:
        """Set the exit code of the command and the line that says why it ended."""
        super().__init__(line)
        self.code = code


class CommandParser(OneLineParser):
    """Parser of a command with the options that commands share."""

    def __init__(self, command: str, description: str) -> None:
        """Make the parser of `command`; description: what the command does, for its help text."""
        super().__init__(" ".join(list_starting_words(command)), description)

    def add_scenes(self, default: str) -> None:
        """Add the names of scenes; default: scenes used if none is given, in words."""
        help_text = f"TOML files or built-in names (default: {default})"
        self.add_argument("scenes", nargs="*", metavar="SCENE", help=help_text)

    def add_out(self, content: str, default: str = "report") -> None:
        """Add the folder that the command writes into; content: the files in it, in words."""
        self.add_argument(
            "--out", default=Path(default), type=Path, metavar="DIR", help=f"{content} (default %(default)s)"
        )

    def add_bounds(self) -> None:
        """Add the option that computes each scene at both bounds of friction."""
        self.add_argument(
            "--bounds",
            nargs=2,
            metavar=("LOW", "HIGH"),
            help="compute every scene twice, as lower and as upper bound: its coefficients of friction times these "
            "factors",
        )

    def add_computing(self) -> None:
        """Add the options for workers, cluster and recomputation."""
        self.add_argument("--jobs", metavar="N", help=f"worker processes of this machine (default {count_cores()})")
        self.add_argument("--scheduler", metavar="ADDRESS", help="compute on the Dask cluster with this scheduler")
        self.add_argument(
            "--fresh",
            action="store_true",
            help="compute everything anew; without it what an earlier run left in DIR.tiles, finished or not, is used",
        )


def read_number_of_jobs(options: argparse.Namespace) -> int:
    """Return the number of worker processes that `--jobs` asks for. Raises SceneError."""
    if options.scheduler is not None and options.jobs is not None:
        rule = "counts processes of this machine, --scheduler takes all workers of a cluster: give one of the two"
        raise SceneError("command line", "--jobs", options.jobs, rule)
    return count_cores() if options.jobs is None else read_whole_number("--jobs", options.jobs, 1, 1024)


def read_bounds(options: argparse.Namespace) -> tuple[float, float] | None:
    """Return the smaller and the larger factor on friction of `--bounds`; None without it. Raises SceneError."""
    if options.bounds is None:
        return None
    low, high = (read_number("--bounds", text, *BOUND_FACTORS, "factors of friction") for text in options.bounds)
    if not low < high:
        raise SceneError("command line", "--bounds", " ".join(options.bounds), "the smaller factor must be the first")
    return low, high


def read_whole_number(option: str, text: str, least: int, most: int) -> int:
    """Return the value of an option that takes a whole number. Raises SceneError."""
    return _refuse_beyond(option, text, int, least, most, f"must be a whole number from {least} to {most}")


def read_number(option: str, text: str, least: float, most: float, unit: str) -> float:
    """Return the value of an option that takes a number. Raises SceneError."""
    return _refuse_beyond(option, text, float, least, most, f"must be a number from {least:g} to {most:g}, {unit}")


def _refuse_beyond(option: str, text: str, kind: type[Value], least: Value, most: Value, rule: str) -> Value:
    """Return the number that an option states; raise SceneError outside [least, most]."""
    try:
        value = kind(text)
    except ValueError:
        raise SceneError("command line", option, text, rule) from None
    if not least <= value <= most:  # NaN fails this comparison, too
        raise SceneError("command line", option, value, rule)
    return value


@contextmanager
def report_write_errors(folder: Path, option: str = "--out") -> Iterator[None]:
    """End the command with code 3 and one line where the block cannot write into the folder that `option` names."""
    try:
        yield
    except OSError as error:
        line = f"command line: {option} = {str(folder)!r}: could not be written: {error}"
        raise EndedEarlyError(3, line) from None


def write_and_show(folder: Path, write: Callable[[], list[Path]], show: Callable[[], None]) -> list[Path]:
    """
    Write the files of a command, then show on the terminal what they hold; return the paths of the files.

    Files that cannot be written end the command with code 3 after all is shown. What cannot be shown is one line.
    """
    try:
        with report_write_errors(folder):
            return write()
    finally:
        attempt("results", show)


def command(main: Callable[Concatenate[Sequence[str], Parameters], int]) -> Callable[..., int]:
    """Wrap the main function of a command: errors become exit codes, and the words default to those typed."""

    @wraps(main)
    def run_to_exit_code(argv: Sequence[str] | None = None, *args: Parameters.args, **kwargs: Parameters.kwargs) -> int:
        """Run the command and return its exit code; an error of input or an early end is one line on standard error."""
        try:
            return main(sys.argv[1:] if argv is None else list(argv), *args, **kwargs)
        except (SceneError, UsageError) as error:
            print(error, file=sys.stderr)
            return 2
        except EndedEarlyError as error:
            print(error, file=sys.stderr)
            return error.code

    return run_to_exit_code


def list_starting_words(command: str) -> list[str]:
    """Return the words that start a command; `run` starts with `python -m` unless the console script started it."""
    script = ["phase-resonance", command]
    by_script = command != "run" or sys.argv[0] == " ".join(script)
    return script if by_script else ["python", "-m", f"comparison.{command}"]


def format_command_line(words: Sequence[str], command: str = "run") -> str:
    """Return a command as a user types it: its name, and the words after it."""
    return shlex.join([*list_starting_words(command), *words])


def edit_command_line(
    words: Sequence[str], added: Sequence[str] = (), flags: Collection[str] = (), options: Collection[str] = ()
) -> list[str]:
    """
    Return the words of a command line with options left out and others added; words after "--" stay.

    flags, options: names to leave out, of options without a value and with one.

    Examples
    --------
    >>> edit_command_line(["--grid", "4", "--", "-a.toml"], ["--plan"], options=["--grid"])
    ['--plan', '--', '-a.toml']
    """
    end = words.index("--") if "--" in words else len(words)
    kept, before = [], list(words[:end])
    while before:
        word = before.pop(0)
        if word in options:
            before = before[1:]
        elif word not in flags and word.partition("=")[0] not in options:
            kept.append(word)
    return [*kept, *added, *words[end:]]


def word_resume_hint(cache: Cache, words: Sequence[str], command: str = "run", batches: int | None = None) -> str:
    """Return a line that says where finished results are kept and how to compute the rest; batches: number of all."""
    rest = edit_command_line(words, flags=["--fresh"])
    tasks = cache.kept[RESULT_KIND]
    if batches is None:
        kept = f"{tasks} results are"
    else:
        kept = f"{cache.kept[BATCH_KIND]} of {batches} batches{f' and {tasks} analyses' if tasks else ''} are"
    return f"{kept} kept in {str(cache.folder)!r}; go on with: {format_command_line(rest, command)}"
