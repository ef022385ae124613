"""One failure of the gallery: the contents of its section in docs/failures.md."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

Draw = Callable[[Figure, list[Axes]], None]


@dataclass(frozen=True)
class Entry:
    """A failure of the gallery; texts are in Markdown.

    name: of the file of the picture.
    physics, naive, truth: the mechanics, the naive result and the true one.
    says: the answer of pinstress.
    commands: those that show it.
    picture: a description in words.
    draw: draws into `panels` axes side by side.
    """

    name: str
    title: str
    physics: str
    naive: str
    truth: str
    says: str
    commands: tuple[str, ...]
    picture: str
    draw: Draw
    panels: int = 2

    @property
    def text(self) -> str:
        """The section of the page."""
        shown = "\n".join(self.commands)
        return (
            f"## {self.title}\n\n{self.physics}\n\n"
            f"![{self.picture}](images/failures/{self.name}.svg)\n\n"
            f"- **Naive method.** {self.naive}\n"
            f"- **True value.** {self.truth}\n"
            f"- **Pinstress.** {self.says}\n\n"
            f"```sh\n{shown}\n```\n"
        )
