"""
Pictures of the gallery: `python docs/gallery_pictures.py` runs every example and writes docs/gallery/*.png.

An example writes its picture into the working directory, under its own name.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
COLORS = 256  # enough for plots, at a third of the bytes


def script_of(example: Path) -> str:
    """The Python of an example; of a notebook the cells, behind the guard that its worker processes need."""
    text = example.read_text(encoding="utf-8")
    if example.suffix == ".py":
        return text
    cells = [cell["source"] for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    lines = [line.rstrip("\n") for cell in cells for line in [*cell, ""]]
    return "\n    ".join(['if __name__ == "__main__":', *lines]) + "\n"


def run(example: Path, folder: Path) -> Path:
    """Run an example in `folder`, an empty directory, as a user would; the picture that it leaves there."""
    script = folder / f"{example.stem}_script.py"
    script.write_text(script_of(example), encoding="utf-8")
    paths = os.pathsep.join([str(HERE.parent), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": paths, "MPLBACKEND": "Agg"}
    subprocess.run([sys.executable, script.name], cwd=folder, env=environment, check=True)
    return folder / f"{example.stem}.png"


def main() -> None:
    """Write all pictures."""
    for example in sorted([*EXAMPLES.glob("*.py"), *EXAMPLES.glob("*.ipynb")]):
        with tempfile.TemporaryDirectory() as folder:
            picture = Image.open(run(example, Path(folder))).convert("RGB")
            drawn = picture.quantize(COLORS, dither=Image.Dither.NONE)
            drawn.save(HERE / "gallery" / f"{example.stem}.png", optimize=True)


if __name__ == "__main__":
    main()
