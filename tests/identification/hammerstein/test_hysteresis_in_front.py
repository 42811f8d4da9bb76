"""Any family may be in front of the dynamics, with its own options and sizes."""

from __future__ import annotations

import numpy as np
import pytest
from test_identify_hammerstein import DT, PI, G, U, identified, record_of

import hyst
from hyst.errors import InputError, NotIdentifiableError
from hyst.models import LinearDynamics
from hyst.signals import Record

FIVE = hyst.PrandtlIshlinskii([0.3, 0.2, 0.15, 0.1, 0.1], [0.5, 1.5, 3.0, 4.5, 6.0], 1.0)


def error_percent(model: hyst.Operator, front: hyst.Operator) -> float:
    """Rms error against the noiseless output, percent of its range."""
    clean = (G @ front)(U)
    return float(100.0 * (model(U) - clean)[200:].std() / np.ptp(clean))


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_the_number_of_plays_is_chosen(noise: float) -> None:
    """A fixed number of four, as in 0.1.0, leaves 0.18 % here."""
    found = identified(record_of(FIVE, noise), hysteresis="pi")
    assert error_percent(found.model, FIVE) < 0.05
    sizes = {each.plays for each in found.candidates}
    assert {1, 2, 3, 4, 6} <= sizes
    assert sum(each.chosen for each in found.candidates) == 1


def test_a_rate_dependent_hysteresis_may_be_in_front() -> None:
    plays = hyst.RateDependentPrandtlIshlinskii([0.5, 0.3], [1.5, 3.0], 4e-4, DT, p0=1.0)
    found = identified(record_of(plays, 0.0), hysteresis="rdpi", plays=2, state_order=2)
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert values["rate_dependent_prandtl_ishlinskii.beta"] == pytest.approx(4e-4, rel=1e-6)
    assert found.poles == pytest.approx(np.sort_complex(G.poles()), abs=1e-9)


def test_friction_may_be_in_front() -> None:
    front = hyst.models.Dahl(2.0, 5.0, 1.0)
    found = identified(record_of(front, 0.0), hysteresis="dahl", state_order=2)
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert values["dahl.sigma"] == pytest.approx(2.0, rel=1e-6)
    assert found.poles == pytest.approx(np.sort_complex(G.poles()), abs=1e-7)


def test_the_hysteresis_may_be_an_object() -> None:
    front = hyst.RambergOsgood(1.0, 0.1, 0.8)
    record = record_of(front, 0.01)
    family = hyst.families.Hammerstein(
        hysteresis=hyst.families.RambergOsgood(memory="masing"), state_order=2
    )
    by_object = hyst.identify(record, family=family)
    by_name = identified(record, hysteresis="ramberg-osgood", memory="masing", state_order=2)
    assert by_object.model == by_name.model
    by_both = identified(record, hysteresis=family.hysteresis, state_order=2)
    assert by_both.model == by_name.model
    assert by_name.front == family.hysteresis
    assert error_percent(by_object.model, front) < 0.05


def test_plays_that_come_out_idle_are_left_out() -> None:
    found = identified(record_of(PI, 0.0), hysteresis="pi", plays=5, state_order=2)
    assert sum(".r[" in name for name in found.parameter_names) == 3
    assert any("2 of 5 plays came out with no weight" in each for each in found.undetermined)
    assert error_percent(found.model, PI) < 1e-4


def test_options_reach_the_hysteresis() -> None:
    found = identified(record_of(PI, 0.0), hysteresis="pi", radii=[0.5, 1.5, 3.0], state_order=2)
    values = dict(zip(found.parameter_names, found.parameter_values, strict=True))
    assert [values[f"prandtl_ishlinskii.r[{i}]"] for i in (1, 2, 3)] == [0.5, 1.5, 3.0]
    assert values["prandtl_ishlinskii.p[2]"] == pytest.approx(0.2, rel=1e-6)


def test_what_the_hysteresis_does_not_take_is_refused() -> None:
    record = record_of(PI, 0.01)
    with pytest.raises(InputError, match=r"knots is for hysteresis gpi, .*, not for pi; leave"):
        identified(record, hysteresis="pi", knots=3)
    with pytest.raises(InputError, match=r"plays is for .* pi, .*, not for ramberg-osgood"):
        identified(record, hysteresis="ramberg-osgood", plays=3)
    with pytest.raises(InputError, match="memory is given beside a family object"):
        identified(record, hysteresis=hyst.families.RambergOsgood(), memory="masing")
    with pytest.raises(InputError, match="hysteresis is of type int; give the name"):
        identified(record, hysteresis=3)


def test_an_option_that_another_family_takes_is_used_there() -> None:
    record = Record(U[:2000], PI(U[:2000]), DT)
    found = hyst.identify(record, family="mpi,hammerstein", hysteresis="pi", knots=2, plays=3)
    assert {each.family for each in found.candidates} == {"mpi", "hammerstein"}


@pytest.mark.parametrize("name", ["duhem", "hammerstein"])
def test_what_cannot_be_in_front_is_answered_with_all_that_can(name: str) -> None:
    with pytest.raises(InputError, match=f"hysteresis is '{name}'; choose one of ") as said:
        identified(record_of(PI, 0.01), hysteresis=name)
    assert all(each in str(said.value) for each in hyst.families if each != "hammerstein")


def test_dynamics_are_compared_with_hysteresis_alone_in_one_table() -> None:
    found = hyst.identify(record_of(PI, 0.01), family="pi,mpi,hammerstein", hysteresis="pi")
    assert found.family == "hammerstein"
    assert {each.family for each in found.candidates} == {"pi", "mpi", "hammerstein"}
    best = {
        name: min(each.score for each in found.candidates if each.family == name)
        for name in ("pi", "mpi", "hammerstein")
    }
    # Neither hysteresis alone can follow a resonance: most of the output is left.
    assert best["hammerstein"] < 0.05 * min(best["pi"], best["mpi"])


def test_dynamics_that_explain_nothing_lose_against_hysteresis_alone() -> None:
    y = PI(U) + 0.02 * np.random.default_rng(0).normal(size=U.size)
    found = hyst.identify(Record(U, y, DT), family="pi,hammerstein", hysteresis="pi")
    assert found.family == "pi"
    assert {each.family for each in found.candidates} == {"pi", "hammerstein"}


def test_long_records_are_searched_in_part_and_fitted_in_whole() -> None:
    u = np.concatenate([U] * 5)
    y = (G @ PI)(u)
    y[20_000:] *= 1.03  # beyond what is searched, so that the gain of a fit to all is 1.01
    found = identified(Record(u, y, DT), hysteresis="pi", plays=3, state_order=2)
    v, true = found.hysteresis(u), PI(u)
    gain = float(v @ true) / float(true @ true)
    assert gain == pytest.approx(1.01, abs=0.002)


def test_several_records_are_identified_together() -> None:
    record = record_of(PI, 0.0)
    rest = np.zeros(300)  # each record starts from rest
    parts = [np.concatenate([rest, record.u[:3000]]), np.concatenate([rest, record.u[3000:]])]
    records = [Record(u, (G @ PI)(u), DT) for u in parts]
    found = hyst.identify(records, family="hammerstein", hysteresis="pi", plays=3, state_order=2)
    assert error_percent(found.model, PI) < 1e-4


@pytest.mark.parametrize(
    ("name", "front"),
    [
        ("coleman-hodgdon", hyst.ColemanHodgdon(0.2, 2.0, 1.6)),
        ("bouc-wen", hyst.BoucWen(0.6, 0.5, 0.06, 0.03, h=-1.0)),
    ],
)
def test_a_hysteresis_is_found_that_drowns_in_noise_behind_the_dynamics(
    name: str, front: hyst.Operator
) -> None:
    """A zero at -1: going back through these dynamics, half the sample rate has no bound."""
    poles = [0.8 + 0.4j, 0.8 - 0.4j]
    dynamics = LinearDynamics.from_zeros_poles_gain([-1.0], poles, 0.1, DT)
    clean = dynamics(front(U))
    noise = 0.002 * np.ptp(clean) * np.random.default_rng(1).normal(size=U.size)
    found = identified(Record(U, clean + noise, DT), hysteresis=name)
    assert found.dynamics.order == 2
    # A tenth of the noise: 8 or 9 constants and 6000 samples leave 0.04 of it.
    assert np.std(found.model(U) - clean) < 0.1 * 0.002 * np.ptp(clean)


@pytest.mark.parametrize("name", ["masing", "coleman-hodgdon", "ramberg-osgood"])
def test_a_line_before_dynamics_is_no_hysteresis(name: str) -> None:
    """Behind dynamics of too low an order a line looks like a loop."""
    with pytest.raises(NotIdentifiableError, match=r"line|no loop"):
        identified(record_of(hyst.Affine(1.5), 0.01), hysteresis=name)


def test_a_front_that_leaves_out_terms_is_told_with_those_it_has() -> None:
    front = hyst.LuGre(4.0, 0.0, 2e-3, Fc=4.0, Fs=4.0, vs=100.0, dt=DT)
    lag = LinearDynamics.from_transfer_function([0.4], [1.0, -0.6], DT)
    clean = lag(front(U))
    noise = 1e-4 * np.ptp(clean) * np.random.default_rng(1).normal(size=U.size)
    found = identified(Record(U, clean + noise, DT), hysteresis="lugre", state_order=1)
    assert not any(name.startswith("lugre.Fv") for name in found.parameter_names)
    # A tenth of the noise: some ten constants and 6000 samples leave 0.04 of it.
    assert np.std(found.model(U) - clean) < 1e-5 * np.ptp(clean)
