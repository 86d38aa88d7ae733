"""How files of figures are called: the one place where names of scenes become names of files."""

import hashlib

LONGEST = 200  # bytes of a name before its ending: file systems allow 255 in all


def figure_file(scene: str, *parts: str, ending: str = ".png") -> str:
    """Name of a file of a scene: the parts joined by hyphens; where too long, cut and with a hash of the whole."""
    stem = "-".join([scene, *parts])
    written = stem.encode(errors="surrogateescape")
    if len(written) > LONGEST:
        kept = written[: LONGEST - 20].decode(errors="ignore")
        stem = "-".join([kept, hashlib.sha256(written).hexdigest()[:8], *parts])
    return stem + ending
