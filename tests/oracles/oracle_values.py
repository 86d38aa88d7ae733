"""
Writes `oracle_values.json`: python tests/oracles/oracle_values.py [NAME ...]; all cases take half an hour.

Each number comes with the difference of runs at two tolerances a hundred times apart, which is the error of the coarser
one and so an upper estimate for the finer one that is kept.
"""

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from oracle import CREEP_IS_STIFF, RefusalError, answer
from oracle_cases import CASES, CUTOFFS, SET_VALUED, Case, scene_of

STORE = Path(__file__).with_name("oracle_values.json")
COARSE, FINE = 1e-10, 1e-12
STIFF_COARSE, STIFF_FINE = 1e-9, 1e-11  # the implicit method pays more for each digit


def solved(case: Case) -> dict[str, Any]:
    stiff = case.regularization is not None and case.regularization < CREEP_IS_STIFF
    cutoffs, law = CUTOFFS if case in SET_VALUED else (0.0,), (case.phase, case.equations, case.regularization)
    tolerances = (STIFF_COARSE, STIFF_FINE) if stiff else (COARSE, FINE)
    coarse, fine = (answer(scene_of(case.scene), *law, tolerance, cutoffs) for tolerance in tolerances)
    return {
        "name": case.name,
        **asdict(case),
        "cutoff": list(cutoffs),
        "mu": fine.mu.tolist(),
        "error": np.maximum(np.abs(fine.mu - coarse.mu), 1e-12).tolist(),
        "position": fine.position.tolist(),
        "position_error": float(np.abs(fine.position - coarse.position).max()),
        "swing": fine.swing,
        "rests": fine.rests,
        "same_rests": len(fine.rests) == len(coarse.rests),
    }


def main(names: list[str]) -> None:
    known = {e["name"]: e for e in json.loads(STORE.read_text())} if STORE.exists() else {}
    for case in CASES:
        if names and case.name not in names:
            continue
        try:
            known[case.name] = solved(case)
        except (RefusalError, RuntimeError) as fault:
            print(f"{case.name}: {fault!r}", flush=True)
            continue
        kept = known[case.name]
        print(case.name, kept["mu"][0], np.max(kept["error"]), kept["swing"], len(kept["rests"]), flush=True)
        ordered = [known[c.name] for c in CASES if c.name in known]
        STORE.write_text("[\n" + ",\n".join(json.dumps(entry) for entry in ordered) + "\n]\n")


if __name__ == "__main__":
    main(sys.argv[1:])
