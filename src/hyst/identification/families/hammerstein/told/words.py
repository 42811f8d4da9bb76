"""What people are told of hysteresis with linear dynamics behind it."""

from __future__ import annotations

from dataclasses import replace

from hyst.identification.families.family import Words

WORDS = Words(
    full_name="Hammerstein model (hysteresis, then linear dynamics)",
    equations=("y(t) = G[v](t)",),
    explanations=(
        "v is the output of the hysteresis, which nobody measured. G is linear dynamics of gain 1 "
        "at rest, in the table y_k = b[0] v_k + b[1] v_(k-1) + .. - a[1] y_(k-1) - ..; a delay "
        "comes on top.",
    ),
)


def words_behind(front: Words) -> Words:
    """Give the words for dynamics behind a hysteresis, whose output is called v.

    Parameters
    ----------
    front
        Words of the hysteresis.
    """
    hysteresis = tuple(each.replace("y(t)", "v(t)", 1) for each in front.equations)
    return replace(
        WORDS,
        equations=hysteresis + WORDS.equations,
        explanations=front.explanations + WORDS.explanations,
    )
