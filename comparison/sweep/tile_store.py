"""
Every finished tile of a study on disk, so that a run that was ended goes on where it stopped.

One directory per surface, named by a hash of scene, model, settings, versions and the models' source
(`surroundings`), with a `surface.json` that says so in words; in it one file per tile, named by a hash of its phases.
What else a study computes is kept in directories of its own by the same rules (`answers.py`). A file is written aside
and renamed, and begins with a hash of its name and what follows: one that is torn or damaged is computed again, which
also covers a power cut without waiting for the disk at every tile.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import shutil
import time
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np

from comparison.plan.tiles import Answer, Tile
from comparison.sweep.surroundings import surroundings
from reference.problem import SceneError

FORMAT = 2  # of a tile's file
LIMIT = 2**30  # bytes: above this, surfaces that the present study does not need are dropped, least recently used first
STALE = 3600.0  # s: what a killed run left written aside; a writing takes milliseconds
MARK = "phase-resonance/tiles"
DESCRIPTION = "surface.json"
ASIDE = ".aside-"


class StoreError(OSError):
    """A tile that could not be stored. `str(error)` is one line."""


class TileStore:
    """
    The tiles below `folder`, which is made with the first of them. `kept` counts those read or written here, `others`
    the stored answers to other questions.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.kept = 0
        self.others = 0

    def get(self, tile: Tile) -> Answer | None:
        """The stored answer to the last bit, or None if there is none or it is damaged."""
        try:
            answer = _unpacked(self.read(self._place(tile)), tile)
        except (OSError, ValueError, KeyError):
            return None
        self.kept += 1
        return answer

    def holds(self, tile: Tile) -> bool:
        """Whether there is a file for it, whatever its state."""
        return self._place(tile).exists()

    def put(self, tile: Tile, answer: Answer) -> None:
        """
        Store an answer. Raises StoreError, and leaves what is stored as it was.

        A tile whose model raised or whose worker died is not stored: the next run tries it again.
        """
        if answer.fault:
            return
        self.write(self._place(tile), _packed(answer), _described(tile), "a finished tile")
        self.kept += 1

    def read(self, place: Path) -> bytes:
        """What was written to a file of the store. Raises OSError, or ValueError if it is damaged."""
        text, name = place.read_bytes(), _name(place)
        digest, content = text[:32], text[32:]
        if hashlib.sha256(name + content).digest() != digest:
            raise ValueError("damaged, or of another question")
        return content

    def write(self, place: Path, content: bytes, described: str, what: str) -> None:
        """Write a file of the store, and what its directory is about. Raises StoreError, which says `what` it was."""
        try:
            if not (place.parent / DESCRIPTION).exists():
                place.parent.mkdir(parents=True, exist_ok=True)
                _write(place.parent / DESCRIPTION, described.encode())
            _write(place, hashlib.sha256(_name(place) + content).digest() + content)
        except OSError as fault:
            raise StoreError(f"{str(self.folder)!r}: {what} could not be stored: {fault.strerror}") from None

    def forget(self, tiles: Iterable[Tile]) -> None:
        """Drop what is stored of these surfaces."""
        for key in {surface_key(tile) for tile in tiles}:
            shutil.rmtree(self.folder / key, ignore_errors=True)

    def trim(self, tiles: Iterable[Tile], limit: int = LIMIT) -> None:
        """Drop surfaces other than those of `tiles`, least recently used first, while all take more than `limit`."""
        needed = {surface_key(tile) for tile in tiles}
        with suppress(OSError):  # a store that cannot be looked through is not worth ending a run for
            surfaces = sorted(_surfaces(self.folder), key=lambda surface: surface.stat().st_mtime)
            sizes = {surface: _size(surface) for surface in surfaces}
            for surface in surfaces:
                if surface.name in needed:
                    os.utime(surface)
            for surface in surfaces:
                if sum(sizes.values()) > limit and surface.name not in needed:
                    shutil.rmtree(surface, ignore_errors=True)
                    del sizes[surface]

    def _place(self, tile: Tile) -> Path:
        phases = hashlib.sha256(np.ascontiguousarray(tile.phases).tobytes()).hexdigest()[:24]
        return self.folder / surface_key(tile) / f"{phases}.tile"


def store_beside(out: Path) -> Path:
    """Where the tiles of the report `out` are kept."""
    return out.with_name(f"{out.name}.tiles")


def refuse_foreign_store(out: Path) -> None:
    """Raise SceneError, one line, if something that is not a store of tiles is where that of `out` belongs."""
    folder = store_beside(out.resolve())
    if folder.exists() and not (folder.is_dir() and len(_surfaces(folder)) == len(list(folder.iterdir()))):
        rule = f"{folder.name!r} beside it is not a store of tiles of this study: move it away"
        raise SceneError("command line", "--out", str(out), rule)


def surface_key(tile: Tile) -> str:
    """Hash of all that the numbers of a tile depend on, except its phases."""
    return key_of(_described(tile))


@cache
def key_of(text: str) -> str:
    """Name of a directory of the store, from the text that describes it."""
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def _described(tile: Tile) -> str:
    content = {
        "what": MARK,
        "format": FORMAT,
        "scene": tile.scene.digest(),
        "model": tile.amplification,
        "settings": dict(tile.settings),
        "surroundings": surroundings(tile.amplification),
    }
    return json.dumps(content, indent=1, sort_keys=True)


def _name(place: Path) -> bytes:
    """What a file is about: surface and phases, as its name has them."""
    return f"{place.parent.name}/{place.name}".encode()


def _packed(answer: Answer) -> bytes:
    content = io.BytesIO()
    np.savez(
        content,
        mu=answer.mu,
        error=answer.error,
        instant=answer.instant,
        cap_share=answer.cap_share,
        status=np.array(answer.status, dtype=np.str_),
        cost=np.array(answer.cost),
    )
    return content.getvalue()


def _unpacked(content: bytes, tile: Tile) -> Answer:
    """The answer written in a tile's file. Raises ValueError or KeyError if that is not what it holds."""
    with np.load(io.BytesIO(content), allow_pickle=False) as parts:
        names = ("mu", "error", "instant", "status", "cap_share")
        mu, error, instant, status, cap_share = (parts[part] for part in names)
        if mu.shape != (len(tile.phases), len(tile.scene.bodies)):
            raise ValueError("of another shape")
        return Answer(mu, error, status.tolist(), instant, float(parts["cost"]), "", cap_share)


def _write(place: Path, content: bytes) -> None:
    aside = place.with_name(f"{ASIDE}{os.getpid()}-{place.name}")
    try:
        aside.write_bytes(content)
        os.replace(aside, place)
    except BaseException:
        with suppress(OSError):
            aside.unlink()
        raise


def _surfaces(folder: Path) -> list[Path]:
    """The directories in a store, by their names alone: one may be empty, its run killed before the first tile."""
    return [entry for entry in folder.iterdir() if entry.is_dir() and len(entry.name) == 24] if folder.exists() else []


def _size(surface: Path) -> int:
    """Bytes on disk; what killed runs left aside is removed on the way."""
    total = 0
    for entry in os.scandir(surface):
        state = entry.stat()
        if entry.name.startswith(ASIDE) and time.time() - state.st_mtime > STALE:
            with suppress(OSError):
                os.unlink(entry.path)
        else:
            total += max(512 * getattr(state, "st_blocks", 0), state.st_size)
    return total
