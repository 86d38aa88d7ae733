"""
A report with every section, of known results, as lines: headings, tables, plots and texts.

    PYTHONPATH=. python tests/comparison/recorded_report.py

writes report/recorded_report.txt anew. Read its difference before it is committed: each line is what a user sees.
"""

import io
import json
import math
import re
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stdout
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from distinct_models import GRID, distinct_hierarchy
from known_analyses import analyses_are, known_others
from known_results import FILES, MEASURED, SEARCHED, known_trade
from report_texts import Tables, data_of, page_of, summary_of, text_of
from runs import quick_figure, quick_figures

from comparison.analyses.assumptions import figure as assumptions
from comparison.analyses.tradeoff import command as tradeoff
from comparison.analyses.tradeoff.trade import MeasuredTrade
from comparison.run import main
from comparison.runner.output import publish

RECORD = Path(__file__).parent / "report" / "recorded_report.txt"
MARKUP = re.compile(r"<[^>]*>")
CHANGING = re.compile(  # from run to run and from machine to machine
    r"\.run\.|wall time|\d{4}-\d\d-\d\dT|\bnumpy|\bcommit|\bLinux|digest"
    r"|: (command|python|numba|scipy|xarray|h5netcdf|matplotlib|exudyn|processor|system|phase-resonance) \|"
)
PAGES = "index.html", "verification.html"


def lines_of(place: Path) -> list[str]:
    """What the report says, a line for each row, heading, plot and item."""
    lines = []
    for name in PAGES:
        page = page_of(place, name)
        headings = re.findall(r"<(h[1-4]|p|li|figcaption|caption|summary)[^>]*>(.*?)</\1>", page, flags=re.DOTALL)
        lines += [f"{name} {kind}: " + " ".join(MARKUP.sub(" ", text).split()) for kind, text in headings]
        for number, table in enumerate(Tables(page).tables):
            lines += [f"{name} table {number}: " + " | ".join(" ".join(cell.split()) for cell in row) for row in table]
        for number, drawn in enumerate(re.findall(r"data-plot='([^']*)'", page)):
            lines += items(f"{name} plot {number}", json.loads(unescape(drawn)))
    lines += items("page", data_of(place)) + items("summary", summary_of(place))
    for name in ("summary.md", "junit.xml", "terminal"):
        lines += [f"{name}: {line}" for line in (place / name).read_text(encoding="utf-8").splitlines() if line.strip()]
    lines += [f"report.pdf: {part}" for part in re.split(r"(?<=[.%]) ", text_of(place / "report.pdf")[1])]
    return [line for line in lines if not CHANGING.search(line)]


def items(path: str, value: Any) -> list[str]:
    """A line for every text and number of nested data; numbers in six digits, long lists by a few of their numbers."""
    if isinstance(value, dict):
        return [line for key, inner in value.items() for line in items(f"{path}.{key}", inner)]
    if isinstance(value, list):
        if value and all(isinstance(each, int | float | None) and not isinstance(each, bool) for each in value):
            numbers = np.array([math.nan if each is None else each for each in value], dtype=float)
            seen = " ".join(f"{number:.6g}" for number in (*numbers[:8], *numbers[8::37]))
            return [f"{path}: {seen}"]
        return [line for number, inner in enumerate(value) for line in items(f"{path}.{number}", inner)]
    return [f"{path}: {value:.6g}" if isinstance(value, float) else f"{path}: {value}"]


def report_in(place: Path) -> Path:
    """A report of pairwise different numbers, with what every other command leaves beside it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(assumptions, "draw_assumptions", quick_figure)
        quick_figures(patch)
        analyses_are(patch, motions=[], worst_phases=SEARCHED, measured=MEASURED, **known_others())
        publish(place, FILES, "a test")
        trade = MeasuredTrade(known_trade("fig3-I"), xr.Dataset({"mu": ("point", [1.0])}))
        patch.setattr(tradeoff, "measured_trades", lambda *rest: [trade])
        assert tradeoff.main(["fig3-I", "--out", str(place)]) == 0
        words = ["fig3-I", "--grid", str(GRID), "--skip", "assumptions", "--out", str(place)]
        with redirect_stdout(io.StringIO()) as printed:
            assert main(words, distinct_hierarchy(), ThreadPoolExecutor) == 0
    (place / "terminal").write_text(printed.getvalue().replace(str(place), "report"), encoding="utf-8")
    return place


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        RECORD.write_text("\n".join(lines_of(report_in(Path(folder) / "report"))) + "\n", encoding="utf-8")
