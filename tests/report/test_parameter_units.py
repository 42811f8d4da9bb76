"""Units of constants, against what their equations say."""

from __future__ import annotations

import hyst
from hyst.models import resonance
from hyst.report import constants_table, units_of_parameters

PLAYS = hyst.PrandtlIshlinskii([0.3, 0.2], [0.5, 1.0], p0=0.5)


def test_plays_between_maps() -> None:
    model = hyst.Affine(2.0, 1.0) @ PLAYS @ hyst.DeadZone([1.0, 0.1], [0.0, 0.4])
    units = dict(zip(model.parameters().names, units_of_parameters(model, "V", "um"), strict=True))
    assert units["prandtl_ishlinskii.p0"] == units["prandtl_ishlinskii.p[2]"] == "um/V"
    assert units["prandtl_ishlinskii.r[1]"] == units["dead_zone.thresholds[2]"] == "V"
    assert units["dead_zone.weights[2]"] == units["affine.gain"] == ""
    assert units["affine.offset"] == "um"


def test_powers_that_are_not_whole() -> None:
    """Of dz = du (A - |z|^n (...)), y = k z with z in V^1: beta and gamma have [z]^-n."""
    model = hyst.BoucWen(k=2.0, A=0.8, beta=1.5, gamma=0.6, n=1.3)
    by_name = dict(
        zip(model.parameters().names, units_of_parameters(model, "V", "um"), strict=True)
    )
    scaled = model.in_units(2.0, 4.0).parameters()
    for name, before, after in zip(
        scaled.names, model.parameters().values, scaled.values, strict=True
    ):
        assert after == before * _worth(by_name[name], {"V": 2.0, "um": 4.0}), name


def _worth(unit: str, of: dict[str, float]) -> float:
    """Compute a unit's factor from what is written."""
    above, _, below = unit.partition("/")
    worth = 1.0
    for text, sign in ((above, 1.0), (below, -1.0)):
        for factor in text.strip("()").split():
            name, _, power = factor.partition("^")
            worth *= of.get(name, 1.0) ** (sign * float(power or 1.0))
    return worth


def test_what_depends_on_time_says_only_what_its_name_tells() -> None:
    model = resonance(200.0, 0.1, 1e-4) @ PLAYS
    units = units_of_parameters(model, "V", "um")
    names = model.parameters().names
    for name, unit in zip(names, units, strict=True):
        assert (unit == "") == name.startswith("linear_dynamics"), name


def test_units_that_are_products_are_held_together() -> None:
    assert units_of_parameters(PLAYS, "A/m", "T") == ("T/(A/m)",) * 3 + ("A/m",) * 2


def test_a_table_without_known_units_has_no_column_of_them() -> None:
    assert constants_table(PLAYS).header == ("name", "value")
    assert constants_table(PLAYS, "V", "um").header == ("name", "value", "unit")
