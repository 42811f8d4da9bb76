"""An output that has nothing to do with its input is refused, a weak one told."""

from __future__ import annotations

import numpy as np
import pytest
from faulty_records import diagnosed, good, only, record
from healthy_records import plays

NAME = "output is noise"


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("drive", ["triangle", "sine", "white"])
def test_pure_noise(seed: int, drive: str) -> None:
    random = np.random.default_rng(seed)
    u = random.uniform(0.0, 100.0, 2000) if drive == "white" else good(2000, kind=drive)[0]
    y = random.normal(0.0, 1.0, 2000) if seed % 2 else random.uniform(0.0, 1.0, 2000)
    finding = only(diagnosed(record(u, y)), NAME)
    assert finding.severity == "refusal"


@pytest.mark.parametrize("kind", ["triangle", "sine"])
def test_a_weak_output_is_a_warning(kind: str) -> None:
    u, y = good(kind=kind)
    random = np.random.default_rng(1)
    weak = y + random.normal(0.0, 2.5 * y.std(), y.size)
    finding = only(diagnosed(record(u, weak)), NAME)
    assert finding.severity == "warning"
    # 1 / (1 + 2.5^2) of the variance, give or take three times 2 sqrt(share / N) and the cells.
    assert finding.amounts["explained"] == pytest.approx(1.0 / 7.25, abs=0.03)


@pytest.mark.parametrize("delay", [0, 3, 40, 300])
def test_a_delayed_answer_to_a_white_drive_is_not_refused(delay: int) -> None:
    u = np.random.default_rng(2).uniform(-50.0, 50.0, 4000)
    y = np.concatenate((np.zeros(delay), plays(u)[: u.size - delay]))
    assert not diagnosed(record(u, y)).of("refusal")
