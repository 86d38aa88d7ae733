"""The statements of the paper: in the report."""

from comparison.evidence.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE
from comparison.evidence.claims.table import Claims, ClaimTable, claims_line, count_met
from comparison.report.section import Feature, Section

FEATURE = Feature(
    "claims",
    ClaimTable,
    "the paper's statements about its figures; null unless every scene of the paper was studied",
    analysis=Claims(),
    section=Section(
        "The paper's claims",
        "python -m comparison.run with every scene of the paper makes it, and python -m comparison.claims alone",
        lambda report, figures: {"peak_share": SHARE, "peak_shares": (LEAST_SHARE, MOST_SHARE)},
        verifies=True,
        verdict=lambda results: (
            f"of {len(results.of('claims').statements)} statements, {count_met(results.of('claims'))}"
        ),
        lead=lambda results: claims_line(results.of("claims")),
    ),
)
