"""An own building: what the motions over all phases demand of every floor, by the equations and by the engine."""

import matplotlib.pyplot as plt
import numpy as np

import multibody
import reference

FLOORS = 5
links = [{"mass": 40e3, "stiffness": (60e6 - 6e6 * floor,) * 2, "damping": 0.02} for floor in range(FLOORS)]
scene = reference.Scene.model_validate(
    {
        "title": "six bodies on friction pendulums",
        "duration": 15.0,  # s
        "isolator": {"radius": 2.24, "friction": 0.05, "travel": 0.4},
        "bodies": [{"mass": 60e3}, *links],
        "excitation": {"amplitudes": [[1.5, 1.0], [1.0, -1.5]], "periods": [0.6, 1.2], "decay": [0.3, 0.2]},
    }
)
print("natural periods [s]:", (2 * np.pi / reference.modes(scene).frequency[0]).round(2))

phases = reference.phase_grid(4)
equations = reference.peak_demands(scene, phases, regularization=1e-3)  # m/s, the law of friction that the engine has
engine = multibody.peak_demands(scene, phases[:3], regularization=1e-3)  # takes longer: a check at three phase pairs
for name in ("displacement", "base_shear"):
    demand = equations[name]
    worst = demand.value.argmax()
    print(f"{name}: {demand.value[worst]:.4g} +- {demand.error[worst]:.1g} at phases {phases[worst].round(2)}")

figure, axes = plt.subplots(1, 2, figsize=(8, 4.5), sharey=True, layout="constrained")
for axis, name, scale, label in (
    (axes[0], "acceleration", 1.0, "largest acceleration [m/s²]"),
    (axes[1], "drift", 1e3, "largest drift of the link below [mm]"),
):
    values = scale * equations[name].value
    level = np.arange(FLOORS + 1)[-values.shape[1] :]
    axis.fill_betweenx(level, values.min(axis=0), values.max(axis=0), alpha=0.3, label="equations, all phases")
    axis.plot(np.median(values, axis=0), level, label="equations, median")
    axis.plot(scale * engine[name].value.T, level, "k.", label="engine, three phase pairs")
    axis.set_xlabel(label)
axes[0].set(ylabel="body above the platform", xlim=(0, None))
handles, names = axes[0].get_legend_handles_labels()
axes[0].legend(handles[:3], names[:3], fontsize="small")
figure.savefig("own_building.png", dpi=100)
