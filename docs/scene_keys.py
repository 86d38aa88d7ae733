"""Write docs/scene.md, the table of every key of a scene file, from the schema: `python docs/scene_keys.py`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from comparison.registry import EVERYTHING
from reference.problem import Scene
from reference.problem.ranges import MAX_CYCLES
from reference.support.arguments import Range

PAGE = Path(__file__).with_name("scene.md")
SET_BY_THE_READER = {"name", "origin", "samples"}  # fields of the models that are no keys of a file
NESTED = {"isolator", "bodies", "excitation", "acceptance", "analyses", "measured", "superstructure"}
TABLES = (  # heading, model in the schema, dotted name, introduction
    ("At the top of the file", "", "", ""),
    ("`[isolator]`", "Isolator", "isolator", "The spherical gravity-friction isolator under the platform."),
    (
        "`isolator.friction` as a table",
        "VelocityFriction",
        "isolator.friction",
        "Friction that depends on the slip speed, mu(v) = fast - (fast - slow) exp(-rate v), as in friction-pendulum"
        " practice: `friction = {slow = 0.03, fast = 0.06, rate = 100.0}`. At rest the coefficient is `slow`. The"
        " regularized law is mu(v) min(1, v / v_reg). `load_exponent` n multiplies the coefficient by (N / N_ref)^n of"
        " the normal force N. In the spatial model N is the force of one support and N_ref its share. `slow` may then"
        " stand alone. With `initial_stiffness` k or `yield_displacement` friction yields elastically before it slides,"
        " as in elements of codes for buildings: `friction = {slow = 0.05, yield_displacement = 0.001}`. Friction is"
        " then k times an elastic displacement, bounded by mu N, and the speed in mu is that of the platform. Each"
        " number may run over a range.",
    ),
    (
        "`heating` of `isolator.friction`",
        "Heating",
        "isolator.friction.heating",
        "`[isolator.friction.heating]`: the coefficients are those at 20 degrees C. The heat of sliding multiplies them"
        " by 0.79 (0.7^(0.02 T) + 0.4). T is the temperature at the center of the track, by conduction into a half"
        " space: T0 + sqrt(D / pi) / k times the integral of q(t - s) / sqrt(s). q is the friction power per contact"
        " area. The center is heated while the slider covers it, up to a displacement of sqrt(pi) / 2 of"
        " `contact_radius`. FPBearingPTV in OpenSees and MASTODON use the same law. `slow` may then stand alone.",
    ),
    (
        "`[[bodies]]`",
        "Body",
        "bodies",
        "One table per body, from the platform up. Every body is linked to the body before it.",
    ),
    (
        "`bars` of a body",
        "Bars",
        "bodies.bars",
        "`bars = {count = 4, bending_stiffness = 120.0, length = 1.0}` in place of `period` or `stiffness`: the link of"
        " (2.3), k = 12 n E J / l^3. `period` and `stiffness` describe a link under the weight that it carries; `bars`"
        " describe it without load. The last model of a study softens the bars by the weight above them at rest,"
        " `Scene.softened()`. A bar under the load P then has the stiffness P / (l (tan x / x - 1)) with"
        " x = (l / 2) sqrt(P / EJ). `load_effect` softens the bars in every model. Softened bars that would buckle, at"
        " P = pi^2 EJ / l^2, are refused. In the spatial model `axial_stiffness` makes the link a clamped beam in"
        " every direction. Bars that could not hold the bodies upright are refused.",
    ),
    (
        "`[superstructure]`",
        "Superstructure",
        "superstructure",
        "All bodies above the platform together. The mode is that of the links in sway, on a platform that is held;"
        " higher modes have ratios in proportion to their frequencies. `phase-resonance run NAME --plan` prints them.",
    ),
    ("`[excitation]`, two frequencies", "Excitation", "excitation", "Ground acceleration (5.2)-(5.4)."),
    ("`[excitation]`, recorded motion", "Record", "excitation", "A record in place of the two frequencies."),
    (
        "`[acceptance]`",
        "Acceptance",
        "acceptance",
        "Limits for `--check`. `median`, `maximum` and `ratio` in this table apply to `like_for_like`. The tables"
        " `total`, `translational` and `like_for_like` take the same three keys. So does the table of an engine that"
        " `--model NAME=...` adds, such as `[acceptance.mine]`; it limits the difference from the equations"
        " that the engine solves. Without such a table the limit is `ratio = 2.0`.",
    ),
    (
        "`[acceptance.demands]`",
        "DemandLimits",
        "acceptance.demands",
        "Limits of what the motions of an ensemble demand. `phase-resonance ensemble --check` exits with 1 where one is"
        " not met. `statistic` says whether they are on the mean or on the largest value over the motions.",
    ),
    (
        "`[analyses]`",
        "Analyses",
        "analyses",
        f"Analyses of the report beside the amplification factors: {', '.join(EVERYTHING.names)}. `--only`, `--skip`"
        " and `--also` of the command line override this table.",
    ),
    (
        "`[[measured]]`",
        "Measured",
        "measured",
        "One table per measured peak. The report compares it with the result of every model and shows both errors. It"
        " changes no result. [Validation](validation.md) says what an experiment must record.",
    ),
)
INTRODUCTION = f"""# The scene file

A scene is a TOML file in UTF-8 of at most 4 MiB. The stem of the file name is its name. `reference/problem/scenes` has
the paper's four cases and `reference/records/examples` two recorded motions. The error for an unknown key says what
it is called here. All wrong keys and values of a file come in one line, in the order of the file, with value and rule.

Every optional key is off by default. "All" models are the paper's equations and the two engine models, translational
and spatial. The spatial model requires all of its own keys except `support_stiffness`, `support_damping`,
`restitution`, `offset`, `yaw` and those of `bars`. It requires no `ring` if the positions of the supports are stated.

One number of a scene may run over a range, which makes one scene for each value:
`friction = {{range = [0.02, 0.2], steps = 10}}` or `friction = {{values = [0.05, 0.1]}}`. Several keys may run if the
file begins with `combine`. `combine = "product"` makes a scene for each combination of the values. `combine = "zip"`
makes a scene of the first values, one of the second, and so on. `motion = "all"` runs over the motions of a suite.
`bounds = [0.8, 1.5]` in `[isolator]` makes two scenes of each, "lower bound" and "upper bound": both coefficients of
friction times these factors. It needs no `combine`.

The duration is at most {MAX_CYCLES:g} times the shortest period of the loading and the pendulum.

This page is written by `python docs/scene_keys.py`.
"""


def page() -> str:
    """The page docs/scene.md as the schema has it."""
    schema = Scene.model_json_schema()
    parts = [INTRODUCTION]
    for heading, model, dotted, introduction in TABLES:
        table = schema["$defs"][model] if model else schema
        head = "| key | meaning | unit | default | range | read by |\n|---|---|---|---|---|---|"
        text = f"{introduction}\n\n" if introduction else ""
        parts.append(f"## {heading}\n\n{text}{head}\n" + "\n".join(_rows(table, dotted)) + "\n")
    return "\n".join(parts)


def _rows(table: dict[str, Any], dotted: str) -> Iterator[str]:
    required = table.get("required", ())
    for key, field in table["properties"].items():
        if key in SET_BY_THE_READER or (not dotted and key in NESTED):
            continue
        default = "required" if key in required else _literal(field.get("default"))
        unit = field["unit"] or "-"
        yield f"| `{key}` | {field['description']} | {unit} | {default} | {_limits(field)} | {field['models']} |"


def _literal(default: Any) -> str:
    return "none" if default is None else f'"{default}"' if isinstance(default, str) else f"{default:g}"


def _limits(field: dict[str, Any]) -> str:
    """Return the range of a key: the stated one, or what its type says."""
    if "range" in field:
        return Range(*field["range"]).text + (", or table" if "$ref" in repr(field) else "")
    kinds = [kind for kind in field.get("anyOf", [field]) if kind.get("type") != "null"]
    if "enum" in kinds[0]:
        return " or ".join(f'"{choice}"' for choice in kinds[0]["enum"])
    if any("$ref" in kind for kind in kinds):
        return "table"
    if kinds[0]["type"] == "boolean":
        return "true or false"
    if kinds[0]["type"] == "array":
        return "list of names"
    if kinds[0]["type"] == "string":
        return "text" if len(kinds) == 1 else "file, or table of files"
    if "exclusiveMinimum" in kinds[0]:
        return f"greater than {kinds[0]['exclusiveMinimum']:g}"
    return f"{kinds[0]['minimum']} or more"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
