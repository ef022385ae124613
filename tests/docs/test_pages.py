"""Pages that show a terminal show what it shows: docs/sessions.py runs them."""

from __future__ import annotations

from pathlib import Path

import pytest

from docs.sessions import differences, play, renewed
from tests.conftest import ROOT
from tests.support.each import each, sampled

MADE_UP = """
```toml
# a.toml
one = 1
```
```toml
# a.toml, continued
two = 2
```
```python
# b.py
print("three")
```
```console
$ ls
a.toml
b.py
$ python b.py
three
$ echo 1,002.0 words
1,000.0 words
$ ls nowhere
...
$ echo $?
0
```
"""


@pytest.mark.slow
@pytest.mark.parametrize("page", ["start.md", *sampled(["tutorial.md", "recipes.md"], every=2)])
def test_a_page_shows_what_happens(page: str, tmp_path: Path) -> None:
    """If it does not: python -m docs.sessions docs/PAGE, and read it again."""
    played = list(play((ROOT / "docs" / page).read_text(encoding="utf-8"), tmp_path))
    assert len(played) > 3
    for one in played:
        assert not differences(one.step.shown, one.printed), one.step.command


def test_files_and_commands_are_taken_from_a_page(tmp_path: Path) -> None:
    played = list(play(MADE_UP, tmp_path))
    assert (tmp_path / "a.toml").read_text() == "one = 1\ntwo = 2\n"
    assert [p.step.command for p in played] == [
        "ls",
        "python b.py",
        "echo 1,002.0 words",
        "ls nowhere",
        "echo $?",
    ]
    told = [bool(differences(p.step.shown, p.printed)) for p in played]
    assert told == [False, False, False, False, True]  # the last status is 2, not 0
    assert played[3].status == 2
    assert "$ echo 1,002.0 words\n1,002.0 words\n$ ls nowhere\n...\n" in renewed(MADE_UP, played)


@each(
    ("shown", "printed", "same"),
    [
        ("factor 3.02\n", "factor 3.021\n", True),
        ("factor 3.02\n", "factor 3.12\n", False),
        ("factor 3.02 meets\n", "factor 3.02 misses\n", False),
        ("to 6e-16\n", "to 4e-16\n", True),
        ("force −11,310\n", "force 11,310\n", False),
        ("a\n", "a\nb\n", False),
        ("a\nb\n", "a\n", False),
        ("a\n...\nd\n", "a\nb\nc\nd\n", True),
        ("a\n...\nd\n", "a\nb\nd\nc\n", False),
        ("...\nc\n", "a\nb\nc\n", True),
        ("...\n", "a\n", True),
        ("Pin  designs\nP          7\n", "Pin  designs\nP          8\n", True),
        ("Pin  designs\nP  2       7\n", "Pin  designs\nP  3       7\n", False),
    ],
)
def test_what_counts_as_the_same(shown: str, printed: str, same: bool) -> None:
    assert (not differences(shown, printed)) is same


def test_a_page_may_not_run_anything(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="may not run rm"):
        list(play("```console\n$ rm -r x\n```\n", tmp_path))
