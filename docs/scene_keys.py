"""Write docs/scene.md, the table of every key of a scene file, from the schema: `python docs/scene_keys.py`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from comparison.study.analyses import ANALYSES
from reference.problem import Scene
from reference.problem.ranges import MAX_CYCLES, SCENE

PAGE = Path(__file__).with_name("scene.md")
SET_BY_THE_READER = {"name", "samples"}  # fields of the models that are no keys of a file
NESTED = {"isolator", "bodies", "excitation", "acceptance", "analyses", "measured"}
TABLES = (  # heading, model in the schema, dotted name, introduction
    ("At the top of the file", "", "", ""),
    ("`[isolator]`", "Isolator", "isolator", "The spherical gravity-friction isolator under the platform."),
    (
        "`isolator.friction` as a table",
        "VelocityFriction",
        "isolator.friction",
        "Friction that depends on the slip speed, mu(v) = fast - (fast - slow) exp(-rate v), as in friction-pendulum"
        " practice: `friction = {slow = 0.03, fast = 0.06, rate = 100.0}`. It holds the platform at rest with `slow`."
        " Regularized it is mu(v) min(1, v / v_reg). `load_exponent` n multiplies it by (N / N_ref)^n, with N the"
        " normal force, in the spatial model of each support against its share of N_ref; `slow` may then stand alone."
        " Each number may run over a range.",
    ),
    (
        "`heating` of `isolator.friction`",
        "Heating",
        "isolator.friction.heating",
        "`[isolator.friction.heating]`: the coefficients are those at 20 degrees C, and the heat of sliding multiplies"
        " them by 0.79 (0.7^(0.02 T) + 0.4). T is the temperature at the center of the track, by conduction into a half"
        " space: T0 + sqrt(D / pi) / k times the integral of q(t - s) / sqrt(s), with q the power of friction over the"
        " area of the contact. It is heated while the slider covers it, up to a displacement of sqrt(pi) / 2 of"
        " `contact_radius`. This is the law of FPBearingPTV in OpenSees and of MASTODON. `slow` may then stand alone.",
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
        " (2.3), k = 12 n E J / l^3. `period` and `stiffness` state a link as it is under the weight that it carries;"
        " `bars` state it without load. Where a study has such a scene, its last model softens them by the weight above"
        " them at rest, `Scene.softened()`: P / (l (tan x / x - 1)) of each bar under the load P,"
        " x = (l / 2) sqrt(P / EJ). `load_effect` softens them in every model. Bars that would buckle, at"
        " P = pi^2 EJ / l^2, are refused then. In the spatial model `axial_stiffness` makes the link a clamped beam in"
        " every direction; bars that could not hold the bodies upright are refused.",
    ),
    ("`[excitation]`, two frequencies", "Excitation", "excitation", "Ground acceleration (5.2)-(5.4)."),
    ("`[excitation]`, recorded motion", "Record", "excitation", "A record in place of the two frequencies."),
    (
        "`[acceptance]`",
        "Acceptance",
        "acceptance",
        "Limits for `--check`. `median`, `maximum` and `ratio` here are those of `like_for_like`; the tables `total`,"
        " `translational` and `like_for_like` take the same three keys. So does a table with the name of an engine that"
        " joins the study with `--model NAME=...`, as `[acceptance.mine]`: its difference from the equations.",
    ),
    (
        "`[analyses]`",
        "Analyses",
        "analyses",
        f"What the report tells of the scene beside its amplification factors: {', '.join(ANALYSES)}. `--only`,"
        " `--skip` and `--also` of the command line come before it.",
    ),
    (
        "`[[measured]]`",
        "Measured",
        "measured",
        "One table per measured peak. The report sets it beside what every model computes, with both errors; it changes"
        " no result. [Validation](validation.md) says what an experiment must record.",
    ),
)
INTRODUCTION = f"""# The scene file

A scene is a TOML file in UTF-8 of at most 4 MiB. Its name is the stem of the file. `reference/problem/scenes` has the
paper's four cases and `reference/problem/examples` two recorded motions. An unknown key is an error that names the
nearest valid keys; a wrong value is an error in one line with file, key, value and rule.

Every optional key is off by default. "All" models are the paper's equations and the two engine models, translational
and spatial; the spatial model needs every key of its own but `support_stiffness`, `support_damping`, `restitution`,
`offset`, `yaw` and those of `bars`, and no `ring` with positions of supports.

One number of a scene may run over a range, which makes one scene of every value:
`friction = {{range = [0.02, 0.2], steps = 10}}` or `friction = {{values = [0.05, 0.1]}}`. Several keys may run where
the file begins with `combine = "product"`, a scene of every combination of the values, or `combine = "zip"`, a scene of
the first values, one of the second, and so on. `motion = "all"` runs over the motions of a suite.

The duration is at most {MAX_CYCLES:g} periods, of the shortest period of the loading and the pendulum.

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
        limits = _limits(f"{dotted}.{key}" if dotted else key, field)
        yield f"| `{key}` | {field['description']} | {unit} | {default} | {limits} | {field['models']} |"


def _literal(default: Any) -> str:
    return "none" if default is None else f"{default:g}"


def _limits(key: str, field: dict[str, Any]) -> str:
    """The range of a key: the one that `ranges.SCENE` states, or what its type says."""
    if key in SCENE:
        allowed = SCENE[key]
        table = ", or table" if any(part.startswith(f"{key}.") for part in SCENE) else ""
        return f"{allowed.lowest:g} to {allowed.highest:g}{', or inf' if allowed.or_infinite else ''}{table}"
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
