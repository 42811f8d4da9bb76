"""A picture of few colours, which takes half the bytes of one with all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

_MOST = 256
_CELLS = 1 << 15  # five bits of each of three colours


def with_palette(pixels: NDArray[np.uint8]) -> Image.Image:
    """Give a picture whose pixels are indices of at most 256 colours that occur in it.

    Colours that agree in five bits of red, green and blue become one of them; where more than 256
    are left, the rare ones become the nearest of the others.

    Parameters
    ----------
    pixels
        Shape (height, width, 4): red, green, blue, opacity. The opacity is taken as 1.
    """
    height, width, _ = pixels.shape
    colours = np.ascontiguousarray(pixels).view("<u4").reshape(-1)
    cells = (colours >> 3 & 0x1F) | (colours >> 6 & 0x3E0) | (colours >> 9 & 0x7C00)
    count = np.bincount(cells, minlength=_CELLS)
    one_of = np.zeros(_CELLS, dtype="<u4")
    one_of[cells] = colours  # the last one stays: for the background that is the last corner's
    found = np.flatnonzero(count)
    found = found[np.argsort(-count[found], kind="stable")]
    kept = one_of[found].view(np.uint8).reshape(-1, 4)[:_MOST, :3]
    index = np.zeros(_CELLS, dtype=np.uint8)
    index[found[:_MOST]] = np.arange(kept.shape[0])
    rare = one_of[found[_MOST:]].view(np.uint8).reshape(-1, 4)[:, :3]
    if rare.size:
        index[found[_MOST:]] = _nearest(rare, kept)
    picture = Image.fromarray(index[cells].reshape(height, width), "P")
    picture.putpalette(kept.tobytes())
    return picture


def _nearest(rare: NDArray[np.uint8], kept: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Give which of the kept colours is next to each rare one."""
    apart = rare[:, None, :].astype(np.float32) - kept[None, :, :]
    return np.asarray(np.square(apart).sum(axis=2).argmin(axis=1))
