"""Tables and figures of a comparison."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.operators import Affine
from hyst.report.comparison_figures import MOST_DRAWN, drawn_models

U = np.sin(np.linspace(0.0, 60.0, 3000)) * np.linspace(1.0, 0.3, 3000)
TRUE = hyst.PrandtlIshlinskii([0.5], [0.2], p0=1.0)
RECORD = hyst.Record(U, TRUE(U), 1e-3, input_unit="V", output_unit="um")


@pytest.mark.parametrize("count", [1, 2, 9])
def test_figures_show_the_best_models(count: int) -> None:
    models = {f"m{k}": Affine(1.0 + 0.1 * k, 0.0) @ TRUE for k in range(count - 1, -1, -1)}
    found = hyst.compare(models, [RECORD, RECORD.slice(0, 2000)])
    best = [each.name for each in drawn_models(found)]
    assert best == [f"m{k}" for k in range(min(count, MOST_DRAWN))]
    for draw in (hyst.report.draw_compared_loops, hyst.report.draw_compared_errors):
        picture = draw(found)
        assert picture.startswith(b"\x89PNG")
        assert picture == draw(found)  # equal arguments give equal bytes


def test_the_worst_place_names_the_record_where_there_are_several() -> None:
    spoiled = hyst.Record(U, RECORD.y + (np.arange(U.size) == 2500), 1e-3)
    table = hyst.report.compared_errors_table(hyst.compare({"a": TRUE}, [RECORD, spoiled]))
    assert table.rows[0][table.header.index("worst at")] == "record 2, sample 2500"
    assert table.rows[0][table.header.index("time [s]")] == "2.5"
    assert table.marked == 0


def test_other_ways_to_a_command_are_named() -> None:
    rate = hyst.RateDependentPrandtlIshlinskii([0.5], [0.2], 1e-3, 1e-3, p0=1.0)
    flat = hyst.PrandtlIshlinskii([0.5], [0.2], p0=0.0)
    found = hyst.compare({"true": TRUE, "rate": rate, "flat": flat}, RECORD)
    ways = {row[0]: row[5] for row in hyst.report.compared_models_table(found).rows}
    assert ways["true"] == "exact inverse"
    assert ways["flat"] == "none"
    told = hyst.report.not_invertible_sentences(found)
    assert any(each.startswith("flat has no exact inverse: ") for each in told)
    assert not any(each.startswith("true") for each in told)
