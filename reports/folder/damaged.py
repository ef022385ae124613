"""JSON and compressed texts of files that may be damaged; errors state what is wrong, and where."""

from __future__ import annotations

import json
import re
import zlib
from base64 import b64decode
from typing import Any, NoReturn, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from loads import MB
from pinbase.errors import Damaged

Model = TypeVar("Model", bound=BaseModel)
# Half of a character beyond the first 65,536
SURROGATE_ESCAPE_PATTERN = re.compile(r"\\u[dD][89a-fA-F]")

MAX_JSON_DEPTH = 100  # levels of nesting; pinstress writes at most twenty
ERROR_WORDS = {  # replace pydantic's messages, which speak of Python
    "missing": "is missing",
    "model_type": "is not an object",
    "dict_type": "is not an object",
    "list_type": "is not a list",
    "string_type": "is not a text",
    "float_type": "is no number",
    "bool_type": "is neither true nor false",
    "finite_number": "is no finite number",
}


class JsonPart(BaseModel):
    """The part of a JSON object that is used; it may have other keys."""

    model_config = ConfigDict(strict=True, frozen=True, extra="ignore")


def strict_json(content: bytes, name: str) -> Any:
    """Return the values of a JSON text.

    Raises: Damaged if the text is not valid JSON, or is nested too deeply.
    """
    try:
        text = content.decode("utf-8")
        values = json.loads(text, parse_constant=_no_number)
        _require_shallow(values)
        if SURROGATE_ESCAPE_PATTERN.search(text):  # a lone surrogate cannot be written to a file
            json.dumps(values, ensure_ascii=False).encode()
    except UnicodeDecodeError as error:
        raise Damaged(f"{name} is damaged: no UTF-8 from byte {error.start:,} on") from None
    except UnicodeEncodeError:
        raise Damaged(f"{name} is damaged: it has half a character (a lone surrogate)") from None
    except json.JSONDecodeError as error:
        where = f"line {error.lineno:,}, column {error.colno:,}: {error.msg}"
        raise Damaged(f"{name} is {'damaged: ' + where if content else 'empty'}") from None
    except RecursionError:
        raise Damaged(f"{name} is damaged: it is nested too deeply") from None
    except _NoNumber as error:
        raise Damaged(f"{name} is damaged: it has {error}, which is no number") from None
    except ValueError:  # raised by int()
        raise Damaged(f"{name} is damaged: it has a number of thousands of digits") from None
    return values


def _require_shallow(value: Any) -> None:
    """Check that values are not nested too deeply for functions that walk or copy them later.

    Raises: RecursionError if they are.
    """
    level = [value]
    for _ in range(MAX_JSON_DEPTH):
        holders = [x.values() if isinstance(x, dict) else x for x in level if x and _holds(x)]
        level = [below for holder in holders for below in holder if _holds(below)]
        if not level:
            return
    raise RecursionError


def _holds(node: Any) -> bool:
    return isinstance(node, dict | list)


class _NoNumber(ValueError):
    pass


def _no_number(text: str) -> NoReturn:
    raise _NoNumber(text)


def validated(kind: type[Model], content: Any, name: str) -> Model:
    """Return the parts of a JSON text that are used, as a model.

    Raises: Damaged, with the name of the wrong part.
    """
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False)[0]
        where = "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in first["loc"])
        said = first["msg"].removeprefix("Value error, ")
        what = ERROR_WORDS.get(first["type"], f"is wrong: {said[:1].lower()}{said[1:]}")
        more = error.error_count() - 1
        also = f", and {more:,} more" if more else ""
        where = where.lstrip(".") or "its content"
        raise Damaged(f"{name} is damaged: {where} {what}{also}") from None


def inflated(packed: bytes | str, most: int, name: str) -> bytes:
    """Return the bytes packed by zlib and base64.

    Raises: Damaged, also if there are more than `most` bytes, which are never unpacked.
    """
    unpack = zlib.decompressobj()
    try:
        content = unpack.decompress(b64decode(packed, validate=True), most + 1)
    except (ValueError, zlib.error):
        raise Damaged(f"{name} is damaged: it cannot be unpacked") from None
    if len(content) > most:
        raise Damaged(f"{name} is damaged: it unpacks to more than {most // MB:,} MB")
    if not unpack.eof:
        raise Damaged(f"{name} is damaged: it ends too early")
    return content
