"""What a chart becomes on a page: interactive, or a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.charts.bokeh_parts import Part


@dataclass(frozen=True)
class Chart:
    """An interactive figure: its part for Bokeh, caption and a text for who cannot see it."""

    name: str
    caption: str
    alt: str
    figure: Part
    wide: bool = False
    kind: ClassVar[str] = "chart"


@dataclass(frozen=True)
class Picture:
    """A figure of a results folder and its page: the name of its file, caption and alternative."""

    name: str
    figure: Figure
    caption: str
    alt: str


@dataclass(frozen=True)
class Image:
    """A picture inside the page, base64."""

    name: str
    caption: str
    alt: str
    data: str
    media_type: str
    width: int
    height: int
    kind: ClassVar[str] = "image"
