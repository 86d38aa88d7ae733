"""How files of figures are called: the one place where names of scenes become names of files."""

import hashlib
from pathlib import Path

ENDINGS = (".png", ".pdf", ".webp", ".nc")
LONGEST = 200  # bytes of a name before its ending: file systems allow 255 in all


def figure_file(scene: str, *parts: str, ending: str = ".png") -> str:
    """Name of a file of a scene: the parts joined by hyphens; where too long, cut and with a hash of the whole."""
    stem = "-".join([scene, *parts])
    written = stem.encode(errors="surrogateescape")
    if len(written) > LONGEST:
        kept = written[: LONGEST - 20].decode(errors="ignore")
        stem = "-".join([kept, hashlib.sha256(written).hexdigest()[:8], *parts])
    return stem + ending


def with_ending(path: Path, ending: str) -> Path:
    """Return the same file name with another ending. Dots before the ending belong to the name of the scene."""
    old = next((known for known in ENDINGS if path.name.endswith(known)), "")
    return path.with_name(path.name.removesuffix(old) + ending)
