"""Table ensemble.csv: a row for every motion, bound, scale and model, with units in the column heads."""

import csv
import io

from comparison.analyses.ensemble.analysis import EnsemblePoints
from comparison.analyses.ensemble.quantities import unit_of_demand
from comparison.analyses.ensemble.result import EnsembleResult
from comparison.analyses.ensemble.rows import label_structures
from comparison.analyses.ensemble.statistics import list_quantities
from comparison.json_file import finite_or_none
from reference.building import largest_horizontal_acceleration

# A spreadsheet takes a text that begins with one of these, even after white space, for a formula to execute.
FORMULA_STARTS = ("=", "+", "-", "@")
CONTROL_STARTS = ("\t", "\r", "\n")  # A text that begins with one of these may hide a formula.


def make_table_rows(points: EnsemblePoints, ensemble: EnsembleResult) -> list[dict[str, object]]:
    """
    Return a row for each structure, motion, scale and model.

    A row has the demands and their errors by name of the column, None where unknown.
    """
    named = label_structures(ensemble)
    listed = list_quantities(points.all_points)
    units = {quantity: f" [{unit_of_demand(quantity[0]) or '-'}]" for quantity in listed}
    # Names of the columns, for example drift_2 for the drift of body 2
    names = {quantity: "_".join(map(str, filter(None, quantity))) for quantity in units}
    rows = []
    for point in points.all_points:
        member, numbers = point.member, {quantity: point.estimate(quantity) for quantity in names}
        missing = [f"{names[quantity]}: {number.reason}" for quantity, number in numbers.items() if number.reason]
        row: dict[str, object] = {
            "motion": member.motion,
            "bound": named[member.structure],
            "scale [-]": member.scale,
            "model": point.model,
            "status": point.status,
            "factor [-]": member.factor,
            "peak_ground_acceleration [m/s^2]": largest_horizontal_acceleration(member.scene),
            "missing": "; ".join(missing),
        }
        for quantity, number in numbers.items():
            head = names[quantity]
            row[f"{head}{units[quantity]}"] = finite_or_none(number.value)
            row[f"{head}_error{units[quantity]}"] = finite_or_none(number.error)
        rows.append(row)
    return rows


def format_table(points: EnsemblePoints, ensemble: EnsembleResult) -> str:
    """Return the content of ensemble.csv."""

    def cell(value: object) -> object:
        """Return a value of the table; a text that looks like a formula gets an apostrophe in front."""
        formula = isinstance(value, str) and (value[:1] in CONTROL_STARTS or value.lstrip().startswith(FORMULA_STARTS))
        return f"'{value}" if formula else value

    rows, lines = make_table_rows(points, ensemble), io.StringIO(newline="")
    # QUOTE_MINIMAL puts quotes around a text with a comma, quote or line break.
    writer = csv.writer(lines, quoting=csv.QUOTE_MINIMAL, lineterminator="\r\n")
    writer.writerow(rows[0])
    writer.writerows(map(cell, row.values()) for row in rows)
    return lines.getvalue().replace("\r\n", "\n")
