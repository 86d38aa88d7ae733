"""
Two reports of known results as lines: what a reader sees on the page, in the texts, in one body that is drawn.

    PYTHONPATH=. python tests/comparison/recorded_report.py

writes report/recorded_report.txt anew. Read its difference before it is committed: each line is what a user sees. The
first report has every section; the second one is early, and lacks values. Of it are the lines that the first has not.
"""

import io
import json
import math
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from html import unescape
from itertools import groupby
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from browsers import CHROMIUM
from distinct_models import GRID, distinct_hierarchy, distinct_motions, known_demand_surfaces, lacking_hierarchy
from known_analyses import analyses_are, known_others
from known_results import FILES, MEASURED, SEARCHED, known_assumptions, leave_beside
from places import HELPERS, scene_text
from recorded_figures import figures_are_told
from report_texts import page_of, schema_errors
from runs import Here, quick_figures

import comparison.run
from comparison.cli import reports, user_models
from comparison.runner import progress
from comparison.study import user_models as called
from comparison.study.levels import StudyLevel, make_levels

RECORD = Path(__file__).parent / "report" / "recorded_report.txt"
HIDDEN = re.compile(r'<(script|style)\b.*?</\1>|<th scope="row">phase-resonance.*?</table>', re.DOTALL)
CHANGING = {  # from run to run and from machine to machine
    r"\d{4}-\d\d-\d\dT[\d:+]+": "TIME",
    r"[\d.]+(?= s of (?:wall|processor) time)": "#",
    r"(?<=TIME; ).*numba \S+": "VERSIONS",
    r"(?<=\W)[0-9a-f]{16}(?=\W)|(?<=sha256-)[\w+/]+=*": "HASH",  # a script is judged by what it draws
    r"^(index.html: <p>Beside the surfaces, processor time).*": r"\1",
    r"^(?:summary.run|.*numpy|terminal: compiling the reference).*": "",
}
BLOCKS = re.compile(r"\s*(?=<(?:tr|p|h\d|li|summary|figure|article|section|details|nav|header|caption|option|div)\b)")
PLOT = re.compile(r"data-plot='(.*?)'", re.DOTALL)
REPEATED = re.compile(r'<line class="(?:grid|zero)"[^>]*>| data-tip="[^"]*"| class="number"')  # once is enough
LONG_NUMBER = re.compile(r"-?\d\.\d{8,}(?:e[-+]\d+)?")
PAGES = "index.html", "verification.html"
LEFT_OUT = (
    "drawn",
    "surfaces.nc",
    "junit.xml",
    "summary.md: |",
    *(f"{page}: <{element}" for page in PAGES for element in ("tr", "p")),
)  # of the second report
ROW = re.compile(r"<tr|\||  ?\S.* $")  # of a table on the page, in Markdown and on the terminal
ROWS = 8  # of a table: the others are written by the same lines of a template
# what scripts draw: plots, but not those of families, whose descriptions stand on the page; and one body of one scene
OF_ONE = re.compile(r"drawn index.html: (plot (?!.* over isolator.friction)|scene 1 body 1 )")
FAMILY = "friction = {range = [0.1, 0.2], steps = 2}"
LIMITS = """[acceptance]
median = 1e-6
maximum = 2e-6
closure = 1.0
failed = 7
[acceptance.like_for_like]
ratio = 7.0
[acceptance.total]
maximum = 3e-6
[acceptance.translational]
median = 0.9
[acceptance.mine]
maximum = 1e-7
"""
FLAT = """title = "a flat <slider>"
duration = 2.0
isolator = {radius = inf, friction = 0.1, travel = 0.5}
excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
[[bodies]]
mass = 1.0
[[bodies]]
mass = 1.0
period = [1.5, 1.2]
[acceptance]
median = 0.001
"""


class Early(StudyLevel):
    """A level before the last whose report is as complete as that of the last."""

    last = True  # type: ignore[assignment]


def lines_of(place: Path) -> list[str]:
    """What a report says: page, texts and terminal by lines, variables of surfaces.nc; of long tables some rows."""
    lines, seen = [], set()

    def first(found: re.Match[str]) -> str:
        known = found[0] in seen
        seen.add(found[0])
        return "" if known else found[0]

    for name in PAGES:
        page = PLOT.sub(lambda plot: f"data-plot={compact(json.loads(unescape(plot[1])))}", page_of(place, name))
        shown = HIDDEN.sub("", unescape(page))
        shown = REPEATED.sub(first, re.sub(r"</(?!strong|code|a\b)\w+>", "", shown))
        shown = LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", shown)
        parts = [" ".join(part.split()) for part in BLOCKS.split(shown) if part.strip()]
        lines += [f"{name}: {part}" for part in some_rows(parts)]
    assert schema_errors(place) == []
    lines += variables(place)
    for name in ("summary.md", "junit.xml", "terminal"):
        text = (place / name).read_text(encoding="utf-8").splitlines()
        lines += [f"{name}: {line}" for line in some_rows([line for line in text if line.strip()])]
    for changing, masked in CHANGING.items():
        lines = [re.sub(changing, masked, line.replace(str(place.parent), "")) for line in lines]
    return [*filter(None, lines)]


def some_rows(lines: Sequence[str]) -> Iterator[str]:
    """The lines; of a table on page or terminal or in Markdown its head, its first rows and a few of the others."""
    for is_row, group in groupby(lines, key=lambda line: bool(ROW.match(line))):
        rows = list(group)
        long = is_row and len(rows) > ROWS
        yield from [*rows[: ROWS // 2], *rows[ROWS // 2 :: -(-2 * len(rows) // ROWS)]] if long else rows


def compact(value: Any) -> str:
    """Nested data in one line; numbers in six digits, a few of long lists."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {compact(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        every = [compact(each) for each in value]
        shown = [*every[:8], *every[8::37]] if all(isinstance(each, int | float | None) for each in value) else every
        return f"[{' '.join(shown)}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def reported(place: Path, words: Sequence[str], hierarchy: Sequence[Any]) -> list[str]:
    """The lines of the report and of the terminal."""
    with redirect_stdout(io.StringIO()) as printed, redirect_stderr(printed):
        code = comparison.run.main([*words, "--out", str(place)], hierarchy, ThreadPoolExecutor)
    (place / "terminal").write_text(f"{printed.getvalue()}\nexit code {code}", encoding="utf-8")
    return [*lines_of(place), *drawn(place)]


def drawn(place: Path) -> list[str]:
    """What a browser, if there is one, draws of the report; in a process of its own, since another may be open here."""
    if CHROMIUM is None:
        return []
    command = [sys.executable, str(HELPERS / "drawn_page.py"), str(place)]
    told = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    return [line for line in told if OF_ONE.match(line)]


def recorded_lines(folder: Path) -> list[str]:
    """The lines of both reports, and of the figures of the first."""
    with pytest.MonkeyPatch.context() as patch:
        figures = figures_are_told(patch)
        known = {"motions": distinct_motions, "worst_phases": SEARCHED, "measured": MEASURED}
        known |= {"assumptions": known_assumptions(), "demands": known_demand_surfaces, **known_others()}
        analyses_are(patch, **known)
        patch.setattr(
            reports, "MIN_REPORT_INTERVAL", math.inf
        )  # no level before the last has a report, and no line tells the
        patch.setattr(progress, "LINE_INTERVAL", math.inf)  # time left, however slow the machine
        full = folder / "full" / "report"
        leave_beside(full, FILES, "fig3-I")
        (full.parent / "family.toml").write_text(scene_text().replace("friction = 0.1", FAMILY), encoding="utf-8")
        scenes = ["synthetic-pair", "fig3-I", str(full.parent / "family.toml")]
        words = [*scenes, "--grid", str(GRID), "--also", "demands", "--tolerance", "5e-3"]
        first = reported(full, words, distinct_hierarchy())
        pictures = [name for name in sorted(figures) if name.startswith("fig3-I")]
        first += [f"figure {name}: {line}" for name in pictures for line in figures[name]]

        quick_figures(patch)
        analyses_are(patch, motions=distinct_motions)
        patch.setattr(user_models, "Workers", Here)
        patch.setattr(called, "_read_processor_time", lambda: 0.0)
        patch.setattr(
            comparison.run, "make_study_levels", lambda study: [Early(make_levels(study, {})[-1].study, 2, 3)]
        )
        lacking = folder / "lacking" / "report"
        lacking.parent.mkdir()
        for name, text in {"limited": scene_text().split("[acceptance]")[0] + LIMITS, "flat": FLAT}.items():
            (lacking.parent / f"{name}.toml").write_text(text, encoding="utf-8")
        scenes = [str(lacking.parent / "limited.toml"), "fig4-viscous", str(lacking.parent / "flat.toml")]
        engines = ["--model", "mine=user_engines:off_with_error", "--model", "near=distinct_models:near"]
        words = [*scenes, "--grid", str(GRID), *engines, "--check"]
        second = reported(lacking, words, lacking_hierarchy())
    known_lines = {*first}
    return [
        *first,
        *(f"lacking {line}" for line in second if line not in known_lines and not line.startswith(LEFT_OUT)),
    ]


def variables(place: Path) -> list[str]:
    """What surfaces.nc holds: dimensions, attributes and a few numbers of every variable."""
    with xr.open_dataset(place / "surfaces.nc", engine="h5netcdf") as data:
        lines = []
        for name, each in data.variables.items():
            values = each.values.ravel()
            shown = compact(values[:3].tolist()) if values.dtype.kind in "fi" else ""
            lines.append(
                f"surfaces.nc {name}: {each.dims} {each.attrs.get('units')} {each.attrs.get('long_name')} {shown}"
            )
        return lines


if __name__ == "__main__":
    import tempfile

    assert CHROMIUM is not None, "what the pages draw is recorded with a Chromium"
    with tempfile.TemporaryDirectory() as name:
        RECORD.write_text("\n".join(recorded_lines(Path(name))) + "\n", encoding="utf-8")
