"""Report section of the statements of the paper."""

from comparison.evidence.claims.peaks_and_valleys import MAX_SHARE, MIN_SHARE, SHARE
from comparison.evidence.claims.table import Claims, ClaimTable, count_met, word_claims
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section

FOUND = ResultField(  # field of the results with the verdicts on the paper's statements
    name=Claims.key,
    kind=ClaimTable,
    meaning="the paper's statements about its figures; null unless every scene of the paper was studied",
)
FEATURE = Feature(  # check of the paper's statements: its result field, analysis and report section
    Claims.key,
    fields=(FOUND,),
    analysis=Claims(),
    of_the_paper=True,
    section=Section(
        "The paper's claims",
        absent="phase-resonance run with every scene of the paper makes it, and phase-resonance claims alone",
        context=lambda report: {"peak_share": SHARE, "peak_shares": (MIN_SHARE, MAX_SHARE)},
        verifies=True,
        verdict=lambda results: (
            f"of {len(FOUND.read_from(results).statements)} statements, {count_met(FOUND.read_from(results))}"
        ),
        lead=lambda results: word_claims(FOUND.read_from(results)),
    ),
)
