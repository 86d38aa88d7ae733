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

Parameters = ParamSpec("Parameters")  # parameters of a command's main function after `argv`
Value = TypeVar("Value", int, float)  # type of the number that an option states

BOUND_FACTORS = BOUND_FACTOR.lowest, BOUND_FACTOR.highest  # smallest and largest factor on friction that --bounds takes
# help text of --out for commands that write no report, only stored results
STORED_RESULTS_HELP = "report whose stored results, in DIR.tiles, are used and added to"


class EndedEarlyError(RuntimeError):
    """Error that ends a command with `code` before its work is done; `str(error)` is one line that says why."""

    def __init__(self, code: int, line: str) -> None:
        """Set the exit code of the command and the line that says why it ended."""
        super().__init__(line)
        self.code = code


class CommandParser(OneLineParser):
    """Parser of a command line; its methods add options that several commands share."""

    def __init__(self, command: str, description: str) -> None:
        """Make the parser of `command`; description: what the command does, for its help text."""
        super().__init__(" ".join(list_starting_words(command)), description)

    def add_scenes(self, default: str) -> None:
        """Add the argument for names of scenes; default: words for the scenes that are used without it."""
        help_text = f"TOML files or built-in names (default: {default})"
        self.add_argument("scenes", nargs="*", metavar="SCENE", help=help_text)

    def add_out(self, content: str, default: str = "report") -> None:
        """Add the option --out, the folder that the command writes into; content: words for the files in it."""
        self.add_argument(
            "--out", default=Path(default), type=Path, metavar="DIR", help=f"{content} (default %(default)s)"
        )

    def add_bounds(self) -> None:
        """Add the option --bounds, which computes each scene at a lower and an upper bound of friction."""
        self.add_argument(
            "--bounds",
            nargs=2,
            metavar=("LOW", "HIGH"),
            help="compute every scene twice, as lower and as upper bound: its coefficients of friction times these "
            "factors",
        )

    def add_computing(self) -> None:
        """Add the options --jobs (workers), --scheduler (cluster) and --fresh (compute everything anew)."""
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
    """Return the two factors by which `--bounds` scales friction, smaller first; None without it. Raises SceneError."""
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
    """Return the number that an option's text states; raise SceneError if it is none or outside [least, most]."""
    try:
        value = kind(text)
    except ValueError:
        raise SceneError("command line", option, text, rule) from None
    if not least <= value <= most:  # true for NaN, too
        raise SceneError("command line", option, value, rule)
    return value


@contextmanager
def report_write_errors(folder: Path, option: str = "--out") -> Iterator[None]:
    """End the command with code 3 if a file cannot be written in the `with` block; `option` named the folder."""
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
    """Wrap a command's main function: errors become exit codes, and `argv` defaults to the words typed."""

    @wraps(main)
    def run_to_exit_code(argv: Sequence[str] | None = None, *args: Parameters.args, **kwargs: Parameters.kwargs) -> int:
        """Run the command; return its exit code. Wrong input or an early end prints one line on standard error."""
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
    """Return the words that start a command: the console script, or "python -m" if that started the study (`run`)."""
    script = ["phase-resonance", command]
    by_script = command != "run" or sys.argv[0] == " ".join(script)
    return script if by_script else ["python", "-m", f"comparison.{command}"]


def format_command_line(words: Sequence[str], command: str = "run") -> str:
    """Return a whole command line as a user types it. words: those after the name of the command."""
    return shlex.join([*list_starting_words(command), *words])


def edit_command_line(
    words: Sequence[str], added: Sequence[str] = (), flags: Collection[str] = (), options: Collection[str] = ()
) -> list[str]:
    """
    Return the words of a command line with some options left out and `added` inserted before any "--".

    flags: options without a value to leave out. options: options with a value to leave out.

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
    """
    Return a line that says where finished results are kept, and which command goes on.

    batches: number of batches (tasks of several phase pairs) of the whole run, None for a command that has none.
    """
    rest = edit_command_line(words, flags=["--fresh"])
    tasks = cache.kept[RESULT_KIND]
    if batches is None:
        kept = f"{tasks} results are"
    else:
        kept = f"{cache.kept[BATCH_KIND]} of {batches} batches{f' and {tasks} analyses' if tasks else ''} are"
    return f"{kept} kept in {str(cache.folder)!r}; go on with: {format_command_line(rest, command)}"
