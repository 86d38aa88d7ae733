"""One phase pair by both sides: amplification factors with their errors, and the motion of the platform."""

import matplotlib.pyplot as plt
import numpy as np

import multibody
import reference

scene = reference.load_scene("fig3-I")
phases = (2.0, 0.7)  # rad
sides = {"equations": reference, "engine": multibody}

for name, side in sides.items():
    factors = side.amplification(scene, phases, regularization=1e-3)
    for body, (mu, error) in enumerate(zip(factors.mu, factors.error), start=1):
        print(f"{name}: mu_{body} = {mu:.5f} +- {error:.0e}")

figure, (above, below) = plt.subplots(2, 1, figsize=(8, 5), sharex=True, layout="constrained")
for name, side in sides.items():
    motion = side.trajectory(scene, phases, regularization=1e-3)
    platform = motion.position[:, 0, :2]
    style = "-" if name == "equations" else "--"
    above.plot(motion.time, 1e3 * platform[:, 0], style, label=name)
    below.plot(motion.time, np.hypot(*motion.absolute_acceleration[:, 0, :2].T), style)
above.set(ylabel="platform along x [mm]", xlim=(0, 8))
below.set(ylabel="acceleration [m/s²]", xlabel="time [s]")
above.legend()
figure.savefig("one_point.png", dpi=100)
