"""Report section of the peaks that experiments measured."""

from comparison.analyses.measured.analysis import MeasuredPeak, MeasuredPeaks, verdict_line, word_measured
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section
from comparison.verdicts import STYLE_CLASSES
from reference.measures.peak_demands import QUANTITIES, unit_of

FOUND = ResultField(  # field of summary.json with the result of this analysis
    MeasuredPeaks.key,
    list[MeasuredPeak],
    "measured peaks beside what every model computes; null where no scene has any",
)
# Registration of this analysis with the program: field of summary.json, computation, section of the report
FEATURE = Feature(
    MeasuredPeaks.key,
    (FOUND,),
    analysis=MeasuredPeaks(),
    clause=lambda results: word_measured(FOUND.get(results) or ()),
    section=Section(
        "Measured peaks",
        "a scene file with [[measured]] peaks makes it: whoever has measurements can set them beside the models",
        lambda report: {
            "measured_titles": {"mu": "amplification factor"} | {key: text for key, (text, _) in QUANTITIES.items()},
            "measured_units": {"mu": ""} | {key: unit_of(key) for key in QUANTITIES},
            "measured_classes": STYLE_CLASSES,
        },
        verdict=lambda results: verdict_line(FOUND.read_from(results)),
        folded=False,
    ),
)
