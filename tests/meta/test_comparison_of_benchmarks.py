"""What `make bench` says of made-up ratios: worse, better, noise, missing, another machine."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks import __main__ as running
from benchmarks import recording, timing
from benchmarks.comparison import Change, Ratio, compared, of_runs, table


def ratio(value: float, spread: float = 0.02, better: str = "larger") -> Ratio:
    return Ratio(value, spread, better)  # type: ignore[arg-type]


def names(changes: tuple[Change, ...]) -> list[str]:
    return [each.name for each in changes]


def test_worse_is_beyond_a_quarter_whichever_way_is_better() -> None:
    before = {"peer over ours": ratio(5.0), "ours over peer": ratio(2.0, better="smaller")}
    now = {"peer over ours": ratio(3.9), "ours over peer": ratio(2.6, better="smaller")}
    found = compared(before, now)
    # 5 / 3.9 is 1.28, 2.6 / 2 is 1.3; the worst first.
    assert names(found.worse) == ["ours over peer", "peer over ours"]
    assert (found.better, found.alike, found.missing, found.new) == ((), (), (), ())


def test_within_a_quarter_nothing_is_said() -> None:
    before = {"peer over ours": ratio(5.0), "ours over peer": ratio(2.0, better="smaller")}
    now = {"peer over ours": ratio(4.1), "ours over peer": ratio(2.4, better="smaller")}
    assert names(compared(before, now).alike) == ["peer over ours", "ours over peer"]


@pytest.mark.parametrize("which", ["before", "now"])
def test_what_scatters_must_change_by_more_than_three_spreads(which: str) -> None:
    wide = {"before": (0.2, 0.01), "now": (0.01, 0.2)}[which]
    before = {"a": ratio(4.0, wide[0])}
    assert names(compared(before, {"a": ratio(2.6, wide[1])}).alike) == ["a"]  # 1.54 times
    assert names(compared(before, {"a": ratio(2.4, wide[1])}).worse) == ["a"]  # 1.67 times


def test_better_is_the_same_rule_turned() -> None:
    found = compared({"a": ratio(4.0), "b": ratio(1.0)}, {"a": ratio(5.1), "b": ratio(1.2)})
    assert names(found.better) == ["a"]
    assert names(found.alike) == ["b"]


def test_missing_and_new_ratios_are_named() -> None:
    found = compared({"a": ratio(1.0), "gone": ratio(1.0)}, {"a": ratio(1.0), "new": ratio(1.0)})
    said = table(found)
    assert "Recorded, but not measured now: gone." in said
    assert "Not recorded yet: new." in said
    assert "Nothing got worse beyond the noise." in said
    assert "Within the noise: 1." in said


def test_a_table_says_then_now_and_how_much() -> None:
    said = table(compared({"a": ratio(5.0)}, {"a": ratio(2.5)}))
    assert "| a | 5 | 2.5 | 2.00 | 1.25 |" in said


def test_runs_give_their_median_and_the_larger_spread() -> None:
    runs = [{"a": ratio(4.0)}, {"a": ratio(5.0)}, {"a": ratio(4.5, 0.3)}]
    assert of_runs(runs) == {"a": ratio(4.5, 0.3)}
    runs = [{"a": ratio(4.0)}, {"a": ratio(5.0)}, {"a": ratio(4.0)}]
    assert of_runs(runs)["a"] == ratio(4.0, 0.25)


def test_what_is_written_is_read_and_other_benchmarks_stay(tmp_path: Path) -> None:
    path = tmp_path / "recorded.json"
    recording.write({"one": {"a": ratio(4.0)}, "two": {"b": ratio(1.5, better="smaller")}}, path)
    recording.write({"one": {"a": ratio(4.25)}}, path)
    read = recording.read(path)
    assert read["one"]["ratios"] == {"a": ratio(4.25)}
    assert read["two"]["ratios"] == {"b": ratio(1.5, better="smaller")}
    assert recording.differences(read["one"]["machine"], recording.machine()) == []
    path.write_text('{"format": 99}')
    with pytest.raises(SystemExit, match="record it anew"):
        recording.read(path)


def test_another_machine_and_other_peers_are_told(tmp_path: Path) -> None:
    here = {"processor": "A", "python": "3.11", "peers": {"numba": "1"}}
    there = {"processor": "B", "python": "3.11", "peers": {"numba": "2"}}
    assert recording.differences(there, here) == ["processor was B, is A"]
    pins = tmp_path / "peers.txt"
    pins.write_text("# why\nnumpy==0.0.1  # old\nno-such-peer==2.0\n")
    told = recording.other_peers(recording.pinned(pins))
    assert told[0].endswith("pinned is 0.0.1")
    assert told[1] == "no-such-peer is not installed, pinned is 2.0"


def test_what_is_recorded_in_the_repository_is_read() -> None:
    assert recording.pinned(recording.PEERS)
    for each in recording.read().values():
        assert each["ratios"]
        assert all(ratio.value > 0.0 for ratio in each["ratios"].values())


def test_a_ratio_is_reported_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timing, "REPORTED", {})
    times = {"peer": [4.0, 4.4, 3.6, 4.0, 4.0], "ours": [1.0, 1.0, 1.0, 1.0, 1.0]}
    assert timing.report_times("a", times, "peer", "ours") == 4.0
    assert timing.REPORTED["a"].spread == 0.0
    with pytest.raises(ValueError, match="reported twice"):
        timing.report("a", 1.0)


def test_a_run_ends_with_1_only_where_that_is_asked(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "recorded.json"
    recording.write({"bank_sum": {"a": ratio(4.0)}}, path)
    recorded = recording.read(path)
    monkeypatch.setattr(recording, "read", lambda: recorded)
    monkeypatch.setattr(running, "_ratios", lambda name, runs: {"a": ratio(2.0)})
    assert running.main(["bank_sum"]) == 0
    assert running.main(["bank_sum", "--strict"]) == 1
    assert "| a | 4 | 2 | 2.00 | 1.25 |" in capsys.readouterr().out
