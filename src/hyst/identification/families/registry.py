"""All families in this folder, from the simplest to the richest: nothing has to list them."""

from __future__ import annotations

import importlib
import pkgutil
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from hyst.errors import InputError
from hyst.identification import families as room
from hyst.identification.families.family import Family
from hyst.identification.families.option import Option

AUTO = "auto"


def _richness(family: type[Family]) -> tuple[int, bool, str]:
    """Order families by the parameters of their smallest size, those asked for by name first.

    A family around another one is richer than any.
    """
    if family.wraps:
        return sys.maxsize, family.compared, family.name
    smallest = family()
    return smallest.least_parameters(smallest.sizes()[0]), family.compared, family.name


def _classes() -> tuple[type[Family], ...]:
    """Give every family that a file of this folder defines."""
    for module in pkgutil.walk_packages(room.__path__, f"{room.__name__}."):
        importlib.import_module(module.name)
    found, unseen = set(), {Family}
    while unseen:
        found |= unseen
        unseen = {each for parent in unseen for each in parent.__subclasses__()} - found
    named = [
        each for each in found if each.__module__.startswith(room.__name__) and "name" in vars(each)
    ]
    return tuple(sorted(named, key=_richness))


class Families(Mapping[str, Family]):
    """The families by name, each with the default options; their classes are attributes.

    Examples
    --------
    >>> import hyst
    >>> "mpi" in hyst.families, hyst.families["mpi"].words.full_name
    (True, 'modified Prandtl-Ishlinskii model')
    >>> hyst.families.RateDependent(spacing="free").spacing
    'free'
    """

    def __init__(self, classes: tuple[type[Family], ...]) -> None:
        self._by_name = {each.name: each for each in classes}
        self._by_class = {each.__name__: each for each in classes}

    def __getitem__(self, name: str) -> Family:
        return self.make(name, {})

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._by_name)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    def __getattr__(self, name: str) -> type[Family]:
        try:
            return self.__dict__["_by_class"][name]  # type: ignore[no-any-return]
        except KeyError:
            raise AttributeError(
                f"hyst.families has no {name!r}; its classes are "
                f"{', '.join(self.__dict__.get('_by_class', ()))}"
            ) from None

    def __dir__(self) -> list[str]:
        return sorted([*self._by_class, "get", "items", "keys", "values"])

    def __repr__(self) -> str:
        return f"<families {', '.join(self)}>"

    def compared(self) -> tuple[str, ...]:
        """Give the names that ``family="auto"`` compares."""
        return tuple(name for name, each in self._by_name.items() if each.compared)

    def in_reserve(self) -> tuple[str, ...]:
        """Give the names that ``"auto"`` compares too, where the first leave more than noise."""
        return tuple(name for name, each in self._by_name.items() if each.in_reserve)

    def inner(self, name: str) -> tuple[str, ...]:
        """Give the names of the families that may be inside another one; none inside most.

        Parameters
        ----------
        name
            Of the family around them.
        """
        around = self._by_name[name]
        if not around.wraps:
            return ()
        return tuple(
            other
            for other, each in self._by_name.items()
            if not each.wraps and around.can_wrap(each)
        )

    def option(self, name: str, option: str) -> Option | None:
        """Give an option of a family or of those that may be inside it, or None.

        Parameters
        ----------
        name
            Of the family.
        option
            Its name.
        """
        possible = (self._by_name[each].options() for each in (name, *self.inner(name)))
        return next((each[option] for each in possible if option in each), None)

    def takers(self, option: str) -> tuple[str, ...]:
        """Give the names of the families that have an option, or may have one with it inside.

        Parameters
        ----------
        option
            Its name.
        """
        return tuple(name for name in self._by_name if self.option(name, option) is not None)

    def make(self, name: str, options: Mapping[str, Any]) -> Family:
        """Give a family with those of the options that it, or the one inside it, has.

        Parameters
        ----------
        name
            Of the family.
        options
            Values by name; those of other families are passed over.

        Raises
        ------
        InputError
            If a value cannot be used, or the family inside is given as an object and its options
            beside it.
        """
        its_own = self._by_name[name].options()
        made = self._by_name[name](**{key: options[key] for key in options if key in its_own})
        of_inner = {
            key: options[key]
            for key in options
            if key not in its_own and self.option(name, key) is not None
        }
        return self.complete(made, of_inner)

    def complete(self, family: Family, options: Mapping[str, Any]) -> Family:
        """Give a family with the family inside it as an object, if it has one inside.

        Parameters
        ----------
        family
            Whose family inside may be a name.
        options
            Of the family inside, those it does not have are passed over.

        Raises
        ------
        InputError
            If the family inside is unknown or cannot be there, or is an object and has options
            beside it.
        """
        if not family.wraps:
            return family
        inside, known = getattr(family, family.wraps), self.inner(family.name)
        if isinstance(inside, Family):
            _require_no_options(inside, options)
            inside, name = _of_this_hyst(inside), inside.name
        else:
            name = inside
        if name not in known:
            raise InputError(
                f"{family.wraps} is {name!r}; choose one of {', '.join(known)}, or one of them as "
                "an object of hyst.families"
            )
        if isinstance(inside, str):
            inside = self.make(inside, options)
        return replace(family, **{family.wraps: inside})


_CLASSES = _classes()

families = Families(_CLASSES)
"""``hyst.families``."""


def names_of(family: str) -> tuple[str, ...]:
    """Give the names of the families that a text names, from the simplest to the richest.

    Parameters
    ----------
    family
        ``"auto"``, a name, or names with commas between them.

    Raises
    ------
    InputError
        If one is unknown; all there are, are named.
    """
    asked = [each.strip() for each in family.split(",")]
    for each in asked:
        if each != AUTO and each not in families:
            known = ", ".join((AUTO, *families))
            raise InputError(f"unknown family {each!r}; choose one of {known}")
    names = {name for each in asked for name in (families.compared() if each == AUTO else (each,))}
    return tuple(name for name in families if name in names)


def chosen_families(family: str | Family, options: Mapping[str, Any]) -> tuple[Family, ...]:
    """Give the families to compare, each with its options.

    Parameters
    ----------
    family
        As of ``identify``.
    options
        Values by name.

    Returns
    -------
    tuple of Family

    Raises
    ------
    InputError
        If a family is unknown or of another version, or an option is of none of them.
    """
    if isinstance(family, Family):
        return (_family_object(family, options),)
    if not isinstance(family, str):
        raise InputError(
            f"family is of type {type(family).__name__}; give a name, as one of "
            f"{', '.join(families)}, or a family of hyst.families with its options"
        )
    names = names_of(family)
    for option in options:
        require_taken(option, names)
    made = tuple(families.make(name, options) for name in names)
    for option in options:
        _require_used(option, made)
    return made


def families_in_reserve(family: str | Family, options: Mapping[str, Any]) -> tuple[Family, ...]:
    """Give the families that are compared only where those chosen leave more than noise.

    Parameters
    ----------
    family
        As of ``identify``.
    options
        Values by name: who gives some asks for the families that have them.

    Returns
    -------
    tuple of Family
        None unless ``"auto"`` is asked for.
    """
    if options or not isinstance(family, str):
        return ()
    asked = [each.strip() for each in family.split(",")]
    if AUTO not in asked:
        return ()
    return tuple(families[name] for name in families.in_reserve() if name not in asked)


def _require_used(option: str, made: tuple[Family, ...]) -> None:
    """Refuse an option that the families could have had, but not as they were chosen."""
    inside = [each for each in map(_inside, made) if each is not None]
    if any(option in each.options() for each in (*made, *inside)):
        return
    around = next(each for each in made if each.wraps)
    takers = [name for name in families.inner(around.name) if option in families[name].options()]
    raise InputError(
        f"{option} is for {around.wraps} {_listed(takers)}, not for "
        f"{_listed([each.name for each in inside])}; leave it out, or choose another "
        f"{around.wraps}"
    )


def _inside(family: Family) -> Family | None:
    """Give the family inside another one."""
    return getattr(family, family.wraps) if family.wraps else None


def require_taken(option: str, names: tuple[str, ...], said: str = "", of: str = "family") -> None:
    """Refuse an option that no family of those named has.

    Parameters
    ----------
    option
        Its name in Python.
    names
        Of the families.
    said
        How the option was typed, if not by its name.
    of
        What chose the families, as it was typed.

    Raises
    ------
    InputError
        If it is of other families, which are named, or of none.
    """
    takers = families.takers(option)
    if not takers:
        known = dict.fromkeys(
            each
            for name in names
            for part in (name, *families.inner(name))
            for each in families[part].options()
        )
        has = f"has {', '.join(known)}" if known else "has none"
        raise InputError(f"{said or option!r} is no option of family {_listed(names)}, which {has}")
    if not set(takers) & set(names):
        raise InputError(
            f"{said or option} is for {of} {_listed(takers)}, not for {_listed(names)}; leave it "
            f"out, or choose another {of}"
        )


def _family_object(family: Family, options: Mapping[str, Any]) -> Family:
    _require_no_options(family, options)
    return families.complete(_of_this_hyst(family), {})


def _require_no_options(family: Family, options: Mapping[str, Any]) -> None:
    if options:
        raise InputError(
            f"{next(iter(options))} is given beside a family object; give its options to "
            f"hyst.families.{type(family).__name__}"
        )


def _of_this_hyst(family: Family) -> Family:
    if type(family) not in _CLASSES:
        raise InputError(
            f"the family object {type(family).__name__} is none of this hyst; choose one of "
            f"hyst.families: {', '.join(each.__name__ for each in _CLASSES)}"
        )
    _require_this_version(family)
    return replace(family)  # checks the values of an object that was stored


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def _require_this_version(family: Family) -> None:
    """Refuse a family object that was made by another version of hyst."""
    known, held = set(type(family).options()), set(vars(family))
    if known != held:
        which = ", ".join(sorted(known ^ held))
        raise InputError(
            f"the family object {type(family).__name__} was made by another version of hyst (its "
            f"options differ in {which}); make it anew with hyst.families.{type(family).__name__}"
        )
