"""The question that other codes are asked, answered from its file alone."""

import json
from types import SimpleNamespace

import compare_engines
import numpy as np
from pages import ROOT
from scipy.integrate import solve_ivp

DOCS = ROOT / "docs"
QUESTION = json.loads((DOCS / "question.json").read_text(encoding="utf-8"))
V_REG = 1e-3


def test_the_file_of_the_question_is_enough_to_answer_it():
    """Newton-Euler on the sphere by SciPy, friction linear below v_reg."""
    name, pair = "fig3-II", 21
    scene, phase = QUESTION["scenes"][name], np.array(QUESTION["phases"][pair])
    masses, stiffness, amplitude, omega, decay = (
        np.array(scene[key]) for key in ("masses", "stiffness", "amplitude", "omega", "decay")
    )
    bodies, total, radius = len(masses), masses.sum(), scene["radius"]

    def ground(t):
        return (np.exp(-decay * t) * np.cos(omega * t + phase)) @ amplitude.T

    def accelerations(t, y):
        x, v = y.reshape(2, bodies, 2)
        u = ground(t)
        a = np.diff(stiffness * np.diff(x, axis=0), axis=0, prepend=0.0, append=0.0) / masses[:, None] - u[:2]
        height = np.sqrt(radius**2 - x[0] @ x[0])
        normal, velocity = np.append(-x[0], height) / radius, np.append(v[0], x[0] @ v[0] / height)
        speed = np.linalg.norm(velocity)
        push = normal - scene["friction"] * velocity / max(speed, V_REG)
        free, inverse = np.append(a[0], -scene["gravity"] - u[2]), 1.0 / np.array([masses[0], masses[0], total])
        platform = free + inverse * push * (speed**2 / radius - normal @ free) / (normal @ (inverse * push))
        a[0] = platform[:2]
        return a, np.column_stack([a + u[:2], np.full(bodies, u[2] + platform[2])])

    def slope(t, y):
        return np.append(y[2 * bodies :], accelerations(t, y)[0])

    span = 0.0, scene["duration"]
    run = solve_ivp(slope, span, np.zeros(4 * bodies), "LSODA", rtol=1e-7, atol=1e-9, dense_output=True)
    times = np.interp(np.arange(0.0, len(run.t) - 1.0, 0.5), np.arange(len(run.t)), run.t)
    largest = np.max([np.linalg.norm(accelerations(t, run.sol(t))[1], axis=1) for t in times], axis=0)
    mu = largest / np.linalg.norm(ground(np.linspace(*span, 20_001)[:, None]), axis=1).max()
    np.testing.assert_allclose(mu, scene["mu"]["regularized"][pair], rtol=2e-4)


def test_the_page_of_engines_and_the_question_are_as_measured_and_as_asked(monkeypatch):
    nothing = SimpleNamespace(mu=np.zeros((64, 2)), error=np.zeros((64, 2)))
    monkeypatch.setattr(compare_engines.reference, "amplification", lambda *rest, **law: nothing)
    asked = compare_engines.question()
    for made, kept in zip(asked["scenes"].values(), QUESTION["scenes"].values()):
        made.update(mu=kept["mu"], error=kept["error"])
    assert asked == QUESTION
    order = [engine.name for engine in compare_engines.ENGINES]
    rows = json.loads((DOCS / "engines.json").read_text(encoding="utf-8"))
    rows.sort(key=lambda row: (row["scene"], order.index(row["engine"]), row["seconds"]))
    text, page = compare_engines._page(rows), (DOCS / "engines.md").read_text(encoding="utf-8")
    assert text.split("\nMeasured with")[0] == page.split("\nMeasured with")[0]
