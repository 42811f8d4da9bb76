"""What hyst adapt tells of maps that it does not estimate."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import hyst
from hyst.cli import main


@pytest.mark.parametrize("estimate_maps", [False, True])
def test_maps_that_are_held_are_named_so_and_not_drawn(
    estimate_maps: bool,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    titles: list[str] = []
    draw = FigureCanvasAgg.draw

    def watched(self: FigureCanvasAgg) -> None:
        titles.extend(axes.get_title(loc="left") for axes in self.figure.axes)
        draw(self)

    monkeypatch.setattr(FigureCanvasAgg, "draw", watched)
    stage = hyst.ModifiedPrandtlIshlinskii(
        hyst.PrandtlIshlinskii([0.3, 0.2], [1.0, 3.0], 0.5), hyst.DeadZone([1.0, -0.2], [0.0, 4.0])
    )
    u = 10.0 * np.sin(2.0 * np.pi * np.arange(2000) / 500.0)
    hyst.io.write_columns(tmp_path / "data.csv", ["drive", "way"], (u, stage(u)))
    stage.save(tmp_path / "model.json")
    words = ["adapt", str(tmp_path / "model.json"), str(tmp_path / "data.csv"), "--rate", "500"]
    more = ["--estimate-maps"] if estimate_maps else []
    columns = ["--input", "drive", "--output", "way", "-o", str(tmp_path / "out")]
    assert main([*words, *columns, *more]) == 0
    shown = capsys.readouterr().out
    row = next(line for line in shown.splitlines() if line.split()[:1] == ["back[2]"])
    assert (row.split()[-1] == "held") is not estimate_maps
    assert "maps before and after the plays" in shown
    assert "weights" in titles
    assert ("weights of maps" in titles) is estimate_maps
