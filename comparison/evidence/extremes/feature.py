"""Report section of the stability at the extremes."""

from comparison.evidence.extremes.matrix import MEANING_OF_VERDICT, STORED, CellVerdict, describe_entry
from comparison.report.feature import Feature, make_stored_field
from comparison.report.section import Section

# Results field with the verdicts on every model (columns) at every extreme (rows): the matrix of extremes
FOUND = make_stored_field(STORED, name="extremes", meaning="every model at the extremes of every quantity")
FEATURE = Feature(  # stability of the models at extremes: results field and report section
    "extremes",
    fields=(FOUND,),
    section=Section(
        "Stability at the extremes",
        absent=STORED.word_how_to_make(),
        context=lambda report: {
            "verdicts": [(verdict.value, MEANING_OF_VERDICT[verdict]) for verdict in CellVerdict],
            "describe": describe_entry,
        },
        verifies=True,
        verdict=lambda results: FOUND.read_from(results).count_line,
    ),
)
