"""What a family of models is: its name and words, its options, and how it is fitted.

A family is a frozen dataclass whose fields are its options. Identification, report, command line
and documentation ask it and the registry; none of them knows a family by name.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, ClassVar, Literal, Self, final

import numpy as np
from numpy.typing import NDArray

from hyst.identification.families.estimates import Estimates
from hyst.identification.families.option import AUTO, Option
from hyst.identification.families.words import Words
from hyst.identification.fit.bounded_least_squares import Problem, Solution, minimize
from hyst.identification.fit.parametrization import Parametrization
from hyst.identification.fit.problem import problem_of
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.thinning import thinned
from hyst.identification.record_use.used_samples import Data, prepare
from hyst.operators import Operator
from hyst.signals import Record

if TYPE_CHECKING:
    from hyst.identification.result.identified import Identified

Array = NDArray[np.float64]
Start = tuple[Parametrization, Array]
"""Free parameters and the theta to start from."""


@dataclass(frozen=True)
class Family(ABC):
    """A family of models; its fields are the options its user may give.

    Concrete families are final dataclasses that say what they are (name, words, options) and where
    a fit starts; how delay and size are chosen, how the constants are fitted and how sure they are
    is done once, for all.
    """

    name: ClassVar[str]
    words: ClassVar[Words]
    methods: ClassVar[tuple[str, ...]] = ("exact",)
    """Of compensation, the one that suits best first."""
    compared: ClassVar[bool] = False
    """Whether ``family="auto"`` compares it."""
    in_reserve: ClassVar[bool | str] = False
    """Whether it does so where the first leave more than noise; or a finding it then asks for."""
    has_memory: ClassVar[bool] = True
    """Whether its delay is worth judging by the family itself."""
    settles_delay: ClassVar[bool] = True
    """Whether it may choose among the delays left possible, by a fit for each of them."""
    loops_tell_delay: ClassVar[bool | str] = True
    """Whether a delay that loops of a general kind show is taken, or its ``"own"``; else 0."""
    judged_in_sample: ClassVar[bool] = False
    """Whether its sizes are scored on what they were fitted to, for blocks are no witnesses."""
    answers_late: ClassVar[bool] = False
    """Whether the delay of the output is part of the model, so that none is looked for before."""
    depends_on_rate: ClassVar[bool] = False
    """Whether samples left out of a record would change the model."""
    about_rates: ClassVar[str] = ""
    """Advice where its error depends on the rate, if another than a family that does."""
    rate_between_samples: ClassVar[bool] = False
    """Whether it takes a rate from one sample to the next, of which a plant has one in between."""
    is_linear: ClassVar[bool] = False
    """Whether its output is linear in its constants, so that the first guess is the fit."""
    explains: ClassVar[tuple[str, ...]] = ()
    """Findings that make no record doubtful of which it leaves nothing but noise."""
    describes: ClassVar[tuple[str, ...]] = ()
    """Findings that are what the family is for: they make no record of it doubtful."""
    wraps: ClassVar[str] = ""
    """The option that holds a family this one is made around; empty where there is none."""

    def __post_init__(self) -> None:
        for name, what in self.options().items():
            object.__setattr__(self, name, what.check(getattr(self, name), name))

    @final
    @classmethod
    def options(cls) -> dict[str, Option]:
        """Give the options of the family by name."""
        return {each.name: each.metadata["option"] for each in fields(cls)}

    @classmethod
    def can_wrap(cls, other: type[Family]) -> bool:
        """Tell whether a family can be the one inside this one."""
        return False

    def refused_before_dynamics(self) -> str:
        """Say which option cannot be served where dynamics come after; nothing if all can."""
        return ""

    def records_to_use(
        self, records: tuple[Record, ...], start: Literal["auto"] | int
    ) -> tuple[Data, tuple[str, ...]]:
        """Choose what of the records is used, and say what was left out.

        Parameters
        ----------
        records
            As they were given.
        start
            First sample to use, or ``"auto"``.

        Returns
        -------
        Data
        tuple of str
            Sentences.
        """
        return prepare(records, start), ()

    def suited(self, data: Data) -> tuple[Self, tuple[str, ...]]:
        """Refuse options that these records cannot serve, or leave them out with a sentence.

        Parameters
        ----------
        data
            The records in the user's units.

        Returns
        -------
        Family
            With options that these records can serve.
        tuple of str
            Sentences for the user.
        """
        return self, ()

    def searched(self, data: Data) -> Data:
        """Give what families and sizes are compared on: fewer samples, where that changes none."""
        return data if self.depends_on_rate else thinned(data)

    def fitted(self, data: Data) -> Data:
        """Give what the last fit and its standard errors take: all samples, if memory allows."""
        return data

    def in_units(self, input_scale: float, output_scale: float) -> Self:
        """Give the family with options in units smaller by these factors.

        Parameters
        ----------
        input_scale, output_scale
            By which numbers of signals grow.
        """
        return self

    def sizes(self) -> tuple[int, ...]:
        """Give the sizes to compare, ascending; (0,) where there is nothing to choose."""
        return (0,)

    def rules(self) -> tuple[str, ...]:
        """Give what the signs of its weights may be, the safe one first, where that is open."""
        return ()

    def under(self, rule: str) -> Self:
        """Give the family with one of its rules."""
        return self

    @abstractmethod
    def least_parameters(self, size: int) -> int:
        """Give the number of free parameters of a size, the offset included."""

    @abstractmethod
    def starts(self, overview: Overview, size: int, most: int) -> Sequence[Start]:
        """Give where to start, the best guess first.

        Parameters
        ----------
        overview
            The records.
        size
            One of ``sizes()``.
        most
            How many starts are worth trying; the same ones in every run.

        Returns
        -------
        sequence
            Parametrization and theta of each.

        Raises
        ------
        NotIdentifiableError
            If the records do not show this family.
        """

    def root_weights(self, data: Data) -> Array | None:
        """Give the square root of every sample's weight, or None where all count the same."""
        return None

    def solve(
        self, problem: Problem, theta: Array, max_iterations: int, tolerance: float = 1e-3
    ) -> Solution:
        """Minimise the squared error from a start.

        Parameters
        ----------
        problem
            What to minimise.
        theta
            The start.
        max_iterations, tolerance
            As of ``minimize``.
        """
        return minimize(problem, theta, max_iterations, tolerance)

    def in_own_coordinates(
        self, problem: Problem, theta: Array
    ) -> tuple[Problem, Array, Callable[[Array], Array]]:
        """Pose a problem over other numbers than the constants, where steps in those are better.

        Parameters
        ----------
        problem
            Over the family's free parameters, and perhaps others behind them, which stay.
        theta
            A start.

        Returns
        -------
        Problem
        theta : numpy.ndarray
            The start in the other numbers.
        back : callable
            From the other numbers to theta.
        """
        return problem, theta, lambda other: other

    def renewed(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Solve again where free parameters hold near a solution only, with stages or without.

        Parameters
        ----------
        fit
            As it was solved.
        overview
            The records.
        max_iterations
            Of each further fit.
        """
        return fit

    def finish(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Improve a fit by what only the family knows, as moving radii across kinks.

        Parameters
        ----------
        fit
            The best of all starts.
        overview
            The records.
        max_iterations
            Of each further fit.
        """
        return fit

    def simplified(self, fit: Fit, overview: Overview, max_iterations: int) -> Fit:
        """Fit again without the parts that came out idle, until none is.

        Parameters
        ----------
        fit
            A fit.
        overview
            The records.
        max_iterations
            Of each further fit.
        """
        return fit

    def notes(self, fit: Fit, data: Data) -> tuple[str, ...]:
        """Say what makes constants of a final fit no estimates.

        Parameters
        ----------
        fit
            The final fit, in the user's units.
        data
            Its records.
        """
        return ()

    @property
    def estimates_noise(self) -> bool:
        """Whether the fit's residual tells how sure its constants are."""
        return True

    def estimates(self, fit: Fit) -> Estimates:
        """Give what the table of parameters tells: the constants that are free.

        Parameters
        ----------
        fit
            The final fit, in the user's units.
        """
        constants, free = fit.operator.parameters(), np.flatnonzero(fit.parametrization.free)
        return Estimates(
            tuple(constants.names[i] for i in free),
            constants.values[free],
            fit.parametrization.transform[free],
        )

    def without_past(self, fit: Fit, data: Data) -> Data:
        """Give the records without what a past that nobody knows has left in them.

        Parameters
        ----------
        fit
            The final fit, in the user's units.
        data
            Its records.
        """
        return data

    def result(self, identified: Identified, fit: Fit, overview: Overview) -> Identified:
        """Add what only this family can say to the result.

        Parameters
        ----------
        identified
            The result as every family has it.
        fit
            The final fit, in the user's units.
        overview
            The records it was found on.
        """
        return identified

    def words_for(self, identified: Identified) -> Words:
        """Give the words for a result: the family's own, unless the result has parts with others.

        Parameters
        ----------
        identified
            A result of this family.
        """
        return self.words

    @final
    def named_size(self, size: int) -> str:
        """Say a size in words."""
        name = self.name or "the model"
        return f"{name} with {size} plays" if size else name


@dataclass(frozen=True, eq=False)
class Fit:
    """One family fitted: its free parameters, where the iteration ended, and how well.

    Parameters
    ----------
    family
        The family.
    size
        As it was asked for or chosen; the fit may have fewer parts.
    parametrization, solution
        Free parameters and their best values.
    """

    family: Family
    size: int
    parametrization: Parametrization
    solution: Solution

    @property
    def operator(self) -> Operator:
        """The fitted operator."""
        return self.parametrization.operator(self.solution.theta)

    def problem(self, data: Data, chosen: NDArray[np.bool_] | None = None) -> Problem:
        """Pose the problem of this fit over other records or some samples.

        Parameters
        ----------
        data
            The records.
        chosen
            Shape (samples used,): which samples count; all if left out.
        """
        return problem_of(data, self.parametrization, chosen, self.family.root_weights(data))


__all__ = [
    "AUTO",
    "Estimates",
    "Family",
    "Fit",
    "Start",
    "Words",
]
