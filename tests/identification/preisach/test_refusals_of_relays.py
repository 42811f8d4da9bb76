"""Records and options that a Preisach model cannot be found from are refused, or told."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst import InputError, NotIdentifiableError
from hyst.identification import identify_from_reversal_curves
from reference.switching_material import gaussian, strokes, switched

DENSITY = gaussian(0.35, 0.12, 0.2)


def record(turns: list[float], samples: int = 100) -> hyst.Record:
    u = strokes(turns, samples)
    return hyst.Record(u, switched(DENSITY, u), 0.01)


def test_records_that_cross_a_part_of_the_grid_are_refused() -> None:
    """A third of the range on either side: relays up at the one and down at the other rest."""
    parts = [record([-1.0, -0.4, -1.0, -0.4]), record([0.4, 1.0, 0.4, 1.0])]
    with pytest.raises(NotIdentifiableError, match=r"cross \d+ of 300 cells .*hyst\.signals\.forc"):
        hyst.identify(parts, family="preisach", delay=0, levels=24)


def test_cells_beyond_the_drive_are_told_and_filled() -> None:
    turns = [-1.0, 1.0, -1.0, 1.0, -0.5, 0.7, -0.3, 1.0, 0.1, 1.0, -1.0]
    thresholds = np.linspace(-1.2, 1.2, 13).tolist()
    found = hyst.identify(record(turns), family="preisach", delay=0, levels=thresholds)
    # Of the 12 cells in each outer row and column, the outermost twelfth of a cell was reached.
    assert any("were never crossed; the prior" in each for each in found.undetermined)
    relays = next(each for each in found.model.parts if isinstance(each, hyst.Preisach))
    # Its neighbour inside has mass, so that the prior gives it some.
    assert relays.weights[6, 0] > 0.0 or relays.weights[11, 5] > 0.0


def test_more_levels_than_samples_are_refused() -> None:
    with pytest.raises(NotIdentifiableError, match=r"48 levels need more than 98"):
        hyst.identify(record([-1.0, 1.0, -1.0], 20), family="preisach", delay=0, levels=48)


def test_few_samples_get_few_levels() -> None:
    found = hyst.identify(record([-1.0, 1.0, -1.0, 1.0], 20), family="preisach", delay=0)
    relays = next(each for each in found.model.parts if isinstance(each, hyst.Preisach))
    # 121 samples, of which the first stroke's do not count: one level for 8 of them.
    assert relays.thresholds.size - 1 < 16


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("levels", 3, "levels is 3"),
        ("levels", 49, "levels is 49"),
        ("levels", [0.0, 1.0], "levels are 2 thresholds"),
        ("smoothness", -1.0, "smoothness is -1"),
        ("smoothness", "much", "smoothness is 'much'"),
    ],
)
def test_options_out_of_range(option: str, value: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        hyst.families.make("preisach", {option: value})


def test_too_few_reversal_curves_are_refused() -> None:
    with pytest.raises(NotIdentifiableError, match="have 3 first-order reversal curves"):
        identify_from_reversal_curves(record([-1.0, 1.0, 0.0, 1.0, -0.5, 1.0, -1.0, 1.0]))


@pytest.mark.parametrize("smoothness", [-1.0, 101.0, 1e300])
def test_a_strength_out_of_range_is_refused(smoothness: float) -> None:
    drive = hyst.signals.forc(0.01, -1.0, 1.0, 1.0, curves=6)
    with pytest.raises(InputError, match="from 0 to 100"):
        identify_from_reversal_curves(hyst.Record(drive.u, drive.u, 0.01), smoothness=smoothness)


def test_curves_of_an_output_that_rests_are_refused() -> None:
    drive = hyst.signals.forc(0.01, -1.0, 1.0, 1.0, curves=6)
    with pytest.raises(NotIdentifiableError, match="rests"):
        identify_from_reversal_curves(hyst.Record(drive.u, np.ones(drive.u.size), 0.01))


def test_one_frequency_shows_no_shift() -> None:
    with pytest.raises(NotIdentifiableError, match="one frequency"):
        hyst.identify(record([-1.0, 1.0, -1.0, 1.0]), family="rate-dependent-preisach", delay=0)
