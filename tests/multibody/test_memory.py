"""What a call of the engine allocates is freed when it returns."""

import gc
import subprocess
import sys
from dataclasses import replace

import pytest

from multibody.models.assembly import assemble
from reference.problem import load_scene

CALLS = 60
ALLOWED = 0.01  # MB per call: allocators keep 1 MB for a while; a system that is never reset keeps 0.05 and more
SCRIPT = """
import gc, os
import multibody
from reference.problem import load_scene

scene = load_scene("{scene}").with_values({{"duration": 0.02}})

def resident_after(calls):
    for _ in range(calls):
        multibody.{call}
    gc.collect()
    return int(open("/proc/self/statm").read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

before = resident_after({calls})
print((resident_after(4 * {calls}) - before) / (4 * {calls}))
"""


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    ("scene", "call"),
    [
        ("fig3-I", "amplification(scene, [(0.3, 1.1)], loading='plate')"),
        ("fig3-I", "trajectory(scene, (0.3, 1.1), model='spatial')"),
        ("synthetic-pair", "amplification(scene, [(0.3, 1.1)])"),
    ],
)
def test_calls_of_the_engine_do_not_grow_the_memory(scene: str, call: str) -> None:
    script = SCRIPT.format(scene=scene, call=call, calls=CALLS)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert float(done.stdout) < ALLOWED


def test_a_copy_of_a_model_outlives_the_model() -> None:
    scene = load_scene("fig3-I")
    copied = replace(assemble(scene, "translational", 1e-3), allows_liftoff=True)
    gc.collect()
    assert copied.coordinates == 8, "three displacements and rotations of the platform, two of the second body"
