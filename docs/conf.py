"""
The documentation: `sphinx-build -W docs build/docs` (`pip install '.[docs]'`).

The pages are Markdown (myst-nb), the reference of functions comes from numpydoc docstrings, the notebooks are run while
the pages are built, and formulas become MathML (mathml.py). Neither the build nor a reader needs a network.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]  # the packages as they stand in this copy, and mathml.py

import reference  # noqa: E402

project = "phase-resonance"
author = "phase-resonance"
copyright = "phase-resonance, MIT license"
version = release = reference.__version__

extensions = ["sphinx.ext.autodoc", "sphinx.ext.viewcode", "numpydoc", "myst_nb", "mathml"]
exclude_patterns = ["_build", "**.ipynb_checkpoints"]
html_theme = "furo"
html_title = "phase-resonance"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_math_renderer = "mathml"
html_copy_source = False
templates_path: list[str] = []

myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3
myst_dmath_double_inline = True

nb_execution_mode = "force"  # the notebooks run at every build; an error ends it
os.environ["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"  # the plots of notebooks are on their pages
nb_execution_timeout = 300
nb_execution_raise_on_error = True

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc has them
numpydoc_show_class_members = False
numpydoc_xref_param_type = False
suppress_warnings = ["toc.not_readable"]  # evidence.md names pages of measurements that a copy may lack


def fit_for_pages(app: Any, what: str, name: str, item: Any, options: Any, lines: list[str]) -> None:
    """
    Change a docstring for its page.

    The lists of functions and classes of a package are left out, since each of them follows. |v| is no substitution of
    reStructuredText.
    """
    if what == "module" and "Functions" in lines:
        lines[lines.index("Functions") :] = []
    lines[:] = [line if ">>>" in line else re.sub(r"\|(?=\S)([^|]*)\|", r"\\|\1\\|", line) for line in lines]


def setup(app: Any) -> None:
    """Connect before numpydoc reads the docstrings."""
    app.connect("autodoc-process-docstring", fit_for_pages, priority=400)
