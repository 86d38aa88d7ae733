"""Names of figure files: the one place where names of scenes become names of files."""

import hashlib

MAX_NAME_BYTES = 200  # bytes of a name without its ending: file systems allow 255 in all


def name_figure_file(scene: str, *parts: str, ending: str = ".png") -> str:
    """
    Return the file name of a figure: the scene and the parts, joined by hyphens.

    The scene is cut where the name would be too long, and a hash of the whole name follows it.
    """
    stem = "-".join([scene, *parts])
    written = stem.encode(errors="surrogateescape")
    if len(written) > MAX_NAME_BYTES:
        kept = written[: MAX_NAME_BYTES - 20].decode(errors="ignore")
        stem = "-".join([kept, hashlib.sha256(written).hexdigest()[:8], *parts])
    return stem + ending
