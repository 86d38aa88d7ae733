"""External benchmarks: in the report."""

from comparison.evidence.benchmarks.table import STORED, Benchmarks, stated, verdict_line, with_error, word_explanations
from comparison.report.section import Feature, Section
from comparison.verdicts import CLASSES

FEATURE = Feature(
    "benchmarks",
    Benchmarks,
    "numbers published elsewhere beside what both sides compute; null unless python -m comparison.benchmarks left it "
    "beside the report",
    load=STORED.load,
    section=Section(
        "External benchmarks",
        "python -m comparison.benchmarks makes it, beside the report; the next run of the study shows it",
        lambda report, figures: {
            "benchmark_sentences": word_explanations,
            "benchmark_colors": CLASSES,
            "stated": stated,
            "with_error": with_error,
        },
        verdict=lambda results: verdict_line(results.of("benchmarks")),
        verifies=True,
    ),
)
