"""Every family of models keeps what a family promises, whatever it is."""

from __future__ import annotations

import dataclasses
import functools
import pickle
from pathlib import Path

import numpy as np
import pytest

import hyst
from hyst import InputError, NotIdentifiableError, NotInvertibleError
from hyst.identification import Identified
from hyst.identification.families.family import Family
from reference.family_examples import DT, FamilyExample, family_example, names_with_an_example

NAMES = tuple(hyst.families)
RUNS = 40


def identified(name: str, records: list[hyst.Record], **more: object) -> Identified:
    options = family_example(name).options | {"delay": 0} | more
    return hyst.identify(records, family=name, **options)


@functools.cache
def noisy_fits(name: str) -> list[Identified]:
    example = family_example(name)
    return [identified(name, example.records(example.noise, seed)) for seed in range(RUNS)]


def true_constants(example: FamilyExample, found: Identified) -> np.ndarray:
    """The actuator's constants that the family names, in its order, without the names of maps."""
    own = dict(
        zip(example.model.parameters().names, example.model.parameters().values, strict=True)
    )
    straight = {name: 0.0 for name in found.parameter_names if ".weights[" in name}
    values = straight | own | example.told
    return np.array([values[name] for name in found.parameter_names])


def test_every_family_has_an_example() -> None:
    assert names_with_an_example() == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_it_is_an_object_with_words(name: str) -> None:
    family = hyst.families[name]
    assert isinstance(family, Family)
    assert family.name == name
    assert getattr(hyst.families, type(family).__name__) is type(family)
    assert family.words.full_name
    assert family.words.equations[0].startswith("y(t) = ") or "y(t)" in family.words.equations[-1]
    assert all(each.endswith(".") for each in family.words.explanations)
    assert family.words.explanations
    assert family.methods


def test_no_two_families_have_the_same_words() -> None:
    for words in ("full_name", "equations", "explanations"):
        told = [getattr(hyst.families[name].words, words) for name in NAMES]
        assert len(set(told)) == len(told)


@pytest.mark.parametrize("name", NAMES)
def test_its_options_are_explained(name: str) -> None:
    family = hyst.families[name]
    for option, what in family.options().items():
        assert what.help.endswith(".")
        assert what.metavar
        assert any(f"    {option}\n" in (each.__doc__ or "") for each in type(family).__mro__)


@pytest.mark.parametrize("name", NAMES)
def test_foreign_options_are_refused_by_name(name: str) -> None:
    every = {option for other in NAMES for option in hyst.families[other].options()}
    records = family_example(name).records()
    own = {option for option in every if name in hyst.families.takers(option)}
    for option in every - own:
        with pytest.raises(InputError, match=f"{option} is for family .* not for {name}"):
            hyst.identify(records, family=name, **{option: 1})


@pytest.mark.parametrize("name", NAMES)
def test_a_misspelled_option_is_refused(name: str) -> None:
    with pytest.raises(InputError, match=f"'playes' is no option of family {name}"):
        hyst.identify(family_example(name).records(), family=name, playes=3)


@pytest.mark.parametrize("name", NAMES)
def test_the_object_and_the_name_mean_the_same(name: str) -> None:
    options = family_example(name).options
    family = hyst.families.make(name, options)
    assert isinstance(family, type(hyst.families[name]))
    by_object = hyst.identification.chosen_families(family, {})
    assert list(by_object) == list(hyst.identification.chosen_families(name, options))


@pytest.mark.parametrize("name", ["pi", "ramberg-osgood"])
def test_the_object_and_the_name_find_the_same(name: str) -> None:
    example = family_example(name)
    family = hyst.families.make(name, example.options)
    found = hyst.identify(example.records(example.noise, 0), family=family, delay=0)
    assert found.model == noisy_fits(name)[0].model


@pytest.mark.parametrize("name", NAMES)
def test_options_beside_an_object_are_refused(name: str) -> None:
    with pytest.raises(InputError, match="beside a family object"):
        hyst.identify(family_example(name).records(), family=hyst.families[name], plays=2)


@pytest.mark.parametrize("name", NAMES)
def test_an_object_of_another_version_is_refused(name: str) -> None:
    family = pickle.loads(pickle.dumps(hyst.families[name]))
    object.__setattr__(family, "of_another_version", 1)
    with pytest.raises(InputError, match="another version"):
        hyst.identify(family_example(name).records(), family=family)


NO_VALUE = (None, True, np.True_, float("nan"), b"1", "1;2", [], [[1.0]], [1, "a"], {}, object, 3j)
"""None of them is a value of any option, but None, which stands for an option left out."""


@pytest.mark.parametrize("name", NAMES)
def test_what_is_no_value_of_an_option_is_refused(name: str) -> None:
    family = type(hyst.families[name])
    for option in family.options():
        for value in NO_VALUE:
            if value is None and getattr(hyst.families[name], option) is None:
                continue
            if option == family.wraps and isinstance(value, str):
                continue  # names are known to the registry
            with pytest.raises(InputError, match=f"{option} (is|are) "):
                family(**{option: value})


@pytest.mark.parametrize("name", NAMES)
def test_an_object_with_a_value_of_another_version_is_refused(name: str) -> None:
    for option in hyst.families[name].options():
        family = pickle.loads(pickle.dumps(hyst.families[name]))
        object.__setattr__(family, option, "of another version")
        with pytest.raises(InputError, match=f"{option} is 'of another version'"):
            hyst.identify(family_example(name).records(), family=family)


@pytest.mark.parametrize("name", NAMES)
def test_its_results_go_from_process_to_process(name: str) -> None:
    records = family_example(name).records()
    found = identified(name, records)
    there, u = pickle.loads(pickle.dumps(found)), records[0].u
    assert there.predict(u).tolist() == found.predict(u).tolist()
    for one, other in zip(there.band(u), found.band(u), strict=True):
        assert one.tolist() == other.tolist()


@pytest.mark.parametrize("name", NAMES)
def test_it_recovers_its_own_constants(name: str) -> None:
    example = family_example(name)
    found = identified(name, example.records())
    expected = true_constants(example, found)
    scale = np.maximum(np.abs(expected), 1e-2)
    assert np.abs((found.parameter_values - expected) / scale).max() < example.exactly


@pytest.mark.parametrize("name", NAMES)
def test_standard_errors_agree_with_scatter(name: str) -> None:
    """Over 40 noises; each of them knows a standard deviation to 11 %."""
    fits = noisy_fits(name)
    assert {fit.parameter_names for fit in fits} == {fits[0].parameter_names}
    values = np.array([fit.parameter_values for fit in fits])
    stated = np.array([fit.standard_errors for fit in fits])
    told = np.isfinite(stated).all(axis=0)
    assert told.any()
    scatter = values[:, told].std(axis=0, ddof=1)
    ratio = scatter / np.sqrt(np.mean(np.square(stated[:, told]), axis=0))
    # Three and a half times 11 % up; stated errors may be a little larger than the scatter, since
    # bounds and kinks hold estimates back.
    assert ratio.max() < 1.4, dict(zip(np.array(fits[0].parameter_names)[told], ratio, strict=True))
    assert ratio.min() > 0.5, dict(zip(np.array(fits[0].parameter_names)[told], ratio, strict=True))


@pytest.mark.parametrize("name", NAMES)
def test_constants_scatter_around_the_truth(name: str) -> None:
    fits = noisy_fits(name)
    expected = true_constants(family_example(name), fits[0])
    errors = np.array([fit.parameter_values for fit in fits]) - expected
    stated = np.array([fit.standard_errors for fit in fits])
    inside = (np.abs(errors) <= 2.0 * stated)[np.isfinite(stated)]
    # 95 % of Gaussian errors; correlated within a fit, so that 40 fits know the share to 4 %.
    assert inside.mean() > 0.83


@pytest.mark.parametrize("name", NAMES)
def test_the_result_does_not_depend_on_units(name: str) -> None:
    """Powers of two scale everything bit for bit."""
    example = family_example(name)
    plain = noisy_fits(name)[0]
    for input_scale, output_scale in ((2.0**-40, 2.0**33), (2.0**200, 2.0**-200)):
        records = [
            dataclasses.replace(each, u=each.u * input_scale, y=each.y * output_scale)
            for each in example.records(example.noise, 0)
        ]
        scaled = identified(name, records)
        expected = plain.model.in_units(input_scale, output_scale).parameters()
        assert scaled.model.parameters().names == expected.names
        alike = [not each.endswith(example.unit_of_its_own) for each in expected.names]
        np.testing.assert_array_equal(
            scaled.model.parameters().values[alike], expected.values[alike]
        )
        # A unit to a power that is no whole number takes a rounding or two.
        np.testing.assert_allclose(scaled.model.parameters().values, expected.values, rtol=1e-13)
        factors = plain.model.parameter_scales(input_scale, output_scale)
        for i, each in enumerate(plain.parameter_names):
            if each in example.told:
                of_input, of_output = example.told_units.get(each, (0, 0))
                factor = input_scale**of_input * output_scale**of_output
                assert scaled.parameter_values[i] == factor * plain.parameter_values[i]
                errors = scaled.standard_errors[i], factor * plain.standard_errors[i]
                np.testing.assert_allclose(*errors, rtol=1e-9)
                continue
            at = expected.names.index(each)
            if alike[at]:
                errors = scaled.standard_errors[i], plain.standard_errors[i] * factors[at]
                np.testing.assert_allclose(*errors, rtol=1e-9)
        assert scaled.delay == plain.delay
        percent = scaled.metrics["training"].rms_percent
        assert percent == pytest.approx(plain.metrics["training"].rms_percent, rel=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_the_model_file_gives_it_back(name: str, tmp_path: Path) -> None:
    found = noisy_fits(name)[0]
    found.model.save(tmp_path / "model.json", found.description)
    assert hyst.load(tmp_path / "model.json") == found.model
    assert found.description.family == name


@pytest.mark.parametrize("name", NAMES)
def test_it_has_an_inverse_or_says_why_not(name: str) -> None:
    model = noisy_fits(name)[0].model
    u = family_example(name).drives[0]
    if model.is_invertible():
        y = model(u)
        span = float(np.ptp(u))
        # Slopes between 0.02 and 50 of the mean amplify rounding by less than 1e5.
        assert np.abs(model.inverse()(y) - u).max() < 1e-10 * span
        assert "exact" in hyst.families[name].methods
        return
    with pytest.raises(NotInvertibleError) as caught:
        model.inverse()
    assert str(caught.value)
    assert hyst.families[name].methods != ("exact",)


@pytest.mark.parametrize("name", NAMES)
def test_what_it_says_is_plain(name: str) -> None:
    found = noisy_fits(name)[0]
    assert f"family {name}" in found.summary()
    assert found.to_dict()["family"] == name
    assert found.status == "converged"


@pytest.mark.parametrize("name", NAMES)
def test_the_verdict_is_good_on_its_own_record_and_on_no_foreign_one(name: str) -> None:
    assert noisy_fits(name)[0].verdict.level == "good"
    example = family_example(name)
    assert identified(name, example.records()).verdict.level == "good"
    others = [hyst.Record(u, example.foreign(u), DT) for u in example.drives]
    try:
        foreign = identified(name, others, allow_unconverged=True)
    except NotIdentifiableError:
        return  # a refusal says as much
    assert foreign.verdict.level == "unfit"


@pytest.mark.parametrize("name", [name for name in NAMES if name != "linear"])
def test_it_can_be_compared_with_a_line(name: str) -> None:
    example = family_example(name)
    records = example.records(example.noise, 0)
    found = hyst.identify(records, family=f"{name},linear", delay=0, **example.options)
    assert {each.family for each in found.candidates} == {name, "linear"}
    assert found.family == name


def test_a_family_that_the_records_cannot_serve_is_left_out_and_told() -> None:
    """A slow sine excites no impulse response; the others are compared all the same."""
    records, families = family_example("pi").records(), "linear,pi,hammerstein"
    found = hyst.identify(records, family=families, plays=2, delay=0, fir_order=64)
    assert {each.family for each in found.candidates} == {"linear", "pi"}
    assert any(each.startswith("hammerstein is not compared") for each in found.undetermined)


def test_an_unknown_family_is_answered_with_the_whole_list() -> None:
    records = family_example("linear").records()
    with pytest.raises(InputError) as caught:
        hyst.identify(records, family="pi,nonsense")
    assert "unknown family 'nonsense'" in str(caught.value)
    assert all(name in str(caught.value) for name in (*NAMES, "auto"))


def test_a_family_of_no_kind_is_refused() -> None:
    with pytest.raises(InputError, match="family is of type int"):
        hyst.identify(family_example("linear").records(), family=3)
