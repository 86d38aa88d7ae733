"""Small tables for notebooks, in place of the one line that a terminal shows."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape


def text_of_number(value: float, count: int) -> str:
    """Write a number with `count` digits; "none" where it is not finite."""
    return f"{value:.{count}g}" if math.isfinite(value) else "none"


def html_table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table of HTML with a caption above it, headings of its columns, and its cells."""
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    body = "".join(f"<tr>{''.join(f'<td>{escape(str(cell))}</td>' for cell in row)}</tr>" for row in rows)
    return f"<p>{escape(caption.strip('<>'))}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
