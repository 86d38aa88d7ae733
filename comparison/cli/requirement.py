"""Where pip finds the very version that runs here, for machines that have not installed it."""

import json
import re
import subprocess
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit, urlunsplit
from urllib.request import url2pathname

from comparison.runner.environment import ask_git
from reference.support.version import __version__

NAME = "phase-resonance"
CHECKOUT = Path(__file__).resolve().parents[2]
BY_SSH = re.compile(r"([\w.-]+@[\w.-]+):/?(.+)")  # as git writes an address: user@host:path
REMOTE = ("https", "http", "ssh", "git")


def requirement_line() -> str:
    """A line of requirements.txt: the address that pip recorded, a commit that others reach, a folder or a version."""
    about = _pip_record()
    url = str(about.get("url", ""))
    if "vcs_info" in about:
        address = f"{about['vcs_info']['vcs']}+{_without_password(url)}@{about['vcs_info']['commit_id']}"
    elif url and "dir_info" not in about:
        address = _without_password(url)
    elif url or (CHECKOUT / "pyproject.toml").is_file():
        folder = Path(url2pathname(urlsplit(url).path)) if url else CHECKOUT
        address = _commit_elsewhere(folder) or folder.as_uri()
    else:
        return f"{NAME}=={__version__}"
    return f"{NAME} @ {address}"


def _pip_record() -> dict[str, Any]:
    """Return what pip has recorded of the place from which it installed the package (PEP 610); empty for an index."""
    try:
        about: dict[str, Any] = json.loads(distribution(NAME).read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        return {}
    return about


def _commit_elsewhere(folder: Path) -> str:
    """Return where others find the commit of a checkout; empty if nobody does."""
    try:
        commit = ask_git(folder, "rev-parse", "HEAD")
        if not ask_git(folder, "branch", "--remotes", "--contains", commit):
            return ""
        url = ask_git(folder, "remote", "get-url", "origin")
    except (OSError, subprocess.CalledProcessError):
        return ""
    if match := BY_SSH.fullmatch(url):
        url = f"ssh://{match[1]}/{match[2]}"
    return f"git+{_without_password(url)}@{commit}" if urlsplit(url).scheme in REMOTE else ""


def _without_password(url: str) -> str:
    parts = urlsplit(url)
    user, at, host = parts.netloc.rpartition("@")
    kept = f"{user.partition(':')[0]}@{host}" if at and parts.scheme == "ssh" else host
    return urlunsplit(parts._replace(netloc=kept))
