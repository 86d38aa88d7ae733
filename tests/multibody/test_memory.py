"""What a call of the engine allocates is freed when it returns."""

import gc
import subprocess
import sys
from dataclasses import replace

import pytest

from multibody.models.assembly import assemble
from reference.problem import load_scene

ALLOWED = 0.01  # MB per call: allocators keep 1 MB for a while; a system that is never reset keeps 0.05 and more
SCRIPT = """
import gc, os, multibody
from reference.problem import load_scene

scene, pair = (load_scene(name).with_values({"duration": 0.02}) for name in ("fig3-I", "synthetic-pair"))

def resident_after(calls):
    for _ in range(calls):
        multibody.amplification(scene, [(0.3, 1.1)], loading="plate")
        multibody.trajectory(scene, (0.3, 1.1), model="spatial")
        multibody.amplification(pair, [(0.3, 1.1)])
    gc.collect()
    return int(open("/proc/self/statm").read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

before = resident_after(60)
print((resident_after(240) - before) / 240)
"""


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_calls_of_the_engine_do_not_grow_the_memory() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    assert float(done.stdout) < ALLOWED


def test_a_copy_of_a_model_outlives_the_model() -> None:
    copied = replace(assemble(load_scene("fig3-I"), "translational", 1e-3), allows_liftoff=True)
    gc.collect()
    assert copied.coordinates == 8, "three displacements and rotations of the platform, two of the second body"
