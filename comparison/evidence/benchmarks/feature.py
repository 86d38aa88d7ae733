"""Report section of the external benchmarks."""

from comparison.evidence.benchmarks.table import (
    STORED,
    verdict_line,
    word_explanations,
    word_published_number,
    word_with_error,
)
from comparison.report.feature import Feature, make_stored_field
from comparison.report.section import Section
from comparison.verdicts import STYLE_CLASSES

# Field of summary.json with the benchmarks, if a command left their file next to the report
FOUND = make_stored_field(
    STORED, name="benchmarks", meaning="numbers published elsewhere, compared with what both sides compute"
)
# Registration of this section of the report with the program: its field of summary.json and its content
FEATURE = Feature(
    "benchmarks",
    fields=(FOUND,),
    section=Section(
        "External benchmarks",
        absent=STORED.word_how_to_make(),
        context=lambda report: {
            "benchmark_sentences": word_explanations,
            "benchmark_colors": STYLE_CLASSES,
            "stated": word_published_number,
            "word_with_error": word_with_error,
        },
        verdict=lambda results: verdict_line(FOUND.read_from(results)),
        verifies=True,
    ),
)
