"""
Look at one motion: `python -m multibody.animate SCENE --phases A1 A2 [--model spatial] [--out run.gif]`.

First the boxes from above, in the plate's frame, with the path of the contact point on every support; then the chain
from two sides, with the curve on which the platform's center swings. Boxes turn as the spatial model's do; the title
says how many times displacements, contact paths, tilt and yaw are drawn larger. `--view` opens the engine's own viewer
on the same model.
"""

from __future__ import annotations

import signal

if __name__ == "__main__" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # while modules load Ctrl-C ends the command without a traceback

import argparse
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from multibody.integration.constant_step import set_initial_state
from multibody.integration.work_limit import refusal
from multibody.models.assembly import assemble
from multibody.models.engine import exudyn
from multibody.motion import trajectory
from reference.problem import (
    ADVICE,
    Outcome,
    Scene,
    SceneError,
    Trajectory,
    ground_acceleration,
    load_scene,
    verbatim,
)
from reference.problem.command import OneLineParser, run_command
from reference.problem.files import write_new

Array = NDArray[np.float64]

FRAMES_PER_SECOND = 25
MAX_FRAMES = 1500  # of a film, which is held in memory whole: 3.6 MB each
MAX_STRETCH = 1e6  # times
SUFFIXES = (".gif",)  # of files that can be written with what is installed
RING, SUPPORTS, SPHERE, STOREY = 1.0, 4, 0.05, 1.0  # m, -, m, m: drawn where the scene gives no spatial data
MAX_DRAWN = 0.3  # rad or m, up to which turns and contact paths are magnified
MAX_MAGNIFICATION = 1e4  # times
CORNERS = 0.5 * np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


def frames(time: Array, values: Array, rate: float) -> Array:
    """`values` (T, ...) given at `time` (T,), s, at equally spaced instants (F, ...), `rate` of them per second."""
    count = frame_count(time[-1], FRAMES_PER_SECOND / rate)
    instants = np.linspace(time[0], time[-1], count)
    columns = [np.interp(instants, time, column) for column in values.reshape(len(time), -1).T]
    return np.stack(columns, axis=-1).reshape(count, *values.shape[1:])


def box_corners(center: Array, size: Array, turns: Array) -> Array:
    """Corners (..., 8, 3), m, of boxes at `center` (..., 3), m, turned by Rx(a) Ry(b) Rz(c), `turns` (..., 3), rad."""
    matrices = Rotation.from_euler("XYZ", turns.reshape(-1, 3)).as_matrix().reshape(*turns.shape, 3)
    turned: Array = (CORNERS * np.asarray(size)[..., None, :]) @ np.swapaxes(matrices, -1, -2)
    return center[..., None, :] + turned


def magnified(values: Array, seen: float) -> float:
    """Factor 1, 2 or 5 times a power of ten, at most MAX_MAGNIFICATION, that makes the largest value at most `seen`."""
    largest = float(np.abs(values).max())
    wanted = min(max(seen / largest, 1.0), MAX_MAGNIFICATION) if largest > 0.0 else MAX_MAGNIFICATION
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted))


def contact_paths(scene: Scene, shift: Array, turns: Array) -> Array:
    """
    From each support to its contact point in plan, (F, K, 2), m, for the platform's `shift` and `turns` (F, 3).

    The point lies on the sphere of radius r, in the direction from the depression's center to the sphere's.
    """
    supports = _supports(scene)
    arms = np.column_stack([supports, np.full(len(supports), -(scene.bodies[0].height or 0.0))])
    matrices = Rotation.from_euler("XYZ", turns).as_matrix()
    depressions = shift[:, None, :] + arms @ np.swapaxes(matrices, 1, 2) - arms
    lever = (scene.isolator.sphere_radius or SPHERE) / scene.radius
    paths: Array = -lever * depressions[:, :, :2]
    return paths


def frame_count(duration: float, speed: float) -> int:
    """Frames of a film of so many s of motion, `speed` of them per second of film."""
    return max(round(min(duration * FRAMES_PER_SECOND / speed, 1e9)), 1) + 1


def refuse_film(scene: Scene, out: Path, stretch: float, speed: float) -> None:
    """Raise ValueError, one line, if no film can be written to `out` or it would be absurd: before anything is run."""
    if not (np.isfinite(stretch) and 0.0 < stretch <= MAX_STRETCH):
        raise ValueError(f"--stretch: {stretch}: must be greater than 0 and at most {MAX_STRETCH:g}")
    if not (np.isfinite(speed) and speed > 0.0):
        raise ValueError(f"--speed: {speed}: must be finite and greater than 0")
    fastest = scene.duration * FRAMES_PER_SECOND
    slowest = fastest / (MAX_FRAMES - 1)
    if speed > fastest or frame_count(scene.duration, speed) > MAX_FRAMES:
        raise ValueError(
            f"--speed: {speed:g}: a film of {scene.duration:g} s of motion has 2 to {MAX_FRAMES} frames, "
            f"{FRAMES_PER_SECOND} per second: give {slowest:.2g} to {fastest:.2g}"
        )
    if out.is_dir():
        raise ValueError(f"--out: {out}: is a folder: give the name of a {' or '.join(SUFFIXES)} file")
    if out.suffix.lower() not in SUFFIXES:
        raise ValueError(f"--out: {out}: must end in {' or '.join(SUFFIXES)}")
    if not out.parent.is_dir():
        raise ValueError(f"--out: {out}: its folder does not exist")
    if not os.access(out if out.exists() else out.parent, os.W_OK):
        raise ValueError(f"--out: {out}: cannot be written")


def draw(scene: Scene, motion: Trajectory, out: Path, *, stretch: float, speed: float) -> Path:
    """
    Write the animation to `out`, GIF; displacements drawn `stretch` times. The motion has at least one instant.

    Returns
    -------
    Path
        The film: `out`, or beside it under the next free name if something is there.
    """
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.animation import FuncAnimation, PillowWriter
    from matplotlib.patches import Circle

    rate = FRAMES_PER_SECOND / speed
    shifts = frames(motion.time, motion.position, rate)
    turns = frames(motion.time, motion.extra.get("turns", np.zeros_like(motion.position)), rate)
    tilt, yaw = magnified(turns[..., :2], MAX_DRAWN), magnified(turns[..., 2], MAX_DRAWN)
    supports, heights, sizes = _supports(scene), *_boxes(scene)
    rest = heights[:, None] * np.array([0.0, 0.0, 1.0])
    corners = box_corners(rest + shifts * stretch, sizes, turns * np.array([tilt, tilt, yaw]))
    paths = contact_paths(scene, shifts[:, 0], turns[:, 0])
    closer = magnified(paths, MAX_DRAWN)
    paths = supports + paths * closer

    figure, panels = plt.subplots(1, 3, figsize=(15.0, 6.0))
    figure.subplots_adjust(left=0.05, right=0.99, bottom=0.2, top=0.86, wspace=0.2)
    reach = 1.08 * float(np.abs(corners[..., :2]).max())
    low, high = float(corners[..., 2].min()) - 0.15, float(corners[..., 2].max()) + 0.15
    colors = [f"C{i}" for i in range(len(heights))]
    outlines = []  # panel by panel, each body's
    for panel, axes in zip(panels, ((0, 1), (0, 2), (1, 2))):
        names = ["xyz"[axis] for axis in axes]
        panel.set(xlim=(-reach, reach), aspect="equal", xlabel=f"{names[0]} [m]", ylabel=f"{names[1]} [m]")
        panel.set(ylim=(-reach, reach) if axes[1] == 1 else (low, high))
        for i, color in enumerate(colors):
            name = f"body {i + 1}" if i else "platform"
            outline = panel.fill([0.0], [0.0], facecolor=color, edgecolor=color, alpha=0.35, label=name)[0]
            outlines.append((outline, i, list(axes)))

    above, *sides = panels
    above.add_patch(Circle((0.0, 0.0), float(np.hypot(*supports[0])), fill=False, color="0.5", linestyle=":"))
    above.plot(*supports.T, "o", color="0.4", markersize=6, label="supports on their ring")
    lines = [above.plot([], [], color="tab:red", linewidth=1.0)[0] for _ in supports]
    lines[0].set_label("path of the contact point")
    points = above.plot([], [], ".", color="tab:red", markersize=6)[0]
    swing = np.linspace(-0.25, 0.25, 101) * scene.radius
    rise = scene.radius - np.sqrt(scene.radius**2 - swing**2)
    masts = []
    for axis, side in enumerate(sides):
        for support in supports[:, axis]:  # the sphere's center stands rho above the depression's
            side.plot([support, support], [low, scene.radius], color="0.5", linewidth=1.5)
            side.plot(support, scene.radius, "o", color="0.4", markersize=6)
        side.plot(swing * stretch, heights[0] + rise * stretch, ":", color="0.2", label="swing of the center")
        masts.append(side.plot([], [], "o-", color="0.2", markersize=3, linewidth=1.0)[0])
    handles = dict(zip(*reversed(above.get_legend_handles_labels())))
    handles |= dict(zip(*reversed(sides[0].get_legend_handles_labels())))
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=len(handles), fontsize="small")
    for panel, view_from in zip(panels, ("from above", "along y", "along x")):
        panel.set_title(view_from, fontsize="medium")
    title = figure.suptitle("")
    scales = f"displacements x {stretch:g}, contact paths x {closer:g}"
    if "turns" in motion.extra:
        scales += f", tilt x {tilt:g}, yaw x {yaw:g}"

    def show(frame: int) -> list[Any]:
        for outline, body, axes in outlines:
            flat = corners[frame, body][:, axes]
            outline.set_xy(flat[ConvexHull(flat).vertices])
        for line, path in zip(lines, np.swapaxes(paths, 0, 1)):
            line.set_data(*path[: frame + 1].T)
        points.set_data(*paths[frame].T)
        centers = rest + shifts[frame] * stretch
        for axis, mast in enumerate(masts):
            mast.set_data(centers[:, axis], centers[:, 2])
        title.set_text(f"{verbatim(scene.title)}\nt = {frame / rate:.2f} s; {scales}")
        return [title, points, *lines, *masts, *(outline for outline, _, _ in outlines)]

    animation = FuncAnimation(figure, show, frames=len(shifts), blit=False)
    with tempfile.TemporaryDirectory() as folder:
        film = Path(folder) / out.name
        animation.save(str(film), writer=PillowWriter(fps=FRAMES_PER_SECOND))
        plt.close(figure)
        return write_new(out, film.read_bytes())


def view(scene: Scene, phase: Array, model: str, regularization: float | None) -> None:
    """Run the model in the engine's own viewer. Raises ValueError without a screen."""
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        raise ValueError("--view: no screen: DISPLAY is not set; leave --view out to write a film instead")
    built = assemble(scene, model, regularization)
    penetration = 1e-6
    built.set_contact(penetration)
    built.ground.set_phase(phase)
    state = built.start(None, ground_acceleration(scene, phase, [0.0])[0], penetration)
    set_initial_state(built, state)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime = scene.duration / built.units.time
    settings.timeIntegration.numberOfSteps = round(scene.duration * 1000.0)
    settings.timeIntegration.realtime.active = True
    settings.timeIntegration.realtime.factor = 1.0 / built.units.time
    container = built.container
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


def _boxes(scene: Scene) -> tuple[Array, Array]:
    """Heights (N,) and sizes (N, 3) of the bodies, m."""
    heights = [0.2 + STOREY * i if body.height is None else body.height for i, body in enumerate(scene.bodies)]
    width = 2.0 * (scene.isolator.ring or RING)
    sizes = [[width, width, 0.2 * STOREY] if body.size is None else body.size for body in scene.bodies]
    return np.array(heights), np.array(sizes)


def _arguments(words: list[str] | None) -> argparse.Namespace:
    parser = OneLineParser("python -m multibody.animate", __doc__.splitlines()[1])
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
    try:
        options = _arguments(words)
        phase = np.array(options.phases)
        scene = load_scene(options.scene, options.amplitude)
        if options.view:
            view(scene, phase, options.model, options.regularization)
            return 0
        refuse_film(scene, options.out, options.stretch, options.speed)
        motion = trajectory(scene, phase, options.model, options.regularization)
        if len(motion.time) == 0:
            reason = refusal(scene, options.model, options.regularization, full=True) or ADVICE[Outcome(motion.status)]
            raise ValueError(f"{scene.name}: there is no motion to show: {motion.status}: {reason}")
    except (SceneError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    film = draw(scene, motion, options.out, stretch=options.stretch, speed=options.speed)
    if film != options.out:
        print(f"{options.out} exists and stays: the film is in {film}", file=sys.stderr)
    print(f"{film}: {motion.time[-1]:.2f} s of motion, status {motion.status}")
    return 0


if __name__ == "__main__":
    run_command(main)
