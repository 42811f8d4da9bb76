"""Models of several families, identified from the same records to be compared on another one."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

import hyst
from hyst.cli.console import note


def identified_families(
    records: Sequence[hyst.Record],
    families: Sequence[str],
    taken: Collection[str],
    say: Callable[[str], None],
) -> dict[str, hyst.Operator]:
    """Identify a model of each family; a family of which there is none is told of and left out.

    Parameters
    ----------
    records
        To identify from.
    families
        Their names.
    taken
        Names that other models have.
    say
        Told what is being done.

    Raises
    ------
    HystError
        If there is a model of none of them.
    """
    models: dict[str, hyst.Operator] = {}
    refusal: hyst.HystError | None = None
    for family in families:
        say(f"identifying {family}")
        try:
            found = hyst.identify(records, family=family)
        except hyst.HystError as error:
            note(f"no model of the family {family}: {error}")
            refusal = error
            continue
        models[f"{family} identified here" if family in taken else family] = found.model
    if refusal is not None and not models:
        raise refusal
    return models
