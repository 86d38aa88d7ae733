"""
Attempts: an error in a part of the output (section, picture, table, file) loses that part alone.

A command computes, then writes tables and JSON, then draws. What raises outside the results becomes one line, and the
exit code is as without it.
"""

import errno
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

from comparison.runner.output import print_on_stderr, publish_files
from comparison.wording import word_exception
from reference.support.command import OutputError

# System error numbers that mean that no file can be written at all (full or faulty disk): the command ends with code 3.
FULL_DISK_ERRORS = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO}
MAX_LINE_LETTERS = 300  # number of letters after which the reason why a part of the report is lost is cut off

T = TypeVar("T")  # type of what an attempted function returns


def attempt(what: str, act: Callable[[], T], say: Callable[[str], object] = print_on_stderr) -> T | None:
    """
    Return what `act` returns. If it raises an error, pass to `say` a line that names `what` and why, and return None.

    Errors that mean that no file can be written at all are raised.
    """
    try:
        return act()
    except OutputError:
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.errno in FULL_DISK_ERRORS:
            raise
        say(f"{what} could not be shown: {word_exception(error)[:MAX_LINE_LETTERS]}")
        return None


def publish_attempted(folder: Path, name: str, make: Callable[[], bytes], command: str) -> list[Path]:
    """Write the file whose content `make` returns, and return its path; if `make` raises an error, print a line."""
    content = attempt(name, make)
    return [] if content is None else publish_files(folder, {name: content}, command)


class LostParts:
    """
    List of the parts of a report that could not be made, because their computation raised an error.

    lines: a message for each, printed once on standard error. last: the message of the part that failed last.
    """

    def __init__(self, lines: Iterable[str] = ()) -> None:
        """Begin with the messages of parts that are already lost."""
        self.lines, self.last = [*lines], ""

    def attempt(self, what: str, act: Callable[[], T]) -> T | None:
        """Return what `act` returns; if it raises an error, record that the part `what` is lost and return None."""
        return attempt(what, act, self.note)

    def note(self, line: str) -> None:
        """Record and print the message of a lost part."""
        self.last = line
        if line not in self.lines:
            self.lines.append(line)
            print_on_stderr(line)
