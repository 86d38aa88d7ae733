"""
How every command line program ends: with an exit code, and for any error one line in place of a traceback.

Exit codes that are common to all commands are 2 for wrong input; 3 for an unexpected error, whose traceback goes to a
file, and for a file or an output that cannot be written; 128 plus its number for a signal, that is 130 for Ctrl-C; and
141 if whoever read the output has closed it, as `head` does.
"""

from __future__ import annotations

import argparse
import io
import os
import signal
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any, NoReturn, TextIO, cast

from reference.support.scene_error import MAX_LETTERS, SceneError
from reference.support.version import __version__

# Exit codes: for an error that the program does not expect, and when the reader of standard output has closed it
UNEXPECTED_ERROR_CODE, CLOSED_OUTPUT_CODE = 3, 141
# Signals of the operating system that end the process
SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))


class StoppedError(KeyboardInterrupt):
    """Exception by which a signal of the operating system, `number`, interrupts the command."""

    def __init__(self, number: int = signal.SIGINT) -> None:
        """Set the number of the signal that interrupts."""
        super().__init__(number)
        self.number = number


class OutputError(Exception):
    """Error if standard output cannot be written; not an OSError, which is for files that cannot be written."""

    def __init__(self, error: OSError) -> None:
        """Take over the text of an operating system's error, and whether the reader has closed the output."""
        super().__init__(error.strerror or str(error))
        self.closed = isinstance(error, BrokenPipeError)


class UsageError(ValueError):
    """Error for a command line that cannot be parsed; its text is one line."""


class OneLineParser(argparse.ArgumentParser):
    """Command line parser that raises UsageError instead of printing the usage, and permits no shortened options."""

    def __init__(self, prog: str, description: str) -> None:
        """Make the parser of the command `prog`."""
        super().__init__(prog=prog, description=description, allow_abbrev=False)
        self.add_argument("--version", action="version", version=f"phase-resonance {__version__}")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse words as argparse does, but refuse "--" as value of an option, which argparse would take as empty."""
        words = list(sys.argv[1:] if args is None else args)
        options = words[: words.index("--")] if "--" in words else words
        for option, _, value in (word.partition("=") for word in options if word.startswith("--")):
            if value == "--":
                self.error(f"argument {option}: expected a value, not '--'")
        return super().parse_known_args(words, namespace)

    def error(self, message: str) -> NoReturn:
        """Raise UsageError with the message in one line; if it is long, its middle is left out."""
        text = message if message.isprintable() else repr(message)
        if len(text) > 2 * MAX_LETTERS:
            text = f"{text[:MAX_LETTERS]}...{text[-MAX_LETTERS:]}"
        raise UsageError(f"command line: {text} (--help lists the options)")


def run_command(main: Callable[[], int]) -> NoReturn:
    """Run `main`, a command of this project, and end the process with its exit code."""
    if sys.stdout is None:  # whoever started the command has closed it
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
    output = sys.stdout
    if isinstance(output, io.TextIOWrapper):
        output.reconfigure(errors="backslashreplace")
    sys.stdout = cast(TextIO, _CheckedStdout(output))
    try:
        with stop_on_signals():
            code = _exit_code_of(main)
    finally:
        sys.stdout = output
        _flush_at_last(output)
    raise SystemExit(code)


@contextmanager
def stop_on_signals() -> Iterator[None]:
    """Context manager: in its block, raise StoppedError at the first signal that ends a process and is not ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread can handle signals
        return
    before = {number: signal.getsignal(number) for number in SIGNALS}
    heard = [number for number in SIGNALS if before[number] is not signal.SIG_IGN]

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        """Raise StoppedError for a signal, and ignore all later signals."""
        for each in heard:
            signal.signal(each, signal.SIG_IGN)
        raise StoppedError(number)

    for number in heard:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in heard:
            signal.signal(number, before[number])


class _CheckedStdout:
    """Standard output that raises OutputError where it cannot be written."""

    def __init__(self, stream: TextIO) -> None:
        """Wrap a text stream, to which all is written."""
        self._stream = stream

    def write(self, text: str) -> int:
        """Write a text and return its length. Raises OutputError."""
        try:
            return self._stream.write(text)
        except OSError as error:
            raise OutputError(error) from None

    def flush(self) -> None:
        """Write the text that is buffered. Raises OutputError."""
        try:
            self._stream.flush()
        except OSError as error:
            raise OutputError(error) from None

    def __getattr__(self, name: str) -> Any:
        """Return any other attribute from the wrapped stream."""
        return getattr(self._stream, name)


def _exit_code_of(main: Callable[[], int]) -> int:
    """Run `main` and return its exit code; any exception is told in one line and gives an exit code as well."""
    try:
        for word in sys.argv[1:]:
            if any("\ud800" <= letter <= "\udfff" for letter in word):
                _print_line(f"command line: {word!r}: is not text in UTF-8: rename the file, or give another")
                return 2
        try:
            code = main()
        except SystemExit as end:  # argparse raises SystemExit
            code = end.code if isinstance(end.code, int) else 0 if end.code is None else UNEXPECTED_ERROR_CODE
            if isinstance(end.code, str):
                _print_line(" ".join(end.code.split()))
        sys.stdout.flush()
        return code
    except SceneError as error:
        _print_line(str(error))
        return 2
    except KeyboardInterrupt as stop:
        _print_line("interrupted")
        return 128 + int(getattr(stop, "number", signal.SIGINT))
    except OutputError as error:
        _print_line(f"standard output cannot be written: {error}: the command ended early")
        return CLOSED_OUTPUT_CODE if error.closed else UNEXPECTED_ERROR_CODE
    except Exception as error:
        what = " ".join(f"{type(error).__name__}: {error}".split())
        _print_line(f"unexpected error: {what[:500]}; {_write_traceback_file()}")
        return UNEXPECTED_ERROR_CODE


def _write_traceback_file() -> str:
    """Write the traceback of the present exception to a file; return text that says where it is, or why not."""
    text = f"{sys.argv}\n{sys.version}\n{traceback.format_exc()}"
    try:
        handle, name = tempfile.mkstemp(prefix="phase-resonance-", suffix=".log")
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write(text)
    except OSError as error:
        return f"the details could not be written: {error.strerror}"
    return f"details: {name}"


def _print_line(line: str) -> None:
    """Write one line to standard error, or nothing if standard error is closed."""
    with suppress(Exception):  # nobody may be reading the terminal
        print(line, file=sys.stderr, flush=True)


def _flush_at_last(output: TextIO) -> None:
    """Flush the output; redirect it to nowhere if that fails, so that Python prints no error as it exits."""
    for stream in (output, sys.stderr):
        try:
            if stream is not None:
                stream.flush()
        except (OSError, ValueError):
            with suppress(OSError, ValueError):
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, stream.fileno())
                os.close(nowhere)
