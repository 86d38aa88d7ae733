"""Report section of the measured motions."""

from itertools import groupby
from typing import Any

from comparison.evidence.sides import ENGINE, EQUATIONS
from comparison.evidence.validation.files import FRAME_SOURCE, PENDULUM_SOURCE
from comparison.evidence.validation.table import STORED, Validation, verdict_line
from comparison.report.feature import Feature, make_stored_field
from comparison.report.panels import Panel, make_panel
from comparison.report.section import Section
from comparison.verdicts import MEANING_OF_VERDICT, STYLE_CLASSES

LINE_STYLES: dict[str, dict[str, Any]] = {  # color, width and dashes of measured and computed motions in the plots
    "measured": {"color": "ink", "width": 2.4},
    EQUATIONS: {"color": 0},
    ENGINE: {"color": 1, "dash": "5 3"},
}


def make_experiment_panels(table: Validation) -> list[Panel]:
    """Return one plot for each experiment, with measured and computed motions."""
    drawn = []
    for title, group in groupby(table.curves, key=lambda curve: curve.panel):
        curves = list(group)
        few = max(len(curve.x) for curve in curves) < 200
        series = [
            {"name": curve.name, "x": list(curve.x), "y": list(curve.y), "marks": few, **LINE_STYLES[curve.name]}
            for curve in curves
        ]
        x, y = curves[0].axes
        drawn.append(
            make_panel(title, f"{title}: {y} over {x}; " + ", ".join(LINE_STYLES), {"title": x}, {"title": y}, series)
        )
    return drawn


# Results field with the comparisons that the command left next to the report
FOUND = make_stored_field(STORED, name="validation", meaning="measured motions, compared with what both sides compute")
FEATURE = Feature(  # comparison with measured motions: results field and report section
    "validation",
    fields=(FOUND,),
    section=Section(
        "Measured motions",
        absent=STORED.word_how_to_make(" FOLDER"),
        context=lambda report: {
            "validation_panels": make_experiment_panels,
            "validation_verdicts": MEANING_OF_VERDICT,
            "validation_colors": STYLE_CLASSES,
            "validation_sources": (FRAME_SOURCE, PENDULUM_SOURCE),
        },
        verifies=True,
        verdict=lambda results: verdict_line(FOUND.read_from(results)),
    ),
)
