"""The tables that a command prints, read back."""

import re


def rows_under(printed: str, *headings: str) -> list[dict[str, str]]:
    """The rows of the tables with these headings, as cells by heading; columns stand two or more spaces apart."""
    rows: list[dict[str, str]] = []
    heads: list[str] = []
    for line in printed.splitlines():
        cells = re.split(r"\s{2,}", line.strip())
        if set(headings) <= set(cells):
            heads = cells
        elif not line.strip():
            heads = []
        elif heads and len(cells) == len(heads):
            rows.append(dict(zip(heads, cells)))
    return rows
