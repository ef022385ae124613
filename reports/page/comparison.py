"""comparison.html: two runs side by side, in one offline file."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path

from reports.data.comparison import RunComparison
from reports.format.template import rendered
from reports.plots.comparison import comparison_plot
from reports.text.comparison import headline, review, sections


@dataclass(frozen=True)
class PicturePair:
    """The pictures of a pin in a case from two runs: PNG files, None where a run has none."""

    title: str
    files: tuple[Path | None, Path | None]

    @property
    def shown(self) -> list[str]:
        """Both pictures in base64; empty for a missing one."""
        return [
            "" if path is None else b64encode(path.read_bytes()).decode("ascii")
            for path in self.files
        ]


def write_comparison(
    comparison: RunComparison, path: Path, drawn: str, pictures: tuple[PicturePair, ...] = ()
) -> None:
    """Write the page. drawn: the plot as SVG, empty without one."""
    plot = comparison_plot(comparison)
    text = rendered(
        "comparison.html.j2",
        comparison=comparison,
        review=review(comparison),
        headline=headline(comparison),
        sections=[
            (name, t.grid(), note) for name, t, note in sections(comparison) if t.rows or note
        ],
        plot=drawn,
        caption=plot.caption if plot and drawn else "",
        pictures=pictures,
    )
    path.write_text(text, encoding="utf-8", newline="\n")
