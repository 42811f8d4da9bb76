"""Ratios of this run against those that were recorded: which got worse beyond the noise."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

Better = Literal["larger", "smaller"]

LEAST_CHANGE = 0.25
SPREADS = 3.0


@dataclass(frozen=True)
class Ratio:
    """A ratio, its relative spread, and which way it gets better."""

    value: float
    spread: float
    better: Better


@dataclass(frozen=True)
class Change:
    """A ratio then and now; `times` above 1 is worse."""

    name: str
    before: Ratio
    now: Ratio

    @property
    def times(self) -> float:
        larger = self.before.better == "larger"
        over = self.before.value, self.now.value
        return over[0] / over[1] if larger else over[1] / over[0]

    @property
    def noise(self) -> float:
        """The factor within which nothing is said: 1.25, or three spreads of either run."""
        return 1.0 + max(LEAST_CHANGE, SPREADS * max(self.before.spread, self.now.spread))


@dataclass(frozen=True)
class Comparison:
    """What got worse or better beyond the noise, what did not, what was not measured or is new."""

    worse: tuple[Change, ...]
    better: tuple[Change, ...]
    alike: tuple[Change, ...]
    missing: tuple[str, ...]
    new: tuple[str, ...]


def compared(recorded: Mapping[str, Ratio], measured: Mapping[str, Ratio]) -> Comparison:
    """Compare all ratios that are there twice, the worst first."""
    changes = [
        Change(name, recorded[name], now) for name, now in measured.items() if name in recorded
    ]
    changes.sort(key=lambda each: -each.times)
    worse = [each for each in changes if each.times > each.noise]
    better = [each for each in changes if 1.0 / each.times > each.noise]
    return Comparison(
        worse=tuple(worse),
        better=tuple(reversed(better)),
        alike=tuple(each for each in changes if each not in worse + better),
        missing=tuple(name for name in recorded if name not in measured),
        new=tuple(name for name in measured if name not in recorded),
    )


def of_runs(runs: Iterable[Mapping[str, Ratio]]) -> dict[str, Ratio]:
    """Give medians over runs; the spread is the largest within a run or between runs."""
    all_runs = list(runs)
    found = {}
    for name in all_runs[0]:
        each = [run[name] for run in all_runs if name in run]
        values = sorted(one.value for one in each)
        middle = values[len(values) // 2]
        between = max(values[-1] / middle - 1.0, middle / values[0] - 1.0)
        within = max(one.spread for one in each)
        found[name] = Ratio(middle, max(between, within), each[0].better)
    return found


def table(comparison: Comparison) -> str:
    """Write the comparison as tables, worst first."""
    lines = []
    for title, changes in (("worse", comparison.worse), ("better", comparison.better)):
        if not changes:
            lines.append(f"Nothing got {title} beyond the noise.")
            continue
        lines += [f"Got {title}:", "", "| ratio | recorded | now | times | noise |"]
        lines.append("|---|---|---|---|---|")
        for each in changes:
            times = each.times if title == "worse" else 1.0 / each.times
            lines.append(
                f"| {each.name} | {each.before.value:.3g} | {each.now.value:.3g} | {times:.2f} "
                f"| {each.noise:.2f} |"
            )
        lines.append("")
    lines.append(f"Within the noise: {len(comparison.alike)}.")
    for title, names in (
        ("Recorded, but not measured now", comparison.missing),
        ("Not recorded yet", comparison.new),
    ):
        if names:
            lines.append(f"{title}: {', '.join(names)}.")
    return "\n".join(lines)
