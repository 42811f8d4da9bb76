"""From the kind named in a dictionary to the class that can rebuild the operator."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any, TypeVar

from hyst.errors import InputError, NotInvertibleError

if TYPE_CHECKING:
    from hyst.operators.base import Operator

_CLASSES: dict[str, type[Operator]] = {}

OperatorClass = TypeVar("OperatorClass", bound="type[Operator]")


def register(operator_class: OperatorClass) -> OperatorClass:
    """Make a class known under its ``kind``; used as a decorator.

    Parameters
    ----------
    operator_class
        A final subclass of ``Operator``.

    Returns
    -------
    type
        The class itself.
    """
    _CLASSES[operator_class.kind] = operator_class
    return operator_class


def registered() -> dict[str, type[Operator]]:
    """Give all known classes by kind; the contract tests go through them.

    Returns
    -------
    dict
    """
    return dict(_CLASSES)


def compose(stages: tuple[Operator, ...]) -> Operator:
    """Make a composition without a name; ``f @ g`` is ``compose((g, f))``.

    Parameters
    ----------
    stages
        Operators in the order the signal passes them.

    Returns
    -------
    Operator

    Raises
    ------
    InputError
        If something else than an operator is among them.
    """
    # The class is looked up, since its base class, which offers ``@``, cannot import it.
    composition: Any = _CLASSES["composition"]
    made: Operator = composition(stages)
    return made


def delayed(operator: Operator, samples: int) -> Operator:
    """Make an operator that gives its output some samples later.

    Parameters
    ----------
    operator
        Any operator.
    samples
        At least 1.

    Returns
    -------
    Operator

    Raises
    ------
    NotInvertibleError
        While there is no operator that delays.
    """
    if "delay" not in _CLASSES:
        raise NotInvertibleError(
            "there is no operator that delays a command by whole samples; use inverse() without a "
            "preview, which answers at once"
        )
    delay: Any = _CLASSES["delay"]
    return compose((operator, delay(samples, operator.dt)))


def operator_from_dict(data: Any) -> Operator:
    """Rebuild any operator from its dictionary.

    Parameters
    ----------
    data
        What ``Operator.to_dict()`` gave.

    Returns
    -------
    Operator

    Raises
    ------
    InputError
        If the kind is unknown, or an entry is missing, unknown or not allowed.

    Examples
    --------
    >>> from hyst.operators import Play
    >>> operator_from_dict({"kind": "play", "r": 0.5}) == Play(0.5)
    True
    """
    if not isinstance(data, dict) or not isinstance(data.get("kind"), str):
        raise InputError("a model is an object with an entry 'kind'; this one has none")
    kind = data["kind"]
    if kind not in _CLASSES:
        known = ", ".join(sorted(_CLASSES))
        raise InputError(f"unknown kind of operator {kind!r}; this version knows {known}")
    return _CLASSES[kind].from_dict(data)


def entries(
    data: dict[str, Any], required: Collection[str], optional: Collection[str] = ()
) -> dict[str, Any]:
    """Give the entries of an operator's dictionary without its kind, refusing surprises.

    Parameters
    ----------
    data
        The dictionary.
    required, optional
        The entries it must and may have, ``kind`` apart.

    Returns
    -------
    dict
        The entries that are there.

    Raises
    ------
    InputError
        If one is missing or unknown, or holds null, true or false.
    """
    given = {key: value for key, value in data.items() if key != "kind"}
    kind = data.get("kind")
    for key in required:
        if key not in given:
            raise InputError(f"{kind}: the entry {key!r} is missing")
    for key in given:
        if key not in required and key not in optional:
            raise InputError(f"{kind}: unknown entry {key!r}; remove it or update hyst")
    for key, value in given.items():
        _refuse_what_numpy_would_convert(value, f"{kind}: the entry {key!r}")
    return given


def _refuse_what_numpy_would_convert(value: Any, what: str) -> None:
    # NumPy reads true as 1, and a null would silently mean "left out".
    for each in value if isinstance(value, list) else (value,):
        if each is None or isinstance(each, bool):
            raise InputError(f"{what} holds {each}; leave out or write numbers")
