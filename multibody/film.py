"""
Film of one motion as a GIF: the boxes from above with the paths of the contact points, and the chain from two sides.

What moves is drawn frame by frame on a background that is drawn once. Displacements, contact paths, tilt and yaw are
magnified. Heights are scaled so that the whole frame fits, its boxes stay apart, and the poles of the supports end
below the platform. The caption names every factor.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from reference.problem import Scene, Trajectory
from reference.support.drawing import escape_for_matplotlib

Array = NDArray[np.float64]

# Radii, m, of the ring of supports and of the spheres with which a scene without spatial data is drawn.
SUPPORT_RING_RADIUS, SPHERE_RADIUS = 1.0, 0.05
# Places (K, 2), m, of the supports with which a scene without spatial data is drawn.
DEFAULT_SUPPORTS = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * SUPPORT_RING_RADIUS / np.sqrt(2.0)

# Distance and thickness of the boxes of a scene without spatial data, as shares of the width of a box.
BOX_DISTANCE, BOX_THICKNESS = 0.5, 0.1

# Smallest and largest drawn height of the highest box above the lowest, as shares of the width of the widest box.
MIN_SPAN, MAX_SPAN = 0.35, 1.2

# Largest thickness of a drawn box, and largest drop of its edge by tilt, as shares of the smallest distance of boxes.
MAX_DRAWN_THICKNESS, MAX_DRAWN_DIP = 0.4, 0.2

# Largest drawn rotation, rad; also the longest drawn contact path, as a share of the distance of the farthest support.
MAX_DRAWN_ROTATION = 0.3
MAX_MAGNIFICATION = 1e4  # largest factor on drawn rotations and contact paths

# Length of the vertical line below the platform that stands for a support, as a share of the width of the drawing.
POLE_LENGTH = 0.15

# Width of the figure, inches, for any number of pixels, so that the layout does not depend on the pixels.
LAYOUT_WIDTH = 12.0

# Number of colors of a film; a GIF has 256, and one stands for unchanged pixels.
COLOR_COUNT = 255

# corners (8, 3) of a cube with edges of length 1, centered at the origin
UNIT_BOX_CORNERS = 0.5 * np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


@dataclass(frozen=True)
class FilmSettings:
    """
    Settings of a film.

    stretch: factor by which displacements are drawn larger. speed: seconds of motion in a second of the film. rate:
    frames per second of the film. size: width and height of a frame, pixels.
    """

    stretch: float = 5.0
    speed: float = 1.0
    rate: int = 25
    size: tuple[int, int] = (1200, 480)


@dataclass(frozen=True)
class Drawing:
    """
    Magnified geometry of a motion, in m, in F frames, with N bodies and K supports.

    corners: corners of the boxes, (F, N, 8, 3). centers: centers of mass, (F, N, 3). supports: places, (K, 2). paths:
    places of the contact points, (F, K, 2). swing_curve: x and z, (S, 2), of the curve on which the platform's center
    moves, from its place at rest. rest_place: x and y of that place, (2,). scales: the magnification factors in words.
    """

    corners: Array
    centers: Array
    supports: Array
    paths: Array
    swing_curve: Array
    rest_place: Array
    scales: str

    @property
    def half_width(self) -> float:
        """Half of the width of the drawing, m, in which all boxes and supports have room."""
        return 1.08 * float(max(np.abs(self.corners[..., :2]).max(), np.abs(self.supports).max()))


def sample_frames(time: Array, values: Array, count: int) -> Array:
    """Return `values` (T, ...), given at `time` (T,), s, at `count` equally spaced instants, (F, ...)."""
    instants = np.linspace(time[0], time[-1], count)
    columns = [np.interp(instants, time, column) for column in values.reshape(len(time), -1).T]
    return np.stack(columns, axis=-1).reshape(count, *values.shape[1:])


def locate_box_corners(center: Array, size: Array, turns: Array) -> Array:
    """
    Return the corners (..., 8, 3), m, of boxes with edges of length `size`, m, around the points `center`, m.

    turns: angles a, b, c, rad, of each box, which is rotated by Rx(a) Ry(b) Rz(c). All arguments are (..., 3).
    """
    matrices = Rotation.from_euler("XYZ", turns.reshape(-1, 3)).as_matrix().reshape(*turns.shape, 3)
    turned: Array = (UNIT_BOX_CORNERS * np.asarray(size)[..., None, :]) @ np.swapaxes(matrices, -1, -2)
    return center[..., None, :] + turned


def choose_magnification(values: Array, seen: float) -> float:
    """Return the largest factor, 1, 2 or 5 times a power of ten, with which no drawn value exceeds `seen`."""
    largest = float(np.abs(values).max())
    wanted = min(max(seen / largest, 1.0), MAX_MAGNIFICATION) if largest > 0.0 else MAX_MAGNIFICATION
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted))


def trace_contact_paths(scene: Scene, shift: Array, turns: Array) -> Array:
    """
    Return x and y of each contact point, measured from the place of its support, in all frames, (F, K, 2), m.

    shift, turns: displacement, m, and rotation angles, rad, of the platform in each frame, (F, 3).
    """
    # A sphere of radius r lies in a depression of radius r + rho. If the center of the depression moves by u, the point
    # of contact moves on the sphere by -u r / rho.
    supports = _support_places(scene)
    arms = np.column_stack([supports - scene.offsets[0], np.full(len(supports), -(scene.bodies[0].height or 0.0))])
    matrices = Rotation.from_euler("XYZ", turns).as_matrix()
    depressions = shift[:, None, :] + arms @ np.swapaxes(matrices, 1, 2) - arms
    lever = (scene.isolator.sphere_radius or SPHERE_RADIUS) / scene.radius
    paths: Array = -lever * depressions[:, :, :2]
    return paths


def arrange_boxes(scene: Scene) -> tuple[Array, Array, float]:
    """Return drawn heights (N,) above the lowest box, drawn sizes (N, 3), m, and the factor on the heights."""
    width = 2.0 * (scene.support_radius or scene.isolator.ring or SUPPORT_RING_RADIUS)
    sizes: Array = np.array([body.size or [width, width, BOX_THICKNESS * width] for body in scene.bodies])
    width = float(sizes[:, :2].max())
    heights: Array = BOX_DISTANCE * width * np.arange(len(sizes), dtype=np.float64)
    stated = [body.height for body in scene.bodies if body.height is not None]
    if len(stated) == len(sizes) and (np.diff(stated) > 0.0).all():
        heights = np.array(stated) - stated[0]
    factor = 1.0
    if len(sizes) > 1:
        factor = float(np.clip(heights[-1], MIN_SPAN * width, MAX_SPAN * width) / heights[-1])
        gap = factor * float(np.diff(heights).min())
        sizes[:, 2] = np.minimum(sizes[:, 2], MAX_DRAWN_THICKNESS * gap)
    return factor * heights, sizes, factor


def make_drawing(scene: Scene, motion: Trajectory, stretch: float, count: int) -> Drawing:
    """Return the magnified geometry of a motion in `count` frames."""
    shifts = sample_frames(motion.time, motion.position, count)
    turns = sample_frames(motion.time, motion.extra.get("turns", np.zeros_like(motion.position)), count)
    heights, sizes, factor = arrange_boxes(scene)
    gap = float(np.diff(heights).min(initial=np.inf))
    # the largest drawn tilt, rad: the corners of the widest box drop by no more than a share of the gap between boxes
    dip = min(MAX_DRAWN_ROTATION, MAX_DRAWN_DIP * gap / (0.5 * float(np.hypot(*sizes[:, :2].max(axis=0)))))
    tilt, yaw = choose_magnification(turns[..., :2], dip), choose_magnification(turns[..., 2], MAX_DRAWN_ROTATION)
    paths = trace_contact_paths(scene, shifts[:, 0], turns[:, 0])
    path_factor = choose_magnification(paths, MAX_DRAWN_ROTATION * float(np.hypot(*_support_places(scene).T).max()))
    scales = f"displacements x {stretch:g}, contact paths x {path_factor:g}"
    scales += f", tilt x {tilt:g}, yaw x {yaw:g}" if "turns" in motion.extra else ""
    scales += f", heights x {factor:.2g}" if factor != 1.0 else ""
    half_width = float(np.abs(shifts[..., :2]).max()) if scene.flat else 0.25 * scene.radius
    across = np.linspace(-1.0, 1.0, 101) * half_width
    rise = np.zeros(101) if scene.flat else scene.radius - np.sqrt(scene.radius**2 - across**2)
    centers = np.column_stack([scene.offsets, heights]) + shifts * stretch
    return Drawing(
        corners=locate_box_corners(centers, sizes, turns * [tilt, tilt, yaw] + scene.yaws[:, None] * [0.0, 0.0, 1.0]),
        centers=centers,
        supports=_support_places(scene),
        paths=_support_places(scene) + paths * path_factor,
        swing_curve=stretch * np.column_stack([across, rise]),
        rest_place=scene.offsets[0],
        scales=scales,
    )


def draw_film(scene: Scene, motion: Trajectory, model: str, settings: FilmSettings, count: int) -> bytes:
    """Return a GIF of a motion that `model` computed, in `count` frames."""
    drawn = make_drawing(scene, motion, settings.stretch, count)
    width, height = settings.size
    figure = Figure((LAYOUT_WIDTH, LAYOUT_WIDTH * height / width), dpi=width / LAYOUT_WIDTH)
    canvas: Any = FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.05, right=0.99, bottom=0.21, top=0.8, wspace=0.15)
    figure.suptitle(
        f"{escape_for_matplotlib(scene.title)}: {model} model of the engine\n{drawn.scales}", fontsize="medium"
    )
    panels = figure.subplots(1, 3)
    views = [_TopView(panels[0], drawn), _SideView(panels[1], drawn, 0), _SideView(panels[2], drawn, 1)]
    handles: dict[str, Any] = {}
    for panel in panels:
        handles |= dict(zip(*reversed(panel.get_legend_handles_labels())))
    columns = min(len(handles), 9)
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=columns, fontsize="small")
    clock = figure.text(0.01, 0.97, "", va="top", animated=True)
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)

    def draw_frame(frame: int) -> Image.Image:
        """Return one frame as a picture: the fixed background with the moving artists drawn on it."""
        canvas.restore_region(background)
        clock.set_text(f"t = {frame * settings.speed / settings.rate:.2f} s")
        for view in views:
            view.show(frame)
        for artist in (clock, *(artist for view in views for artist in view.moving)):
            figure.draw_artist(artist)
        return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])

    return _encode_gif((draw_frame(frame) for frame in range(count)), draw_frame(count // 2), settings.rate)


def _encode_gif(pictures: Iterator[Image.Image], typical: Image.Image, rate: int) -> bytes:
    """Return a GIF of pictures in the colors of a typical picture; only one picture is in memory at a time."""
    white_stays_white = Image.Quantize.MAXCOVERAGE
    palette = typical.quantize(COLOR_COUNT, white_stays_white)
    reduced = (picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures)
    content = io.BytesIO()
    next(reduced).save(content, "GIF", save_all=True, append_images=reduced, duration=1000 // rate, loop=0)
    return content.getvalue()


class _Panel:
    """Panel of the film with the drawn objects (artists of matplotlib) that move in it."""

    def __init__(self, panel: Any, drawn: Drawing, axes: tuple[int, int], alpha: float) -> None:
        """Set up axes and outlines of the bodies; axes: the two coordinates shown; alpha: opacity of the bodies."""
        self.drawn, self.axes = drawn, list(axes)
        self.outlines = [
            panel.fill([0.0], [0.0], facecolor=(*color, alpha), edgecolor=color, label=label, animated=True)[0]
            for color, label in _colors_and_names(drawn.corners.shape[1])
        ]
        self.moving: list[Any] = [*self.outlines]
        names = ["xyz"[axis] for axis in axes]
        panel.set(xlim=(-drawn.half_width, drawn.half_width), aspect="equal", xlabel=f"{names[0]} [m]")
        panel.set_ylabel(f"{names[1]} [m]" if names[1] != "z" else "z", labelpad=2.0)

    def show(self, frame: int) -> None:
        """Move the drawn objects to their places in a frame."""
        for body, outline in enumerate(self.outlines):
            flat = self.drawn.corners[frame, body][:, self.axes]
            outline.set_xy(flat[ConvexHull(flat).vertices])


class _TopView(_Panel):
    """Panel from above: the boxes, the ring of supports and the paths of the contact points."""

    def __init__(self, panel: Any, drawn: Drawing) -> None:
        """Draw the supports and their ring, and set up the paths of the contact points."""
        super().__init__(panel, drawn, (0, 1), 0.1)
        panel.set(ylim=(-drawn.half_width, drawn.half_width))
        panel.set_title("from above", fontsize="small")
        distances = np.hypot(*drawn.supports.T)
        if np.allclose(distances, distances[0]):
            panel.add_patch(Circle((0.0, 0.0), float(distances[0]), fill=False, color="0.5", linestyle=":"))
        panel.plot(*drawn.supports.T, "o", color="0.4", markersize=5, label="support")
        style = {"color": "tab:red", "animated": True}
        self.lines = [panel.plot([], [], linewidth=1.0, **style)[0] for _ in drawn.supports]
        self.lines[0].set_label("path of the contact point")
        self.points = panel.plot([], [], ".", markersize=6, **style)[0]
        self.moving += [*self.lines, self.points]

    def show(self, frame: int) -> None:
        """Move the boxes and the contact paths to their places in a frame."""
        super().show(frame)
        for line, path in zip(self.lines, np.swapaxes(self.drawn.paths, 0, 1)):
            line.set_data(*path[: frame + 1].T)
        self.points.set_data(*self.drawn.paths[frame].T)


class _SideView(_Panel):
    """Panel from the side: boxes above each other, the supports as vertical lines below, and a line through centers."""

    def __init__(self, panel: Any, drawn: Drawing, axis: int) -> None:
        """Draw the supports and the curve of the platform's center, seen along y if `axis` is 0, along x if it is 1."""
        super().__init__(panel, drawn, (axis, 2), 0.35)
        panel.set_title("along y" if axis == 0 else "along x", fontsize="small")
        self.axis = axis
        top = float(drawn.corners[:, 0, :, 2].min())
        low = top - POLE_LENGTH * 2.0 * drawn.half_width
        panel.set(ylim=(low, float(drawn.corners[..., 2].max()) + 0.05 * drawn.half_width), yticks=[])
        for support in drawn.supports[:, axis]:
            panel.plot([support, support], [low, top], color="0.5", linewidth=1.5)
            panel.plot(support, top, "o", color="0.4", markersize=5, clip_on=False)
        panel.plot(
            drawn.rest_place[axis] + drawn.swing_curve[:, 0],
            drawn.swing_curve[:, 1],
            ":",
            color="0.2",
            label="swing of the center",
        )
        self.mast = panel.plot([], [], "o-", color="0.2", markersize=3, linewidth=1.0, animated=True)[0]
        self.moving.append(self.mast)

    def show(self, frame: int) -> None:
        """Move the boxes and the line through their centers to their places in a frame."""
        super().show(frame)
        self.mast.set_data(self.drawn.centers[frame, :, self.axis], self.drawn.centers[frame, :, 2])


def _colors_and_names(count: int) -> list[tuple[tuple[float, float, float], str]]:
    """Return color and name of every body; bodies beyond the sixth have no name in the legend."""
    colors = [colormaps["tab10"](body % 10)[:3] for body in range(count)]
    names = ["platform", *(f"body {body}" for body in range(2, count + 1))]
    return list(zip(colors, [name if body < 6 else "_" for body, name in enumerate(names)]))


def _support_places(scene: Scene) -> Array:
    """Return the places (K, 2), m, of the supports in the plane, of the scene or of the default drawing."""
    return DEFAULT_SUPPORTS if scene.support_places is None else scene.support_places
