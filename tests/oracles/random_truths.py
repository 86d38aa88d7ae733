"""
Writes `random_truths.json`: python tests/oracles/random_truths.py [FIRST LAST]; mu of random scenes, by `oracle`.

Each value comes with its own error: the difference of runs at two tolerances a hundred times apart, that of the coarser
one. Scenes in which the contact opens, or which take an oracle too long, are left out.
"""

import json
import signal
import sys
from pathlib import Path
from typing import Any

import numpy as np
from oracle import RefusalError, answer
from random_loadings import Case, random_case

from reference.problem import Amplification, Outcome

Array = np.ndarray

STORE = Path(__file__).with_name("random_truths.json")
WEAKEST, STRONGEST, SHORTEST, LONGEST = 0.3, 6.0, 0.5, 2.0  # m/s^2; periods of the slower harmonic
LEAST_V_REG = 1e-3  # m/s: slower creep takes an oracle too long
COARSE, FINE = 1e-10, 1e-12
PATIENCE = 90  # s
TRUTHS: list[dict[str, Any]] = json.loads(STORE.read_text()) if STORE.exists() else []
LIKE_FOR_LIKE = [truth for truth in TRUTHS if truth["like_for_like"]]


def case_of(seed: int) -> Case:
    case = random_case(seed, WEAKEST, STRONGEST, SHORTEST, LONGEST)
    return case._replace(regularization=case.regularization and max(case.regularization, LEAST_V_REG))


def asked_of(seed: int, case: Case) -> list[tuple[str, float | None]]:
    """Equations and v_reg: like for like with the engine, and for dry friction also the set-valued law."""
    like_for_like = ("exact", case.regularization)
    if case.regularization is None:
        return [like_for_like]
    return [like_for_like, ("exact" if seed % 2 else "small", None)]


def beyond_and_ratios(truths: list[dict[str, Any]], found: list[Amplification]) -> tuple[Array, Array]:
    """Of every value called ok: whether the truth is beyond its error, and that error over the true one."""
    beyond, ratios = [], []
    for truth, stated in zip(truths, found, strict=True):
        if stated.status[0] == Outcome.OK:
            gap, own = np.abs(stated.mu[0] - truth["mu"]), np.array(truth["error"])
            beyond.append(gap > stated.error[0] + own)
            ratios.append(stated.error[0] / np.maximum(gap, own))
    return np.concatenate(beyond), np.concatenate(ratios)


def give_up(*_: object) -> None:
    raise RuntimeError("too long")


def main(first: int, last: int) -> None:
    kept = {(truth["seed"], truth["equations"], truth["v_reg"]): truth for truth in TRUTHS}
    signal.signal(signal.SIGALRM, give_up)
    for seed in range(first, last):
        case = case_of(seed)
        for equations, v_reg in [] if case.scene.flat else asked_of(seed, case):
            signal.alarm(PATIENCE)
            try:
                law = case.scene, case.phase, equations, v_reg
                coarse, fine = (answer(*law, tolerance).mu[0] for tolerance in (COARSE, FINE))
            except (RefusalError, RuntimeError, AssertionError, ValueError) as fault:
                print(seed, equations, v_reg, repr(fault), flush=True)
                continue
            finally:
                signal.alarm(0)
            error = np.maximum(np.abs(fine - coarse), 1e-14 * fine)
            kept[seed, equations, v_reg] = {
                "seed": seed,
                "equations": equations,
                "v_reg": v_reg,
                "like_for_like": v_reg == case.regularization,
                "mu": fine.tolist(),
                "error": [float(f"{each:.1e}") for each in error],
            }
            STORE.write_text("[\n" + ",\n".join(json.dumps(entry) for entry in kept.values()) + "\n]\n")


if __name__ == "__main__":
    main(*(map(int, sys.argv[1:]) if sys.argv[1:] else (0, 150)))
