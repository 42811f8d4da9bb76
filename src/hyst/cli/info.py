"""hyst info: what is in a model file."""

from __future__ import annotations

import hyst
from hyst.cli.arguments import ModelFile
from hyst.cli.console import show_table


def info(model_file: ModelFile) -> None:
    """Show what a model file holds: what it means, constants, traits, and whether it inverts."""
    model, about = hyst.models.load_described(model_file)
    show_table(hyst.report.description_table(about))
    show_table(hyst.report.constants_table(model))
    show_table(hyst.report.traits_table(model))
    print(f"\n{hyst.report.invertible_sentence(model)}")
