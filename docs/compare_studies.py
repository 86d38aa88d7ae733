"""
Compare the numbers of two reports bit by bit: `python docs/compare_studies.py BEFORE AFTER`.

Compares every variable and coordinate of surfaces.nc bitwise, NaN payloads included, and every number, truth value and
null of summary.json. Times, texts and what describes the run (`run`) are not compared, nor are measured costs. Prints
one line for each difference. Exit codes: 0 all numbers are equal; 1 some differ; 2 a folder has no report.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

TIMES = frozenset({"cost", "seconds"})  # measured anew by every run
DESCRIPTION = "run"  # command, versions, times


def differing_arrays(before: xr.Dataset, after: xr.Dataset) -> Iterator[str]:
    """
    Arrays that are not equal to the last bit.

    Parameters
    ----------
    before, after : xr.Dataset
        Two surfaces.nc.

    Yields
    ------
    str
        One line for each array that differs in presence, dimensions, type or any bit.
    """
    for name in sorted(set(map(str, before.variables)) | set(map(str, after.variables))):
        if name in TIMES:
            continue
        if name not in before.variables or name not in after.variables:
            yield f"{name}: only {'after' if name in after.variables else 'before'}"
            continue
        old, new = before[name], after[name]
        if (old.dims, old.shape, old.dtype) != (new.dims, new.shape, new.dtype):
            yield f"{name}: {old.dims} {old.shape} {old.dtype} before, {new.dims} {new.shape} {new.dtype} after"
        elif old.dtype == object:
            if count := int((old.values != new.values).sum()):
                yield f"{name}: {count} of {old.size} texts differ"
        elif old.values.tobytes() != new.values.tobytes():
            items = np.ascontiguousarray(old.values), np.ascontiguousarray(new.values)
            rows = [part.view(np.uint8).reshape(old.size, -1) for part in items]
            yield f"{name}: {int((rows[0] != rows[1]).any(axis=1).sum())} of {old.size} values differ"


def differing_numbers(before: Any, after: Any, place: str = "") -> Iterator[str]:
    """
    Numbers that differ between two values read from JSON.

    Parameters
    ----------
    before, after : object
        Objects, lists, numbers, texts, truth values or None.
    place : str
        Keys that lead to them, for the lines.

    Yields
    ------
    str
        One line for each number that differs, and for each key or list whose shape differs.
    """
    if isinstance(before, dict) and isinstance(after, dict):
        for key in sorted(set(before) | set(after)):
            where = f"{place}.{key}" if place else key
            if key in TIMES or where == DESCRIPTION:
                continue
            if key not in before or key not in after:
                yield f"{where}: only {'after' if key in after else 'before'}"
            else:
                yield from differing_numbers(before[key], after[key], where)
    elif isinstance(before, list) and isinstance(after, list):
        if len(before) != len(after):
            yield f"{place}: {len(before)} entries before, {len(after)} after"
        for number, (old, new) in enumerate(zip(before, after)):
            yield from differing_numbers(old, new, f"{place}[{number}]")
    elif not (isinstance(before, str) and isinstance(after, str)) and before != after:
        yield f"{place}: {before!r} before, {after!r} after"


def main(argv: Sequence[str] | None = None) -> int:
    """Compare two report folders; the exit code."""
    parser = argparse.ArgumentParser(description="Compare the numbers of two reports bit by bit.")
    parser.add_argument("before", type=Path, help="folder of a report")
    parser.add_argument("after", type=Path, help="folder of another report of the same study")
    parser.add_argument(
        "--renamed",
        action="append",
        default=[],
        metavar="OLD=NEW",
        type=lambda text: tuple(text.split("=", 1)),
        help="a key of summary.json that has another name in AFTER; may be repeated",
    )
    folders = parser.parse_args(argv)
    try:
        old, new = (xr.load_dataset(folder / "surfaces.nc") for folder in (folders.before, folders.after))
        texts = [(folder / "summary.json").read_text(encoding="utf-8") for folder in (folders.before, folders.after)]
    except OSError as error:
        print(f"not a report: {error}", file=sys.stderr)
        return 2
    lines = [f"surfaces.nc: {line}" for line in differing_arrays(old, new)]
    keys = dict(folders.renamed)
    earlier = json.loads(texts[0], object_pairs_hook=lambda pairs: {keys.get(key, key): value for key, value in pairs})
    lines += [f"summary.json: {line}" for line in differing_numbers(earlier, json.loads(texts[1]))]
    for line in lines:
        print(line)
    values = sum(old[name].size for name in old.variables)
    print(f"{len(old.variables)} arrays with {values} values and summary.json: {len(lines)} differences.")
    return 1 if lines else 0


if __name__ == "__main__":
    raise SystemExit(main())
