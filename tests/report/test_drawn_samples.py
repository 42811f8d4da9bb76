"""What is drawn of long records."""

import numpy as np

from hyst.report.drawn_samples import drawn_path, drawn_samples


def test_short_records_are_drawn_as_they_are() -> None:
    x = np.linspace(0.0, 1.0, 50_000)
    assert np.array_equal(drawn_samples(x), np.arange(x.size))
    assert drawn_path(x, x)[0] is x


def test_samples_are_spread_over_every_phase_and_extremes_kept() -> None:
    count = 1_000_003
    phase = np.arange(count) % 500
    signal = np.sin(2.0 * np.pi * phase / 500.0)
    signal[777_777] = -9.0
    chosen = drawn_samples(signal)
    assert 777_777 in chosen
    assert {0, count - 1} <= set(chosen.tolist())
    assert chosen.size < 60_000
    assert np.bincount(phase[chosen], minlength=500).min() > 50


def test_paths_keep_their_extremes_and_go_on_without_chords() -> None:
    turns = np.arange(1_000_000) * 2.0 * np.pi / 400.0
    grows = np.linspace(0.5, 1.0, turns.size)
    x, y = drawn_path(grows * np.cos(turns), grows * np.sin(turns))
    assert x.size < 150_000
    assert np.nanmax(x) > 0.999
    chords = np.hypot(np.diff(x), np.diff(y))
    assert np.nanmax(chords) < 0.03


def test_a_line_that_stands_still_is_drawn() -> None:
    x, y = drawn_path(np.zeros(60_000), np.ones(60_000))
    assert (x.tolist(), y.tolist()) == ([0.0], [1.0])
