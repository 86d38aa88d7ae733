"""ensemble.csv: a row for every motion, bound, scale and model, with units in its head."""

import csv
import io

from comparison.analyses.ensemble.analysis import Points
from comparison.analyses.ensemble.quantities import unit_of_demand
from comparison.analyses.ensemble.result import EnsembleResult
from comparison.analyses.ensemble.rows import labels
from comparison.analyses.ensemble.statistics import quantities
from comparison.json_file import finite_or_none
from reference.building import horizontal_peak

FORMULA = ("=", "+", "-", "@")  # begin formulas in a spreadsheet, behind white space, too
CONTROLS = ("\t", "\r", "\n")  # begin no plain cell


def as_rows(points: Points, ensemble: EnsembleResult) -> list[dict[str, object]]:
    """A row for every motion, bound, scale and model, with all demands and their errors; None without an answer."""
    named = labels(ensemble)
    listed = quantities(points.all_points)
    units = {quantity: f" [{unit_of_demand(quantity[0]) or '-'}]" for quantity in listed}
    names = {quantity: "_".join(map(str, filter(None, quantity))) for quantity in units}  # drift_2 of body 2
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
            "peak_ground_acceleration [m/s^2]": horizontal_peak(member.scene),
            "missing": "; ".join(missing),
        }
        for quantity, number in numbers.items():
            head = names[quantity]
            row[f"{head}{units[quantity]}"] = finite_or_none(number.value)
            row[f"{head}_error{units[quantity]}"] = finite_or_none(number.error)
        rows.append(row)
    return rows


def table_text(points: Points, ensemble: EnsembleResult) -> str:
    """Return the content of the file; what begins like a formula stands behind an apostrophe."""

    def cell(value: object) -> object:
        formula = isinstance(value, str) and (value[:1] in CONTROLS or value.lstrip().startswith(FORMULA))
        return f"'{value}" if formula else value

    rows, lines = as_rows(points, ensemble), io.StringIO(newline="")
    writer = csv.writer(lines, quoting=csv.QUOTE_MINIMAL, lineterminator="\r\n")  # it quotes what has one of these
    writer.writerow(rows[0])
    writer.writerows(map(cell, row.values()) for row in rows)
    return lines.getvalue().replace("\r\n", "\n")
