"""
Look at one motion: `python -m multibody.animate SCENE --phases A1 A2 [--model spatial] [--out run.gif]`.

The film shows the boxes from above, in the plate's frame, with the path of the contact point on every support, and the
chain from two sides (`film`). `--view` opens the engine's own viewer on the same model.
"""

from __future__ import annotations

import signal

if __name__ == "__main__" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # while modules load Ctrl-C ends the command without a traceback

import argparse
import os
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from multibody.defaults import DEFAULT_PENETRATION, DEFAULT_V_REG
from multibody.film import FilmSettings, draw_film
from multibody.integration.constant_step import set_initial_state
from multibody.integration.refine import MAX_WORK
from multibody.integration.work_limit import refusal
from multibody.models.assembly import assemble
from multibody.models.engine import exudyn
from multibody.motion import trajectory
from reference.problem import (
    ADVICE,
    Outcome,
    Scene,
    SceneError,
    ground_acceleration,
    load_scene,
)
from reference.support.arguments import quote
from reference.support.command import OneLineParser, run_command
from reference.support.files import write_new

Array = NDArray[np.float64]

# Largest number of frames of a film: the paths of the contact points are drawn anew in each frame.
MAX_FRAMES = 1500

# Largest factor on displacements that --stretch accepts.
MAX_STRETCH_FACTOR = 1e6

# Frame rates, 1/s, that --rate accepts: a frame of a GIF lasts a whole number of hundredths of a second.
FRAME_RATES = (1, 2, 4, 5, 10, 20, 25, 50)

# Smallest and largest width and height, pixels, that --size accepts.
FRAME_SIZES = (320, 4000)

# File name endings that --out accepts: one for each format that the installed packages can write.
FILE_SUFFIXES = (".gif",)

# Number of steps per second of motion in the run of the viewer.
VIEWER_STEPS_PER_SECOND = 1000.0


def count_frames(duration: float, settings: FilmSettings) -> int:
    """Return the number of frames of a film of `duration` s of motion."""
    return max(round(min(duration * settings.rate / settings.speed, 1e9)), 1) + 1


def check_film_options(scene: Scene, out: Path, settings: FilmSettings) -> None:
    """Raise ValueError, one line, if no film can be written to `out` or a setting is out of its bounds."""
    if not (np.isfinite(settings.stretch) and 0.0 < settings.stretch <= MAX_STRETCH_FACTOR):
        raise ValueError(f"--stretch: {settings.stretch}: must be greater than 0 and at most {MAX_STRETCH_FACTOR:g}")
    if settings.rate not in FRAME_RATES:
        raise ValueError(
            f"--rate: {settings.rate}: must be {', '.join(map(str, FRAME_RATES[:-1]))} or {FRAME_RATES[-1]} per second"
        )
    if not all(FRAME_SIZES[0] <= pixels <= FRAME_SIZES[1] for pixels in settings.size):
        raise ValueError(
            f"--size: {settings.size[0]} {settings.size[1]}: must be {FRAME_SIZES[0]} to {FRAME_SIZES[1]} pixels each"
        )
    if not (np.isfinite(settings.speed) and settings.speed > 0.0):
        raise ValueError(f"--speed: {settings.speed}: must be finite and greater than 0")
    fastest = scene.duration * settings.rate
    slowest = fastest / (MAX_FRAMES - 1)
    if settings.speed > fastest or count_frames(scene.duration, settings) > MAX_FRAMES:
        raise ValueError(
            f"--speed: {settings.speed:g}: a film of {scene.duration:g} s of motion has 2 to {MAX_FRAMES} frames, "
            f"{settings.rate} per second: give {slowest:.2g} to {fastest:.2g}"
        )
    if os.path.isdir(out):
        raise ValueError(f"--out: {out}: is a folder: give the name of a {' or '.join(FILE_SUFFIXES)} file")
    if out.suffix.lower() not in FILE_SUFFIXES:
        raise ValueError(f"--out: {out}: must end in {' or '.join(FILE_SUFFIXES)}")
    if not os.path.isdir(out.parent):
        raise ValueError(f"--out: {out}: its folder does not exist")
    if not os.access(out if os.path.exists(out) else out.parent, os.W_OK):
        raise ValueError(f"--out: {out}: cannot be written")


def open_viewer(scene: Scene, phase: Array, model: str, regularization: float | None) -> None:
    """Run a model of the scene in the engine's own viewer. Raises ValueError without a screen."""
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        raise ValueError("--view: no screen: DISPLAY is not set; leave --view out to write a film instead")
    built = assemble(scene, model, regularization)
    built.set_contact(DEFAULT_PENETRATION)
    built.ground.set_phase(phase)
    state = built.start(None, ground_acceleration(scene, phase, [0.0])[0], DEFAULT_PENETRATION)
    set_initial_state(built, state)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime = scene.duration / built.units.time
    settings.timeIntegration.numberOfSteps = round(scene.duration * VIEWER_STEPS_PER_SECOND)
    settings.timeIntegration.realtime.active = True
    settings.timeIntegration.realtime.factor = 1.0 / built.units.time
    container = built.container
    container.renderer.Start()
    container.renderer.DoIdleTasks()
    built.mbs.SolveDynamic(settings)
    container.renderer.DoIdleTasks()
    container.renderer.Stop()


def _parse_arguments(words: list[str] | None) -> argparse.Namespace:
    """Return the options of the command line, given as `words` or else to the process."""
    parser = OneLineParser("python -m multibody.animate", __doc__.splitlines()[1])
    parser.add_argument("scene", help="name of a built-in scene, or a TOML file")
    parser.add_argument("--phases", nargs=2, type=float, required=True, metavar=("A1", "A2"), help="rad")
    parser.add_argument("--model", default="translational")
    parser.add_argument("--regularization", type=float, default=DEFAULT_V_REG, help="v_reg, m/s")
    parser.add_argument("--amplitude", type=float, help="largest entry of the amplitude matrix, m/s^2")
    parser.add_argument(
        "--max-work", type=float, default=MAX_WORK, help="most steps of the engine, %(default)g if not given"
    )
    parser.add_argument(
        "--stretch", type=float, default=FilmSettings.stretch, help="factor on the displacements as drawn"
    )
    parser.add_argument("--speed", type=float, default=FilmSettings.speed, help="seconds of motion per second of film")
    parser.add_argument(
        "--rate", type=int, default=FilmSettings.rate, help=f"frames per second, {FilmSettings.rate} if not given"
    )
    size = "pixels, {} {} if not given".format(*FilmSettings.size)
    parser.add_argument("--size", nargs=2, type=int, default=FilmSettings.size, metavar=("W", "H"), help=size)
    parser.add_argument("--out", type=Path, default=Path("run.gif"))
    parser.add_argument("--view", action="store_true", help="open the engine's viewer instead of writing a file")
    return parser.parse_args(words)


def main(words: list[str] | None = None) -> int:
    """Run the command; return exit code 0, 2 for a wrong scene or option, or 3 if the film cannot be written."""
    try:
        options = _parse_arguments(words)
        phase = np.array(options.phases)
        scene = load_scene(options.scene, options.amplitude)
        if options.view:
            open_viewer(scene, phase, options.model, options.regularization)
            return 0
        settings = FilmSettings(options.stretch, options.speed, options.rate, tuple(options.size))
        check_film_options(scene, options.out, settings)
        motion = trajectory(scene, phase, options.model, options.regularization, max_work=options.max_work)
        if len(motion.time) == 0:
            why = refusal(scene, options.model, options.regularization, full=True, max_work=options.max_work)
            reason = why or ADVICE[Outcome(motion.status)]
            raise ValueError(f"{scene.name}: there is no motion to show: {motion.status}: {reason}")
    except (SceneError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    count = count_frames(float(motion.time[-1]), settings)
    try:
        written = write_new(options.out, draw_film(scene, motion, options.model, settings, count))
    except OSError as error:
        print(f"command line: --out = {quote(str(options.out))}: could not be written: {error}", file=sys.stderr)
        return 3
    if written != options.out:
        print(f"{options.out} exists and stays: the film is in {written}", file=sys.stderr)
    print(f"{written}: {motion.time[-1]:.2f} s of motion, status {motion.status}")
    return 0


if __name__ == "__main__":
    run_command(main)
