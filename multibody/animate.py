"""
Look at one motion: `python -m multibody.animate SCENE --phases A1 A2 [--out run.gif]`.

Left: the platform from above, in the plate's frame, with the path of its contact point on every support. Right: the
chain from the side, with the curve on which the platform swings. `--view` opens the engine's own viewer on the same
model.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from multibody.engine import exudyn
from multibody.integrate import place
from multibody.motion import trajectory
from multibody.surface import assembled
from reference.problem import Scene, SceneError, Trajectory, ground_acceleration, load_scene

Array = NDArray[np.float64]

FRAMES_PER_SECOND = 25
RING, SUPPORTS, SPHERE, STOREY = 1.0, 4, 0.05, 1.0  # m, -, m, m: drawn where the scene gives no spatial data


def frames(motion: Trajectory, rate: float) -> Array:
    """Positions (F, N, 3), m, at equally spaced instants, `rate` of them per second of motion."""
    count = max(round(motion.time[-1] * rate), 1) + 1
    instants = np.linspace(motion.time[0], motion.time[-1], count)
    flat = motion.position.reshape(len(motion.time), -1)
    columns = [np.interp(instants, motion.time, column) for column in flat.T]
    return np.stack(columns, axis=-1).reshape(count, *motion.position.shape[1:])


def draw(scene: Scene, motion: Trajectory, out: Path, *, stretch: float, speed: float) -> None:
    """Write the animation to `out` (.gif, or whatever matplotlib can write); displacements drawn `stretch` times."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.animation import FuncAnimation, PillowWriter

    positions = frames(motion, FRAMES_PER_SECOND / speed) * stretch
    figure, (above, side) = plt.subplots(1, 2, figsize=(10.0, 5.5))
    supports = _supports(scene)
    reach = 1.2 * (float(np.abs(supports).max()) + float(np.abs(positions[:, 0, :2]).max()))
    above.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    above.plot(*supports.T, "o", color="0.6", markersize=10, label="supports")
    outline = above.plot([], [], color="tab:blue", label="platform")[0]
    paths = [above.plot([], [], color="tab:red", linewidth=0.8)[0] for _ in supports]
    paths[0].set_label("contact point")
    above.legend(loc="upper right", fontsize="small")

    heights = np.array([STOREY * i if body.height is None else body.height for i, body in enumerate(scene.bodies)])
    side.set(xlim=(-reach, reach), ylim=(-0.3, float(heights[-1]) + 0.6), xlabel="x [m]", ylabel="z [m]")
    swing = np.linspace(-0.5, 0.5, 101) * scene.radius
    for x, _ in supports:
        side.plot(x + swing * stretch, (scene.radius - np.sqrt(scene.radius**2 - swing**2)) * stretch, color="0.8")
    masts = side.plot([], [], "o-", color="tab:blue", markersize=8)[0]
    boxes = [side.plot([], [], color="tab:blue", linewidth=6, solid_capstyle="butt")[0] for _ in heights]
    lever = (scene.isolator.sphere_radius or SPHERE) / scene.radius
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]]) * np.abs(supports).max()
    title = figure.suptitle("")

    def show(frame: int) -> list[Any]:
        now = positions[frame]
        outline.set_data(*(corners + now[0, :2]).T)
        for path, support in zip(paths, supports):
            # on the sphere of radius r, in the direction from the depression's centre to the sphere's
            path.set_data(*(support - lever * positions[: frame + 1, 0, :2]).T)
        masts.set_data(now[:, 0], heights + now[:, 2])
        for i, box in enumerate(boxes):
            box.set_data(now[i, 0] + np.array([-0.4, 0.4]) * reach, [heights[i] + now[i, 2]] * 2)
        seconds = frame * speed / FRAMES_PER_SECOND
        title.set_text(f"{scene.title}\nt = {seconds:.2f} s, displacements x {stretch:g}")
        return [outline, masts, title, *paths, *boxes]

    animation = FuncAnimation(figure, show, frames=len(positions), blit=False)
    writer = PillowWriter(fps=FRAMES_PER_SECOND) if out.suffix == ".gif" else None
    animation.save(str(out), writer=writer)
    plt.close(figure)


def view(scene: Scene, phase: Array, model: str, regularization: float | None) -> None:
    """Run the model in the engine's own viewer. Raises ValueError without a screen."""
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        raise ValueError("--view: no screen: DISPLAY is not set; leave --view out to write a film instead")
    built = assembled(scene, model, regularization)
    penetration = 1e-6
    built.stiffen(penetration)
    built.ground.set_phase(phase)
    state = built.start(None, ground_acceleration(scene, phase, [0.0])[0], penetration)
    place(built, state)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime = scene.duration / built.units.time
    settings.timeIntegration.numberOfSteps = round(scene.duration * 1000.0)
    settings.timeIntegration.realtime.active = True
    settings.timeIntegration.realtime.factor = 1.0 / built.units.time
    container = built.keep_alive[0]
    container.renderer.Start()
    container.renderer.DoIdleTasks()
    built.mbs.SolveDynamic(settings)
    container.renderer.DoIdleTasks()
    container.renderer.Stop()


def _supports(scene: Scene) -> Array:
    """Places of the supports in the plane, (K, 2), m."""
    count = scene.isolator.supports or SUPPORTS
    angles = 2.0 * np.pi * (np.arange(count) + 0.5) / count
    return (scene.isolator.ring or RING) * np.column_stack([np.cos(angles), np.sin(angles)])


def _arguments(words: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m multibody.animate", description=__doc__.splitlines()[1])
    parser.add_argument("scene", help="name of a built-in scene, or a TOML file")
    parser.add_argument("--phases", nargs=2, type=float, required=True, metavar=("A1", "A2"), help="rad")
    parser.add_argument("--model", default="translational")
    parser.add_argument("--regularization", type=float, default=1e-3, help="v_reg, m/s")
    parser.add_argument("--amplitude", type=float, help="largest entry of the amplitude matrix, m/s^2")
    parser.add_argument("--stretch", type=float, default=5.0, help="displacements drawn so many times larger")
    parser.add_argument("--speed", type=float, default=1.0, help="seconds of motion per second of film")
    parser.add_argument("--out", type=Path, default=Path("run.gif"))
    parser.add_argument("--view", action="store_true", help="open the engine's viewer instead of writing a file")
    return parser.parse_args(words)


def main(words: list[str] | None = None) -> int:
    """Exit code 0, or 2 and one line for a wrong scene or option."""
    given = _arguments(words)
    phase = np.array(given.phases)
    try:
        for name in ("stretch", "speed"):
            if not (np.isfinite(getattr(given, name)) and getattr(given, name) > 0.0):
                raise ValueError(f"--{name}: {getattr(given, name)}: must be finite and greater than 0")
        if not given.view and not given.out.parent.is_dir():
            raise ValueError(f"--out: {given.out}: its folder does not exist")
        scene = load_scene(given.scene, given.amplitude)
        if given.view:
            view(scene, phase, given.model, given.regularization)
            return 0
        motion = trajectory(scene, phase, given.model, given.regularization)
    except (SceneError, ValueError) as fault:
        print(fault, file=sys.stderr)
        return 2
    draw(scene, motion, given.out, stretch=given.stretch, speed=given.speed)
    print(f"{given.out}: {motion.time[-1]:.2f} s of motion, status {motion.status}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
