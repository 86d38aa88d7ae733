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
from reference.problem import Scene, load_scene

table = load_scene("{scene}").model_dump(exclude_none=True)
scene = Scene.model_validate({{**table, "duration": 0.02}})

def resident():
    return int(open("/proc/self/statm").read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

def call():
    multibody.{function}(scene, {phases}, {settings})

for _ in range({calls}):
    call()
gc.collect()
before = resident()
for _ in range(4 * {calls}):
    call()
gc.collect()
print((resident() - before) / (4 * {calls}))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    ("scene", "function", "phases", "settings"),
    [
        pytest.param("fig3-I", "amplification", "[(0.3, 1.1)]", "loading='plate'", marks=pytest.mark.long),
        pytest.param("fig3-I", "trajectory", "(0.3, 1.1)", "model='spatial'", marks=pytest.mark.long),
        pytest.param("synthetic-pair", "amplification", "[(0.3, 1.1)]", "", marks=pytest.mark.long),
    ],
)
def test_calls_of_the_engine_do_not_grow_the_memory(scene: str, function: str, phases: str, settings: str) -> None:
    script = SCRIPT.format(scene=scene, function=function, phases=phases, settings=settings, calls=CALLS)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert float(done.stdout) < ALLOWED


def test_a_copy_of_a_model_outlives_the_model() -> None:
    scene = load_scene("fig3-I")
    copied = replace(assemble(scene, "translational", 1e-3), allows_liftoff=True)
    gc.collect()
    assert copied.coordinates == 8, "three displacements and rotations of the platform, two of the second body"
