"""What is said when a run ends before its report: what is kept, and the command that goes on from there."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence

from comparison.execution.cache import Cache
from comparison.execution.keys import ANALYSIS, BATCH


def invocation(command: str) -> list[str]:
    """The words that start a command: those of the console script where it was started by that."""
    script = ["phase-resonance", command]
    return script if sys.argv[0] == " ".join(script) else ["python", "-m", f"comparison.{command}"]


def command_line(words: Sequence[str], command: str = "run") -> str:
    """
    A command as it is typed.

    Parameters
    ----------
    words : sequence of str
        After the name of the command.
    command : str
        Its name.

    Returns
    -------
    str
    """
    return shlex.join([*invocation(command), *words])


def resume_hint(cache: Cache, words: Sequence[str], command: str = "run", batches: int | None = None) -> str:
    """
    How much is kept where, and the command for the rest: the same one, without what would throw it away.

    Parameters
    ----------
    cache : Cache
        Where the results are.
    words : sequence of str
        The command line.
    command : str
        Name of the command.
    batches : int, optional
        Number of batches of a study; without it there are tasks only.

    Returns
    -------
    str
        Part of one line.
    """
    rest = [word for word in words if word != "--fresh"]
    tasks = cache.kept[ANALYSIS]
    if batches is None:
        kept = f"{tasks} results are"
    else:
        kept = f"{cache.kept[BATCH]} of {batches} batches{f' and {tasks} analyses' if tasks else ''} are"
    return f"{kept} kept in {str(cache.folder)!r}; go on with: {command_line(rest, command)}"


def without_scheduler(words: Sequence[str]) -> list[str]:
    """
    The words of a command line without the cluster: the same numbers from the processes of this machine.

    Parameters
    ----------
    words : sequence of str

    Returns
    -------
    list of str

    Examples
    --------
    >>> without_scheduler(["fig3-I", "--scheduler", "tcp://a:1", "--grid", "4"])
    ['fig3-I', '--grid', '4']
    """
    rest, words = [], list(words)
    while words:
        word = words.pop(0)
        if word == "--scheduler":
            words = words[1:]
        elif not word.startswith("--scheduler="):
            rest.append(word)
    return rest
