"""External benchmarks: in the report."""

from comparison.evidence.benchmarks.table import STORED, Benchmarks, stated, verdict_line, with_error, word_explanations
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section
from comparison.verdicts import CLASSES

FOUND = ResultField(
    "benchmarks",
    Benchmarks,
    "numbers published elsewhere beside what both sides compute; null unless phase-resonance benchmarks left it "
    "beside the report",
    load=STORED.load,
)
FEATURE = Feature(
    "benchmarks",
    (FOUND,),
    section=Section(
        "External benchmarks",
        "phase-resonance benchmarks makes it, beside the report; the next run of the study shows it",
        lambda report: {
            "benchmark_sentences": word_explanations,
            "benchmark_colors": CLASSES,
            "stated": stated,
            "with_error": with_error,
        },
        verdict=lambda results: verdict_line(FOUND.of(results)),
        verifies=True,
    ),
)
