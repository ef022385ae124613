"""The TOML of a file, read in a time that is proportional to its length.

tomllib takes minutes and gigabytes for a key of ten thousand parts. No study needs such text, so it
is rejected by its tokens before tomllib reads it.
"""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

from loads import FileError, read_regular
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.toml_lines import TOKEN_PATTERN
from pinstress.study.schema.shown import cut

MAX_TOML_DEPTH = 50  # tables and arrays inside each other, or parts of a dotted key
MAX_WORD_LENGTH = 1000  # characters of a number or of a key without quotes


def read_text(path: Path, most: int) -> str:
    """Return the text of a file of at most this many bytes, its lines separated by LF.

    Raises: InputError.
    """
    try:
        text = read_regular(path, most).decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file", code="no-such-file") from None
    except FileError as error:
        raise InputError(f"{path}: {error}", code=error.code) from None
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: is not UTF-8 text ({error}); save it with this encoding", code="unreadable"
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_toml(path: Path, text: str) -> dict[str, Any]:
    """Return the content of a text.

    Raises: InputError with the line.
    """
    _require_moderate(path, text)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"at line (\d+)", str(error))
        line = int(place[1]) if place else text.rstrip().count("\n") + 1  # "at end of document"
        raise InputError(f"{path}:{line}: not valid TOML: {error}", code="not-toml") from None


def _require_moderate(path: Path, text: str) -> None:
    """Raise InputError for tables nested too deeply and for words too long."""
    line, at = 1, 0
    open_: list[int] = [0]  # for each open bracket, outermost first: dots of the current key in it
    depth = 0  # brackets and dots together
    for match in TOKEN_PATTERN.finditer(text):
        token = match[0]
        line += text.count("\n", at, match.start())
        at = match.start()
        if token in "[{":
            open_.append(0)
            depth += 1
        elif token in "]}":
            if len(open_) > 1:
                depth -= 1 + open_.pop()
        elif token in ",\n":
            depth -= open_[-1]
            open_[-1] = 0
        elif token == ".":
            open_[-1] += 1
            depth += 1
        elif len(token) > MAX_WORD_LENGTH and token[0] not in "\"'#":
            raise InputError(
                f"{path}:{line}: not valid TOML: {_too_long(text, match)}", code="not-toml"
            )
        if depth > MAX_TOML_DEPTH:
            raise InputError(
                f"{path}:{line}: not valid TOML: brackets or dots more than {MAX_TOML_DEPTH} deep",
                code="not-toml",
            )


def _too_long(text: str, word: re.Match[str]) -> str:
    number = word[0][0] in "+-0123456789"
    whole = "." not in (text[word.start() - 1 : word.start()], text[word.end() : word.end() + 1])
    what = (
        f"a {'whole ' * whole}number with too many digits" if number else "a key that is too long"
    )
    length = f"{len(word[0]):,} characters; the limit is {MAX_WORD_LENGTH:,}"
    return f"{what}, {cut(word[0], 40)!r} ({length})"
