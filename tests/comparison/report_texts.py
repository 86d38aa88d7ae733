"""The parts of a report, read back."""

import base64
import gzip
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator


def summary_of(report: Path) -> dict[str, Any]:
    """What summary.json holds."""
    found: dict[str, Any] = json.loads((report / "summary.json").read_text(encoding="utf-8"))
    return found


def schema_errors(report: Path) -> list[str]:
    """What summary.json has against the schema beside it."""
    schema = json.loads((report / "summary.schema.json").read_text(encoding="utf-8"))
    return [error.message for error in Draft202012Validator(schema).iter_errors(summary_of(report))]


def page_of(report: Path, name: str = "index.html") -> str:
    """The source of a page."""
    return (report / name).read_text(encoding="utf-8")


def both_pages(report: Path) -> str:
    """The sources of both pages."""
    return page_of(report) + page_of(report, "verification.html")


def data_of(report: Path) -> dict[str, Any]:
    """The numbers that the page draws."""
    (packed,) = re.findall(r'<script[^>]*id="data"[^>]*>(.*?)</script>', page_of(report), flags=re.DOTALL)
    found: dict[str, Any] = json.loads(gzip.decompress(base64.b64decode(packed)))
    return found


class Tables(HTMLParser):
    """The rows of every table by the heads of its columns."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: list[list[list[str]]] = []
        self.inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("td", "th"):
            self.tables[-1][-1].append("")
            self.inside = True

    def handle_endtag(self, tag: str) -> None:
        self.inside = self.inside and tag not in ("td", "th")

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.tables[-1][-1][-1] += data

    def rows(self, number: int) -> list[dict[str, str]]:
        heads, *rows = self.tables[number]
        return [dict(zip(heads, [" ".join(cell.split()) for cell in row])) for row in rows]
