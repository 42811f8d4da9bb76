"""Where the panels of a picture are: written into its file, and taken apart for a page.

A picture of several panels beside each other is too wide for a phone. Its file says where each of
them is, so that a page can put one under another; as a file it stays whole.
"""

from __future__ import annotations

import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

from PIL import Image
from PIL.PngImagePlugin import PngInfo

_KEY = "hyst panels"
_LEAST_LETTERS = 9.0
"""Pixels: a picture is not shown so small that its letters are smaller."""


@dataclass(frozen=True)
class Place:
    """A panel in a picture.

    Parameters
    ----------
    box
        Left, upper, right, lower end, pixels from the upper left corner.
    words
        What it shows, for those who do not see it.
    is_legend
        Whether it is the legend of all the others.
    """

    box: tuple[int, int, int, int]
    words: str
    is_legend: bool = False


@dataclass(frozen=True)
class Places:
    """What is where in a picture.

    Parameters
    ----------
    heading
        Text above all panels, which is in none; may be empty.
    letters
        Size of its smallest letters, pixels; 0 where not known.
    columns
        Of panels.
    panels
        Row by row.
    """

    heading: str
    letters: float
    columns: int
    panels: tuple[Place, ...]


@dataclass(frozen=True, eq=False)
class Piece:
    """A panel taken out.

    Parameters
    ----------
    png
        Content of a file.
    words, is_legend
        As of its place.
    width, height
        Pixels.
    least_width
        Pixels to which it may be made narrower.
    """

    png: bytes
    words: str
    is_legend: bool
    width: int
    height: int
    least_width: int


def written_places(places: Places) -> PngInfo:
    """Give the block of text that goes into the file of a picture with ``places``."""
    info = PngInfo()
    info.add_itxt(_KEY, json.dumps(asdict(places), ensure_ascii=False))
    return info


def pieces_of(png: bytes) -> tuple[str, int, tuple[Piece, ...]]:
    """Take a picture apart.

    Parameters
    ----------
    png
        Content of a file; one that does not say where its panels are is one piece.

    Returns
    -------
    heading : str
        Text above all panels.
    columns : int
        Of panels.
    pieces : tuple of Piece
    """
    with Image.open(io.BytesIO(png)) as picture:
        picture.load()
        text = picture.info.get(_KEY)
        if text is None:
            width, height = picture.size
            return "", 1, (Piece(png, "", False, width, height, min(width, 320)),)
        told = json.loads(text)
        panels = tuple(Place(tuple(each.pop("box")), **each) for each in told.pop("panels"))
        places = Places(panels=panels, **told)
        return places.heading, places.columns, tuple(_cut(picture, places))


def _cut(picture: Image.Image, places: Places) -> Iterator[Piece]:
    for each in places.panels:
        part, content = picture.crop(each.box), io.BytesIO()
        part.save(content, "png", compress_level=6)
        share = min(1.0, _LEAST_LETTERS / places.letters) if places.letters else 1.0
        least = math.ceil(share * part.width)
        yield Piece(content.getvalue(), each.words, each.is_legend, *part.size, least)


def rounded_out(box: Sequence[float], width: int, height: int) -> tuple[int, int, int, int]:
    """Give a box in whole pixels that holds another, inside a picture.

    Parameters
    ----------
    box
        Left, upper, right, lower end, pixels.
    width, height
        Of the picture, pixels.
    """
    left, upper, right, lower = box
    return (
        max(math.floor(left), 0),
        max(math.floor(upper), 0),
        min(math.ceil(right), width),
        min(math.ceil(lower), height),
    )
