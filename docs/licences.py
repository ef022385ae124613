"""Licences of everything in the lock files, for the page licences.md: `python -m docs.licences`.

They are what each package's own metadata say. What is not installed here, because it is for another
system or an extra, keeps the line it has on the page, or is in ELSEWHERE.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from importlib import metadata
from itertools import chain
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "licences.md"
LOCKS = ("requirements.lock", "requirements-bench.lock")
RUN, DEVELOP = "to run", "to develop"
EXTRAS = "cluster", "fatigue", "pdf"  # which users install
OLDEST = {"extra": "", "python_version": "3.11", "python_full_version": "3.11.0"}
# Only for other systems than Linux; as the metadata of their wheels say.
ELSEWHERE = {
    "colorama": "BSD License",
    "pyobjc-core": "MIT",
    "pyobjc-framework-cocoa": "MIT",
}
IN_FILES = {"cvxopt": "GPL-3.0-or-later"}  # whose metadata refer to the file that comes with it
HEAD = """# Licences of dependencies

pinstress is GPL-3.0-or-later. `make setup` installs the packages of `requirements.lock`, benchmarks
those of `requirements-bench.lock`, each under its own licence, as stated in its metadata; none is
part of pinstress. `reports/templates/vendor/` has copies of Vega, Vega-Lite and Vega's interpreter
(BSD-3-Clause), which are part of every report, `tests/browser/axe/` one of axe-core (MPL-2.0).
`python -m docs.licences` writes this page.

| needed | licence | packages |
| --- | --- | --- |
"""


def locked() -> list[str]:
    """The names of all packages of the lock files, which have their versions."""
    texts = ((ROOT / lock).read_text(encoding="utf-8") for lock in LOCKS)
    names = (re.findall(r"^([a-z0-9][\w.-]*)==", text, re.MULTILINE) for text in texts)
    return sorted({*chain.from_iterable(names)})


def recorded() -> dict[str, tuple[str, str]]:
    """Licence and need of every package on the page."""
    if not PAGE.is_file():
        return {}
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", PAGE.read_text("utf-8"), re.M)
    return {
        name: (licence, need)
        for need, licence, packages in rows[2:]
        for name in packages.split(", ")
    }


def licence(name: str) -> str | None:
    """What an installed package's metadata say: an SPDX expression, classifiers, or a word."""
    if name in IN_FILES:
        return IN_FILES[name]
    try:
        found = metadata.metadata(name)
    except metadata.PackageNotFoundError:
        return ELSEWHERE.get(name)
    if "License-Expression" in found:
        return str(found["License-Expression"])
    classifiers = [c.split(" :: ")[-1] for c in found.get_all("Classifier") or () if "License" in c]
    word = str(found["License"]).strip().split("\n")[0] if "License" in found else ""
    return " or ".join(classifiers) or word or None


def needed(lines: Iterable[str], done: set[str]) -> set[str]:
    """Names of the packages that requirements need on Linux, and of what these need."""
    for requirement in map(Requirement, lines):
        name = re.sub(r"[-_.]+", "-", requirement.name).lower()
        if name in done or not (requirement.marker is None or requirement.marker.evaluate(OLDEST)):
            continue
        done.add(name)
        try:
            needed(metadata.requires(name) or (), done)
        except metadata.PackageNotFoundError:
            continue  # only older Pythons than this one need it
    return done


def page() -> str:
    """The whole page."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    before, use = recorded(), dict.fromkeys(needed(project["dependencies"], set()), RUN)
    for extra in EXTRAS:
        packages = project["optional-dependencies"][extra]
        use |= dict.fromkeys(needed(packages, set()) - set(use), f"extra `{extra}`")
    rows: dict[tuple[str, str], list[str]] = {}
    for name in locked():
        known = licence(name) or before.get(name, ("", ""))[0]
        if not known:
            raise SystemExit(f"{name}: its licence is not known; install it, or name it here")
        rows.setdefault((use.get(name, DEVELOP), known), []).append(name)
    order = RUN, *(f"extra `{extra}`" for extra in EXTRAS), DEVELOP
    lines = (
        f"| {need} | {known} | {', '.join(rows[need, known])} |"
        for need, known in sorted(rows, key=lambda row: (order.index(row[0]), row[1]))
    )
    return HEAD + "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
