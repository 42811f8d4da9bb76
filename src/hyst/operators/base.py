"""What every operator is: a causal map of a signal with a finite, flat state."""

from __future__ import annotations

import functools
import os
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hyst import _engine
from hyst.errors import InputError, NotInvertibleError
from hyst.operators.checks import as_signal, as_state
from hyst.operators.model_file import ModelDescription, write_model
from hyst.operators.parameters import Parameters, as_parameter_vector
from hyst.operators.registry import entries, operator_from_dict, register
from hyst.operators.stepper import Stepper
from hyst.operators.traits import Traits

Array = NDArray[np.float64]


class Operator(ABC):
    """A causal operator with a finite state; ``y = operator(u)``.

    Concrete operators are frozen dataclasses that say what they are (constants, traits, state,
    inverse); how records, samples and derivatives are computed is written here, once, for all.
    """

    kind: ClassVar[str]

    @abstractmethod
    def traits(self) -> Traits:
        """Give the traits that hold for these constants."""

    @abstractmethod
    def initial_state(self) -> Array:
        """Give the state before the first sample, shape (n,), a fresh array."""

    @abstractmethod
    def inverse(self) -> Operator:
        """Give the exact inverse, with its initial state, so that both cancel from sample 0 on.

        Raises
        ------
        NotInvertibleError
            If there is none; the message names the condition that fails.
        """

    @abstractmethod
    def parameters(self) -> Parameters:
        """Give the constants as one flat vector with names and bounds."""

    @abstractmethod
    def with_parameters(self, theta: Sequence[float] | Array) -> Operator:
        """Give the same operator with other constants, in the order of ``parameters()``."""

    @abstractmethod
    def lipschitz_constant(self) -> float:
        """Give L with ``max |f(u) - f(v)| <= L max |u - v|``, or infinity."""

    @abstractmethod
    def to_dict(self) -> dict[str, Any]:
        """Give a dictionary of plain numbers, lists and text that ``from_dict`` understands."""

    @classmethod
    @abstractmethod
    def from_dict(cls, data: dict[str, Any]) -> Operator:
        """Rebuild the operator from ``to_dict()``.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """

    @abstractmethod
    def append_to(self, chain: _engine.Chain) -> None:
        """Append the stages of this operator to a chain of the engine."""

    @final
    def __call__(self, u: ArrayLike) -> Array:
        """Give the output for a whole record that starts from the initial state.

        Parameters
        ----------
        u
            Shape (N,) or (batch, N), finite, N >= 1.

        Returns
        -------
        numpy.ndarray
            The output, in the shape of ``u``.

        Raises
        ------
        InputError
            If ``u`` cannot be used; the first bad index is named.
        """
        return self.run(u)[0]

    @final
    def run(self, u: ArrayLike, state: ArrayLike | None = None) -> tuple[Array, Array]:
        """Give the output for a whole record and the state after it.

        Running two halves one after the other gives the same bits as running the whole.

        Parameters
        ----------
        u
            Shape (N,) or (batch, N), finite, N >= 1.
        state
            Shape (n,) or (batch, n), float64; the initial state if left out. It is not changed.

        Returns
        -------
        y : numpy.ndarray
            In the shape of ``u``.
        state : numpy.ndarray
            Shape (n,), or (batch, n) for a batch.

        Raises
        ------
        InputError
            If ``u`` or ``state`` cannot be used.
        """
        signal = as_signal(u)
        batch = None if signal.ndim == 1 else signal.shape[0]
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, batch)
        rows = signal.reshape(1, -1) if batch is None else signal
        y = np.empty_like(rows)
        self._chain.run(memory, rows, y)
        return (y, memory) if batch is not None else (y[0], memory[0])

    @final
    def stepper(self, state: ArrayLike | None = None) -> Stepper:
        """Give a callable that takes one sample at a time, with the same numbers as ``run``.

        Parameters
        ----------
        state
            Shape (n,), float64; the initial state if left out. It is copied.

        Returns
        -------
        Stepper
            ``step(u) -> y``, with ``state``, ``fault`` and ``clear_fault()``.

        Raises
        ------
        InputError
            If ``state`` cannot be used.
        """
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, None)[0]
        return _engine.stepper(self._chain, memory, 0.0)

    @final
    def jacobian(self, u: ArrayLike, state: ArrayLike | None = None) -> Array:
        """Give the derivative of the output by the parameters.

        Forward mode, with the contact-sample rule: while a play rests its derivative is the one it
        had when it last moved. At a kink the derivative is one-sided. The initial state does not
        depend on the parameters.

        Parameters
        ----------
        u
            Shape (N,), finite, N >= 1.
        state
            As in ``run``.

        Returns
        -------
        numpy.ndarray
            Shape (N, m), m = ``len(self.parameters())``.

        Raises
        ------
        InputError
            If ``u`` is not one record or ``state`` cannot be used.
        """
        signal = as_signal(u)
        if signal.ndim != 1:
            raise InputError(f"u has shape {signal.shape}; the Jacobian takes one record, (N,)")
        start = self.initial_state() if state is None else state
        memory = as_state(start, self._chain.state_length, None)[0]
        result = np.empty((signal.size, self._chain.parameter_count))
        self._chain.jacobian(memory, signal, result)
        return result

    @final
    def __matmul__(self, inner: Operator) -> Operator:
        """Compose: ``(f @ g)(u) = f(g(u))``."""
        return Composition((inner, self))

    @final
    def save(
        self, path: str | os.PathLike[str], description: ModelDescription | None = None
    ) -> None:
        """Write a model file: JSON that a person can read, every double exact.

        Parameters
        ----------
        path
            The file to create or replace; it is written whole or not at all.
        description
            What the numbers mean: names, units, sample time, delay.

        Raises
        ------
        InputError
            If the folder does not exist.
        """
        write_model(path, self.to_dict(), description)

    @final
    def is_invertible(self) -> bool:
        """Tell whether ``inverse()`` gives an exact inverse."""
        try:
            self.inverse()
        except NotInvertibleError:
            return False
        return True

    @functools.cached_property
    def _chain(self) -> _engine.Chain:
        chain = _engine.Chain()
        self.append_to(chain)
        return chain

    @final
    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Operator) or type(self) is not type(other):
            return False
        return self.to_dict() == other.to_dict()

    @final
    def __hash__(self) -> int:
        # Not of the dictionary's text: -0.0 equals 0.0 but is written otherwise.
        constants = (*self.parameters().values.tolist(), *self.initial_state().tolist())
        return hash((self.kind, constants))

    @final
    def __reduce__(self) -> tuple[Any, ...]:
        # The compiled chain is rebuilt, not carried, when an operator goes to another process.
        return type(self).from_dict, (self.to_dict(),)


class Chained(Operator):
    """Operators one after the other; subclasses say which, everything else follows.

    The inverse of a composition is the composition of the inverses, reversed.
    """

    @property
    @abstractmethod
    def stages(self) -> tuple[Operator, ...]:
        """The operators in the order the signal passes them."""

    @abstractmethod
    def _with_stages(self, stages: tuple[Operator, ...]) -> Operator:
        """Give the same kind of composition of other stages."""

    def traits(self) -> Traits:
        """Give what follows from the traits of the stages.

        Loops stay congruent through a stage with memory, whose input they are, but not through a
        curved map of a signal that already has memory.
        """
        leaves = leaves_of(self)
        traits = [leaf.traits() for leaf in leaves]
        remembers = False
        congruent = all(each.congruent_loops for each in traits)
        for leaf, each in zip(leaves, traits, strict=True):
            curved = each.memoryless and leaf.kind != "affine"
            congruent = congruent and not (remembers and curved)
            remembers = remembers or not each.memoryless
        return Traits(
            memoryless=not remembers,
            rate_independent=all(each.rate_independent for each in traits),
            return_point_memory=all(each.return_point_memory for each in traits)
            and all(each.monotone for each in traits[:-1]),
            congruent_loops=congruent,
            monotone=all(each.monotone for each in traits),
            invertible=all(each.invertible for each in traits),
        )

    def initial_state(self) -> Array:
        """Give the states of the stages, one after the other."""
        return np.concatenate([stage.initial_state() for stage in self.stages])

    def inverse(self) -> Operator:
        """Give the inverses of the stages in reversed order.

        Raises
        ------
        NotInvertibleError
            If a stage has none; its own message says why.
        """
        return Composition(tuple(stage.inverse() for stage in reversed(self.stages)))

    def parameters(self) -> Parameters:
        """Give the parameters of the stages, one after the other, named by stage."""
        leaves = leaves_of(self)
        parts = [leaf.parameters() for leaf in leaves]
        names = [
            f"{prefix}.{name}"
            for prefix, part in zip(_prefixes(leaves), parts, strict=True)
            for name in part.names
        ]
        return Parameters(
            values=np.concatenate([part.values for part in parts]),
            names=tuple(names),
            lower=np.concatenate([part.lower for part in parts]),
            upper=np.concatenate([part.upper for part in parts]),
        )

    def with_parameters(self, theta: Sequence[float] | Array) -> Operator:
        """Give the same composition with other constants."""
        counts = [len(stage.parameters()) for stage in self.stages]
        vector = as_parameter_vector(theta, sum(counts))
        pieces = np.split(vector, np.cumsum(counts)[:-1])
        return self._with_stages(
            tuple(s.with_parameters(piece) for s, piece in zip(self.stages, pieces, strict=True))
        )

    def lipschitz_constant(self) -> float:
        """Give the product of the stages' constants."""
        constant = 1.0
        for stage in self.stages:
            constant *= stage.lipschitz_constant()
        return constant

    def append_to(self, chain: _engine.Chain) -> None:
        """Append all stages in the order the signal passes them."""
        for stage in self.stages:
            stage.append_to(chain)


@register
@final
@dataclass(frozen=True, eq=False, repr=False, init=False)
class Composition(Chained):
    """A composition without a name of its own; ``f @ g`` makes one.

    Parameters
    ----------
    stages
        Operators in the order the signal passes them: ``(f @ g)`` has the stages ``(g, f)``.
        Compositions without a name among them are replaced by their own stages.

    Raises
    ------
    InputError
        If there is no stage, or something else than an operator among them.

    Examples
    --------
    >>> from hyst.operators import Affine, Play
    >>> backlash = Affine(2.0, 1.0) @ Play(0.5)
    >>> backlash([0.0, 1.0, 2.0, 1.5])
    array([1., 2., 4., 4.])
    """

    _stages: tuple[Operator, ...]

    kind = "composition"

    def __init__(self, stages: Sequence[Operator]) -> None:
        if not isinstance(stages, list | tuple) or not stages:
            raise InputError("a composition has no stage; give a list of at least one operator")
        for stage in stages:
            if not isinstance(stage, Operator):
                raise InputError(
                    f"a stage is of type {type(stage).__name__}; compose operators only"
                )
        flat = (part for stage in stages for part in _stages(stage))
        object.__setattr__(self, "_stages", tuple(flat))

    @property
    def stages(self) -> tuple[Operator, ...]:
        """The operators in the order the signal passes them."""
        return self._stages

    def _with_stages(self, stages: tuple[Operator, ...]) -> Operator:
        return Composition(stages)

    def __repr__(self) -> str:
        return " @ ".join(repr(stage) for stage in reversed(self._stages))

    def to_dict(self) -> dict[str, Any]:
        """Give the kind and the stages."""
        return {"kind": self.kind, "stages": [stage.to_dict() for stage in self._stages]}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Operator:
        """Rebuild a composition.

        Raises
        ------
        InputError
            If an entry is missing, unknown or not allowed.
        """
        stages = entries(data, required=("stages",))["stages"]
        if not isinstance(stages, list):
            raise InputError("composition: 'stages' must be a list of operators")
        return cls([operator_from_dict(stage) for stage in stages])


def _stages(operator: Operator) -> tuple[Operator, ...]:
    """Flatten nested compositions without a name; those with a name stay whole."""
    return operator.stages if type(operator) is Composition else (operator,)


def leaves_of(operator: Operator) -> tuple[Operator, ...]:
    """Give the operators that are no compositions themselves, in the order of the signal.

    Parameters
    ----------
    operator
        Any operator.

    Returns
    -------
    tuple of Operator
        ``operator`` alone if it is no composition.
    """
    if not isinstance(operator, Chained):
        return (operator,)
    return tuple(leaf for stage in operator.stages for leaf in leaves_of(stage))


def _prefixes(leaves: tuple[Operator, ...]) -> list[str]:
    """Name operators by kind, numbered from 1 where a kind comes more than once."""
    kinds = [leaf.kind.replace("-", "_") for leaf in leaves]
    seen: dict[str, int] = {}
    prefixes = []
    for kind in kinds:
        seen[kind] = seen.get(kind, 0) + 1
        prefixes.append(f"{kind}_{seen[kind]}" if kinds.count(kind) > 1 else kind)
    return prefixes
