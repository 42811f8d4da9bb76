"""The classical disturbance observer: a Q-filter and the inverse of the nominal plant."""

from __future__ import annotations

from hyst.control.q_filters.blocks import compare_blocks, table_of_blocks
from hyst.control.q_filters.certificate import QFilterCertificate
from hyst.control.q_filters.comparison import DesignRow, compare_designs, row_of, table_of
from hyst.control.q_filters.design import design_q_filter
from hyst.control.q_filters.family import QFilter, q_filter
from hyst.control.q_filters.problem import QFilterProblem, q_filter_problem
from hyst.control.q_filters.rejection import RobustPerformance, robust_performance
from hyst.control.q_filters.result import QFilterObserver
from hyst.control.q_filters.sampled_design import (
    SampledQFilterObserver,
    design_sampled_q_filter,
)

__all__ = [
    "DesignRow",
    "QFilter",
    "QFilterCertificate",
    "QFilterObserver",
    "QFilterProblem",
    "RobustPerformance",
    "SampledQFilterObserver",
    "compare_blocks",
    "compare_designs",
    "design_q_filter",
    "design_sampled_q_filter",
    "q_filter",
    "q_filter_problem",
    "robust_performance",
    "row_of",
    "table_of",
    "table_of_blocks",
]


def __dir__() -> list[str]:
    return __all__
