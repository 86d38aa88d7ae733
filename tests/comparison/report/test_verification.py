"""The checks of each side that the report lists are tests of this project, by these names."""

from __future__ import annotations

from pathlib import Path

import pytest
from places import ROOT
from report_texts import page_of

from comparison.report.verification import CHECKS, Check

TESTS = ROOT / "tests"


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.test)
def test_every_check_the_report_lists_exists(check: Check) -> None:
    assert f"def {check.test}(" in (TESTS / check.file).read_text(encoding="utf-8")


def test_the_report_lists_them(finished: Path) -> None:
    page = page_of(finished, "verification.html")
    for check in CHECKS:
        assert check.test in page
