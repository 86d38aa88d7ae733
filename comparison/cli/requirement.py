"""Requirement line by which pip on other machines finds the very version that runs here."""

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

PACKAGE_NAME = "phase-resonance"  # name under which pip installs this project
CHECKOUT_FOLDER = Path(__file__).resolve().parents[2]  # folder of this project if it runs from a checkout
SSH_ADDRESS = re.compile(r"([\w.-]+@[\w.-]+):/?(.+)")  # SSH address in the short form of git: user@host:path
REMOTE_SCHEMES = ("https", "http", "ssh", "git")  # schemes of addresses that others can fetch from


def make_requirement_line() -> str:
    """Return the line of requirements.txt that installs this package: from its address, commit, folder or index."""
    about = _read_pip_record()
    url = str(about.get("url", ""))
    if "vcs_info" in about:
        address = f"{about['vcs_info']['vcs']}+{_remove_password(url)}@{about['vcs_info']['commit_id']}"
    elif url and "dir_info" not in about:
        address = _remove_password(url)
    elif url or (CHECKOUT_FOLDER / "pyproject.toml").is_file():
        folder = Path(url2pathname(urlsplit(url).path)) if url else CHECKOUT_FOLDER
        address = _find_published_commit(folder) or folder.as_uri()
    else:
        return f"{PACKAGE_NAME}=={__version__}"
    return f"{PACKAGE_NAME} @ {address}"


def _read_pip_record() -> dict[str, Any]:
    """Return pip's record of the address that the package was installed from (PEP 610); {} if from an index."""
    try:
        about: dict[str, Any] = json.loads(distribution(PACKAGE_NAME).read_text("direct_url.json") or "{}")
    except PackageNotFoundError:
        return {}
    return about


def _find_published_commit(folder: Path) -> str:
    """Return the address from which others can fetch the commit checked out in a folder; "" if it is not published."""
    try:
        commit = ask_git(folder, "rev-parse", "HEAD")
        if not ask_git(folder, "branch", "--remotes", "--contains", commit):
            return ""
        url = ask_git(folder, "remote", "get-url", "origin")
    except (OSError, subprocess.CalledProcessError):
        return ""
    if match := SSH_ADDRESS.fullmatch(url):
        url = f"ssh://{match[1]}/{match[2]}"
    return f"git+{_remove_password(url)}@{commit}" if urlsplit(url).scheme in REMOTE_SCHEMES else ""


def _remove_password(url: str) -> str:
    """Return an address without its password, and without the user's name unless it is an SSH address."""
    parts = urlsplit(url)
    user, at, host = parts.netloc.rpartition("@")
    kept = f"{user.partition(':')[0]}@{host}" if at and parts.scheme == "ssh" else host
    return urlunsplit(parts._replace(netloc=kept))
