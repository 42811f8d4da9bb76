"""Pictures of few colours: what is kept, and how far the others move."""

from __future__ import annotations

import numpy as np

from hyst.report.palette import with_palette


def seen(pixels: np.ndarray) -> np.ndarray:
    return np.asarray(with_palette(pixels).convert("RGB"))


def test_few_colours_stay_as_they_are() -> None:
    colours = np.array([[194, 65, 12, 255], [29, 78, 216, 255], [255, 255, 255, 255]], np.uint8)
    pixels = colours[np.random.default_rng(0).integers(0, 3, (40, 60))]
    assert np.array_equal(seen(pixels), pixels[..., :3])


def test_many_colours_move_by_little_and_the_ground_not_at_all() -> None:
    x = np.linspace(0.0, 1.0, 400)[None, :, None]
    ends = np.array([[194, 65, 12], [255, 255, 255], [29, 78, 216]])
    fades = np.concatenate([ends[1] + x * (end - ends[1]) for end in ends])
    pixels = np.full((8, 400, 4), 255, np.uint8)
    pixels[:3, :, :3] = np.rint(fades)
    moved = np.abs(seen(pixels).astype(int) - pixels[..., :3])
    # Eight levels of 256 are one cell of five bits.
    assert moved.max() < 8
    assert moved[3:].max() == 0


def test_more_colours_than_a_palette_has() -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (100, 100, 4)).astype(np.uint8)
    pixels[20:] = 255
    picture = with_palette(pixels)
    assert (picture.mode, picture.size) == ("P", (100, 100))
    moved = np.abs(np.asarray(picture.convert("RGB")).astype(int) - pixels[..., :3])
    assert moved[20:].max() == 0
    # 256 points in the cube leave at most some 60 to the nearest along each side.
    assert 0 < moved.max() < 128
