"""
How `python -m comparison.NAME` starts: Ctrl-C ends the command without a traceback, also while modules load.

This module imports nothing of the project, so that loading it takes no time.
"""

from __future__ import annotations

import signal
from importlib import import_module
from typing import NoReturn


def start(module: str) -> NoReturn:
    """
    Import a command, run it and end the process with its exit code.

    Parameters
    ----------
    module : str
        Full name of the module whose `main()` is the command.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    main = import_module(module).main
    import_module("reference.problem.command").run_command(main)
    raise AssertionError("run_command ends the process")
