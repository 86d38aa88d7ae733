"""Texts of a scene in figures."""

from __future__ import annotations


def verbatim(text: str) -> str:
    r"""
    A text of a scene for matplotlib, which would read dollar signs as the marks of a formula.

    Parameters
    ----------
    text : str

    Returns
    -------
    str

    Examples
    --------
    >>> print(verbatim("price in $"))
    price in \$
    """
    return text.replace("$", r"\$")
