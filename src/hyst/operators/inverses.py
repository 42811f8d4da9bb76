"""What undoes an operator: at once where that is exact, or some samples late."""

from __future__ import annotations

import functools
from abc import abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from hyst.checks.numbers import whole_number
from hyst.errors import NotInvertibleError
from hyst.operators.description import Described
from hyst.operators.registry import delayed

if TYPE_CHECKING:
    from hyst.operators.base import Operator

Array = NDArray[np.float64]

MOST_PREVIEW = 1000
"""Samples of the reference an inverse may know beyond the present one."""


class Inverses(Described):
    """What may have an inverse; classes say by ``exact_inverse`` whether they have one."""

    kind: ClassVar[str]

    def __init_subclass__(cls) -> None:
        # An inverse means what its operator means, the signals changed; no class has to say so.
        for name in ("exact_inverse", "preview_inverse"):
            if name in vars(cls):
                setattr(cls, name, _described_inverse(vars(cls)[name]))

    @final
    def inverse(self, preview: int | None = None) -> Operator:
        """Give the exact inverse, or one that answers some samples late.

        Parameters
        ----------
        preview
            Samples of the reference that every command may know beyond its own, 0 to 1000: fed
            y_ref, the operator's output at k is the command for sample k - preview. None: the
            exact inverse, which knows the present sample only and answers at once; both cancel
            from sample 0 on.

        Returns
        -------
        Operator
            With its initial state.

        Raises
        ------
        InputError
            If the preview is no whole number from 0 to 1000.
        NotInvertibleError
            If there is none; the message names the condition that fails.
        """
        if preview is None:
            return self.exact_inverse()
        return self.preview_inverse(whole_number(preview, "preview", 0, MOST_PREVIEW))

    @abstractmethod
    def exact_inverse(self) -> Operator:
        """Give the exact inverse, with its initial state, so that both cancel from sample 0 on.

        Raises
        ------
        NotInvertibleError
            If there is none; the message names the condition that fails.
        """

    def preview_inverse(self, samples: int) -> Operator:
        """Give an inverse whose output at k is the command for sample k - samples.

        Where there is an exact inverse it is that, later: before its first command, as if the
        reference had rested at its first value.

        Parameters
        ----------
        samples
            Whole, 0 to 1000.

        Returns
        -------
        Operator

        Raises
        ------
        NotInvertibleError
            If there is none; the message names the condition that fails.
        """
        inverse = self.exact_inverse()
        return inverse if samples == 0 else delayed(inverse, samples)

    def preview_range(self) -> tuple[int, int]:
        """Give how many samples of preview an inverse needs, and how many are of use.

        None where there is an exact inverse.

        Raises
        ------
        NotInvertibleError
            If there is no inverse, with preview neither.
        """
        self.exact_inverse()
        return 0, 0

    def causal_inverse(self, state: Array) -> tuple[Operator, Array]:
        """Give an inverse that answers at once, where there is no exact one, and its memory.

        Parameters
        ----------
        state
            Memory of the operator, as ``run`` gave it.

        Returns
        -------
        inverse : Operator
            Not exact.
        memory : numpy.ndarray
            That of the inverse, for an operator with this memory.

        Raises
        ------
        NotInvertibleError
            If there is none.
        """
        self.exact_inverse()
        raise NotInvertibleError(f"a {self.kind} has an exact inverse and needs no other")

    @final
    def is_invertible(self) -> bool:
        """Tell whether ``inverse()`` gives an exact inverse."""
        try:
            self.exact_inverse()
        except NotInvertibleError:
            return False
        return True


def _described_inverse(inverse: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(inverse)
    def described(self: Inverses, *samples: int) -> Any:
        return inverse(self, *samples).with_description(self.description.of_inverse())

    return described
