"""Report section of the peaks that experiments measured."""

from collections.abc import Mapping
from typing import Any

from comparison.analyses.measured.analysis import MeasuredPeak, MeasuredPeaks, verdict_line, word_measured
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Report, Section
from comparison.verdicts import STYLE_CLASSES
from reference.measures.peak_demands import QUANTITIES, unit_of

FOUND = ResultField(  # field of summary.json with the result of this analysis
    name=MeasuredPeaks.key,
    kind=list[MeasuredPeak],
    meaning="measured peaks beside what every model computes; null where no scene has any",
)


def _section_context(report: Report) -> Mapping[str, Any]:
    """Return the template variables of the section: title and unit of each quantity, and the style of each verdict."""
    return {
        "measured_titles": {"mu": "amplification factor"} | {key: text for key, (text, _) in QUANTITIES.items()},
        "measured_units": {"mu": ""} | {key: unit_of(key) for key in QUANTITIES},
        "measured_classes": STYLE_CLASSES,
    }


# Registration of this analysis with the program: field of summary.json, computation, section of the report
FEATURE = Feature(
    key=MeasuredPeaks.key,
    fields=(FOUND,),
    analysis=MeasuredPeaks(),
    clause=lambda results: word_measured(FOUND.get(results) or ()),
    section=Section(
        title="Measured peaks",
        absent="a scene file with [[measured]] peaks makes it: whoever has measurements can set them beside the models",
        context=_section_context,
        verdict=lambda results: verdict_line(FOUND.read_from(results)),
        folded=False,
    ),
)
