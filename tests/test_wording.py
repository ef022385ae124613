"""Phrases that were replaced by the terms of docs/glossary.md do not come back."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import click

from pinstress.cli.commands import commands
from tests.conftest import ROOT
from tests.support.each import each

# Folders of code whose docstrings, comments and messages are checked.
CODE = ("reports", "pinstress", "assess", "fea", "geometry", "loads", "pinbase", "examples")
# Text that people read: pages, templates with scripts, comments of studies.
TEMPLATES = ("reports/templates/*", "reports/templates/designs/*")
PAGES = ("*.md", "docs/*.md", *TEMPLATES, "studies/**/*.toml")

REPLACED = {
    "nought": "zero",
    "(is|are|was|were) told": "reported",
    "(is|are) (still )?said": "reported",
    "(is|are|was) asked for": "requested",
    "so many processes": "number of parallel processes",
    "names none": "empty list",
    "round the axis": "over the circumference",
    "clos(e|es|ed) the balance": "the residual imbalance is reacted by the bands",
    "stands? in": "replaces",
    "set beside": "compared with",
    "beside (ours|theirs|that of|those of|beam|other programs|the published)": "compared with",
    "in the way and not": "exists and was not written by",
    "is no (study|key|value|file that)": "is not a",
    "by a double click": "with a double-click",
    "of which times": "the times are",
    "nothing holds|what holds it": "unconstrained / clamped",
    "for ever": "without limit",
    "undecided": "not decided",
    "further away than": "farther away than",
    r"known to \d": "converged within",
    "is never known": "its error exceeds",
    "places? without a maximum": "stress singularities",
    "checks by hand": "hand checks",
    "is pushed": "loaded",
}
ANY_REPLACED = re.compile(rf"\b({'|'.join(REPLACED)})\b", re.IGNORECASE)


def pages() -> list[Path]:
    found = {path for pattern in PAGES for path in ROOT.glob(pattern)}
    return sorted(path for path in found if path.is_file())


def modules() -> list[Path]:
    return sorted(path for folder in CODE for path in (ROOT / folder).rglob("*.py"))


def words(path: Path) -> str:
    """The text of a file that people read: of a module its strings and comments."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return text
    strings = (
        node.value
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
    comments = re.findall(r"#.*", text)
    return "\n".join([*strings, *comments])


def replaced(text: str) -> list[str]:
    """The replaced phrases in a text with some words around them."""
    flat = re.sub(r"[\s#]+", " ", text)
    return [
        flat[max(0, found.start() - 40) : found.end() + 40] for found in ANY_REPLACED.finditer(flat)
    ]


@each("path", [*pages(), *modules()])
def test_no_replaced_phrase(path: Path) -> None:
    assert replaced(words(path)) == []


def helps() -> Iterator[tuple[str, str]]:
    context = click.Context(commands)
    for name in commands.list_commands(context):
        command = commands.get_command(context, name)
        assert command is not None
        yield name, command.get_help(click.Context(command, info_name=name))


@each(("name", "text"), list(helps()))
def test_help_has_no_replaced_phrase_and_begins_with_an_example(name: str, text: str) -> None:
    assert replaced(text) == []
    assert f"Example: pinstress {name}" in text.split("\n\n")[1]


def test_the_list_of_commands_says_what_each_does() -> None:
    listed = commands.get_help(click.Context(commands)).split("Options:")[1]
    assert "Example" not in listed
    for name in commands.list_commands(click.Context(commands)):
        assert re.search(rf"^  {name} +[A-Z][a-z]+ .*\.$", listed, re.MULTILINE), name


@each("phrase", ["nought", "what is asked for", "is told by", "Places without a maximum"])
def test_a_replaced_phrase_is_found(phrase: str) -> None:
    assert replaced(f"Here {phrase}\n is written.")
