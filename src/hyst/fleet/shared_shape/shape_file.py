"""The file of a shared shape: JSON that a person can read, every double exact."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hyst.checks.arrays import finite_array
from hyst.checks.numbers import as_not_negative, as_number, as_positive, whole_number
from hyst.errors import InputError
from hyst.fleet.shared_shape.free_constants import FreeConstants
from hyst.fleet.shared_shape.noise import Noise
from hyst.fleet.shared_shape.population import Population
from hyst.operators import ModelDescription, operator_from_dict
from hyst.operators.model_file import SHARED_SHAPE, read_file, write_file
from hyst.operators.plain_data import as_mapping, as_text

if TYPE_CHECKING:
    from hyst.fleet.shared_shape.shared_shape import SharedShape

Array = NDArray[np.float64]

VERSION = 1
ENTRIES = (
    "version",
    "model",
    "basis",
    "population",
    "output_range",
    "delay",
    "scatter",
    "devices",
    "left_out",
)
OF_POPULATION = ("covariance", "noise", "stretch")
OF_NOISE = ("variance", "freedom", "correlation", "lacking")

ROUNDING = 1e-9
"""Of its largest entry: by so much a covariance may miss symmetry and positive eigenvalues."""


def shape_to_dict(shape: SharedShape) -> dict[str, Any]:
    """Give a shape as plain numbers, lists and text.

    Parameters
    ----------
    shape
        Any.
    """
    population = shape.population
    return {
        "version": VERSION,
        "model": shape.model.to_dict(),
        "basis": shape.constants.basis.tolist(),
        "population": None if population is None else _population_to_dict(population),
        "output_range": shape.output_range,
        "delay": shape.delay,
        "scatter": dict(shape.scatter),
        "devices": shape.devices,
        "left_out": {str(place): reason for place, reason in shape.left_out.items()},
    }


def shape_from_dict(data: Any) -> dict[str, Any]:
    """Give the fields of a shape from ``shape_to_dict()``.

    Parameters
    ----------
    data
        What it gave, or the same read from a file.

    Raises
    ------
    InputError
        If an entry is missing, unknown or not allowed.
    """
    given = _entries(data, ENTRIES, "a shared shape")
    if given["version"] != VERSION or type(given["version"]) is not int:
        raise InputError(
            f"version {given['version']!r} of the shared shape; this hyst reads version {VERSION}; "
            "use the hyst that wrote it"
        )
    model = operator_from_dict(given["model"])
    basis = _matrix(given["basis"], "basis")
    if basis.shape[0] != len(model.parameters()):
        raise InputError(
            f"basis has {basis.shape[0]} rows; the model has {len(model.parameters())} constants"
        )
    population = given["population"]
    found = None if population is None else _population_from_dict(population, basis.shape[1])
    scatter = as_mapping("scatter", given["scatter"])
    left_out = as_mapping("left_out", given["left_out"])
    return {
        "constants": FreeConstants(model, basis),
        "population": found,
        "output_range": as_positive(given["output_range"], "output_range"),
        "delay": as_number(given["delay"], "delay"),
        "scatter": {name: as_not_negative(each, name) for name, each in scatter.items()},
        "devices": whole_number(given["devices"], "devices", 0),
        "left_out": {_place(key): as_text("left_out", each) for key, each in left_out.items()},
    }


def write_shape(
    path: str | os.PathLike[str], data: dict[str, Any], about: ModelDescription
) -> None:
    """Write a file.

    Parameters
    ----------
    path
        To create or replace.
    data
        Of ``shape_to_dict``.
    about
        What the numbers of the mean device mean.
    """
    write_file(path, SHARED_SHAPE, {"shared_shape": data}, about)


def read_shape(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Give the fields of a shape from a file.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    InputError
        As ``SharedShape.load``.
    """
    saved = read_file(path, (SHARED_SHAPE,))
    try:
        fields = shape_from_dict(saved.content["shared_shape"])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    constants = fields["constants"]
    model = constants.model.with_description(saved.description)
    return fields | {"constants": FreeConstants(model, constants.basis)}


def _population_to_dict(population: Population) -> dict[str, Any]:
    noise = population.noise
    return {
        "covariance": population.covariance.tolist(),
        "noise": {name: getattr(noise, name) for name in OF_NOISE},
        "stretch": population.stretch,
    }


def _population_from_dict(data: Any, size: int) -> Population:
    given = _entries(data, OF_POPULATION, "a population")
    noise = _entries(given["noise"], OF_NOISE, "the noise of a population")
    return Population(
        _covariance(given["covariance"], size),
        Noise(
            as_positive(noise["variance"], "the variance of the noise"),
            as_positive(noise["freedom"], "the freedom of the noise"),
            _at_least_one(noise["correlation"], "the correlation of the noise"),
            as_not_negative(noise["lacking"], "the lacking part of the noise"),
        ),
        _at_least_one(given["stretch"], "stretch"),
    )


def _covariance(values: Any, size: int) -> Array:
    matrix, name = _matrix(values, "covariance"), "covariance"
    if matrix.shape != (size, size):
        raise InputError(f"{name} has shape {matrix.shape}; the basis asks for ({size}, {size})")
    small = ROUNDING * float(np.abs(matrix).max(initial=0.0))
    if np.abs(matrix - matrix.T).max(initial=0.0) > small:
        raise InputError(f"{name} is not symmetric; give a covariance")
    if size and float(np.linalg.eigvalsh(matrix)[0]) < -small:
        raise InputError(f"{name} has a negative eigenvalue; give a covariance")
    return matrix


def _matrix(values: Any, name: str) -> Array:
    matrix = finite_array(values, name)
    if matrix.ndim != 2:
        raise InputError(f"{name} has {matrix.ndim} dimensions; give rows of numbers")
    return matrix


def _at_least_one(value: Any, name: str) -> float:
    number = as_positive(value, name)
    if number < 1.0:
        raise InputError(f"{name} is {number:.6g}; give 1 or more")
    return number


def _place(key: str) -> int:
    if not key.isdecimal():
        raise InputError(f"left_out names record {key!r}; give its place as a whole number")
    return int(key)


def _entries(data: Any, names: tuple[str, ...], what: str) -> Mapping[str, Any]:
    given = as_mapping(what, data)
    for name in names:
        if name not in given:
            raise InputError(f"the entry {name!r} of {what} is missing")
    unknown = sorted(set(given) - set(names))
    if unknown:
        raise InputError(f"unknown entry {unknown[0]!r} of {what}; remove it or update hyst")
    return given
