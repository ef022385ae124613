"""One failure of the gallery: what docs/failures.md shows of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

Draw = Callable[[Figure, list[Axes]], None]


@dataclass(frozen=True)
class Entry:
    """name: of the picture's file. physics, naive, truth, says: Markdown, the last what pinstress
    says instead. commands: what shows it. picture: in words, for those who do not see it. panels:
    of the picture, side by side, which `draw` fills.
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
        """Its section of the page."""
        shown = "\n".join(self.commands)
        return (
            f"## {self.title}\n\n{self.physics}\n\n"
            f"![{self.picture}](images/failures/{self.name}.svg)\n\n"
            f"- **Naive method.** {self.naive}\n"
            f"- **True value.** {self.truth}\n"
            f"- **Pinstress.** {self.says}\n\n"
            f"```sh\n{shown}\n```\n"
        )
