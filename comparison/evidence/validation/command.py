"""
Measured motions, by the equations and by the engine: `phase-resonance validation [FOLDER]`.

Exit codes: 0 done; 1 a side has no value for a quantity; 2 wrong input; 3 the file could not be written; others as in
`run_command`.
"""

import time
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from comparison.cli.arguments import CommandParser, command, write_and_show
from comparison.cli.terminal import make_table
from comparison.evidence.sides import ENGINE, EQUATIONS
from comparison.evidence.validation import frame, pendulum
from comparison.evidence.validation.files import (
    DECAY_FILE,
    FRAME_SOURCE,
    LARGE_SWING_FILE,
    PENDULUM_SOURCE,
    make_file_error,
    read_folder,
)
from comparison.evidence.validation.table import STORED, ExperimentFindings, Validation, join_findings, load_record
from comparison.runner.environment import describe_provenance
from comparison.runner.output import publish_files, refuse_foreign_files, resolve_destination
from comparison.runner.progress import make_wide_console
from comparison.verdicts import NOT_COMPARED, word_counts
from comparison.wording import word_exception
from reference.problem import SceneError

MAX_REASON_LETTERS = 150  # number of letters after which a library's error message is cut off


@command
def main(argv: Sequence[str]) -> int:
    """Compare computed motions with measured files, or print the recorded comparison; return the exit code."""
    parser = CommandParser(
        "validation", "Measured motions compared with what the equations and the engine compute of them."
    )
    parser.add_argument(
        "folder",
        nargs="?",
        type=Path,
        metavar="FOLDER",
        help="folder with the measured files; recorded results without",
    )
    parser.add_out(f"where {STORED.name} goes")
    options = parser.parse_args(argv)
    console = make_wide_console()
    if options.folder is None:
        print_validation(console, load_record())
        console.print("Recorded in the package. To compute it anew, or with other runs of the frame, get the files:")
        for source in (FRAME_SOURCE, PENDULUM_SOURCE):
            console.print(f"  {source}", soft_wrap=True)
        console.print(f"and name their folder: {STORED.command} FOLDER")
        return 0
    out = resolve_destination(options.out)
    refuse_foreign_files(out, [STORED.name])
    table = compare_folder(options.folder)
    write = partial(publish_files, out, {STORED.name: STORED.as_json(table)}, "comparison.validation")
    files = write_and_show(out, write, partial(print_validation, console, table))
    console.print(f"Table: {', '.join(map(str, files))}", soft_wrap=True)
    console.print("A report written into the same directory by phase-resonance run shows it.")
    return 1 if table.counts()[NOT_COMPARED] else 0


def compare_folder(folder: Path) -> Validation:
    """Return the comparisons of computed motions with every measured file that a folder has."""
    begin = time.process_time()
    measured = read_folder(folder)
    found = [_compare_file("s_b_<weight>g_x.mat", frame.compare_frame, measured.runs)] if measured.runs else []
    found += [_compare_file(DECAY_FILE, pendulum.compare_decay, measured.decay)] if measured.decay else []
    found += [_compare_file(LARGE_SWING_FILE, pendulum.compare_large_swings, measured.large)] if measured.large else []
    seconds = round(time.process_time() - begin, 1)
    run = {"command": f"{STORED.command} FOLDER", "seconds": seconds, "provenance": describe_provenance()}
    return Validation(**join_findings(found)._asdict(), run=run)


def _compare_file(file: str, compare: Callable[[Any], ExperimentFindings], measured: Any) -> ExperimentFindings:
    """Return what `compare` finds for a measured motion; raise SceneError, naming the file, if it cannot compare it."""
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return compare(measured)
    except SceneError:
        raise
    except (
        ArithmeticError,
        ValueError,
        LookupError,
        TypeError,
        AssertionError,
    ) as error:  # what NumPy, SciPy or pydantic raise for unsuitable measurements
        reason = word_exception(error)[:MAX_REASON_LETTERS]
        rule = f"must hold motions like the published ones: none can be compared with these ({reason})"
        raise make_file_error(file, rule) from error


def print_validation(console: Console, table: Validation) -> None:
    """Print measured and computed quantities, causes of differences, inputs, and the number of quantities met."""
    heads = ("D", "u_D", "u_input", "E equations", "u_num", "E engine", "u_num", "u_val", "verdict")
    lines = make_table("quantity", *heads)
    for each in table.quantities:
        sides = [each.sides[side] for side in (EQUATIONS, ENGINE)]
        numbers = [number for side in sides for number in (side.error, side.numerical)] + [sides[0].validation]
        cells = [f"{each.data:.2g}", f"{each.inputs:.2g}", *("-" if n is None else f"{n:.2g}" for n in numbers)]
        lines.add_row(f"{each.experiment}: {each.name}, {each.unit}", f"{each.measured:.5g}", *cells, each.word_both())
    console.print(lines)
    causes = []
    for cause, rows in table.explanations().items():
        causes.append(f"{cause} ({'; '.join(f'{each.experiment}, {each.name}' for each in rows)})")
    for text in (*causes, *table.facts, *(f"input of the {each}" for each in table.inputs)):
        console.print(f"{text[0].upper()}{text[1:]}.", soft_wrap=True)
    console.print(f"{word_counts(table.counts())}.", soft_wrap=True)
