"""Reports of known results: headings, tables, plots, texts, files and figures are those that were last read."""

import math
import re
from difflib import unified_diff
from pathlib import Path

from browsers import CHROMIUM
from recorded_report import RECORD, recorded_lines

NUMBER = re.compile(r"[-−+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def alike(before: str, now: str) -> bool:
    """Whether two lines have the same words, and numbers that agree to five digits."""
    if NUMBER.sub("#", before) != NUMBER.sub("#", now):
        return False
    pairs = ([float(each.replace("−", "-")) for each in NUMBER.findall(line)] for line in (before, now))
    return all(math.isclose(*pair, rel_tol=1e-5, abs_tol=1e-9) for pair in zip(*pairs))


def test_the_report_says_what_was_last_read(tmp_path: Path) -> None:
    before, now = RECORD.read_text(encoding="utf-8").splitlines(), recorded_lines(tmp_path)
    if CHROMIUM is None:
        before = [line for line in before if not line.removeprefix("lacking ").startswith("drawn ")]
    same = len(before) == len(now) and all(map(alike, before, now))
    assert same, "\n".join(line for line in unified_diff(before, now, lineterm="", n=0))
