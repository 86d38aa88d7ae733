"""External benchmarks: in the report."""

from comparison.analyses.benchmarks.table import MEANING, STORED, Benchmarks, Verdict, stated, with_error
from comparison.report.section import Feature, Section

COLORS = {
    Verdict.MET: "v-converged",
    Verdict.FRICTION: "v-refused",
    Verdict.MODEL: "v-limit",
    Verdict.OFF: "v-FAILED",
    Verdict.NONE: "v-FAILED",
}  # class of each verdict

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
            "benchmark_verdicts": MEANING,
            "benchmark_colors": COLORS,
            "stated": stated,
            "with_error": with_error,
        },
        verifies=True,
    ),
)
