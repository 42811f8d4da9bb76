"""hyst compare: models of one actuator side by side on data that none of them has seen."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

import hyst
from hyst._files import read_small, replacing, require_folder
from hyst.cli.arguments import load_operator, refuse_inputs_as_outputs
from hyst.cli.console import at_work, note, show_files, show_table
from hyst.cli.driver_option import (
    DriverOfInput,
    common_driver,
    driver_of,
    refuse_several_drivers,
)
from hyst.cli.exit_codes import DONE, UNFIT
from hyst.cli.fitted import HowToRead, InputLabel, OutputLabel
from hyst.cli.identified_families import identified_families
from hyst.cli.reading_options import reads_records

Models = Annotated[
    list[Path],
    typer.Argument(
        metavar="[MODEL]...",
        default_factory=list,
        show_default=False,
        help="Model files of one actuator.",
    ),
]
Data = Annotated[
    Path,
    typer.Argument(
        metavar="DATA", show_default=False, help="A record that none of the models has seen."
    ),
]
Folder = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--out",
        metavar="DIR",
        show_default=False,
        help="Write a page, figures, numbers, and the model to take as model.json there.",
    ),
]
AsJson = Annotated[
    bool, typer.Option("--json", help="Print the numbers as JSON in the place of tables.")
]
CopyBest = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        show_default=False,
        help="Copy the file of the model to take: the simplest not told from the best.",
    ),
]

FamiliesToo = Annotated[
    str | None,
    typer.Option(
        "--family",
        metavar="NAMES",
        show_default=False,
        help="Families to identify from --training and to compare too, with commas between them.",
    ),
]
Training = Annotated[
    list[Path] | None,
    typer.Option(
        metavar="DATA",
        show_default=False,
        help="A record to identify these families from, read as DATA; repeatable.",
    ),
]


@reads_records
def compare(
    models: Models,
    data: Data,
    how: dict[str, Any],
    family: FamiliesToo = None,
    training: Training = None,
    folder: Folder = None,
    as_json: AsJson = False,
    copy_best: CopyBest = None,
    input_label: InputLabel = None,
    output_label: OutputLabel = None,
    driver: DriverOfInput = None,
) -> int:
    """Set models of one actuator side by side on a record that none of them has seen."""
    training = training or []
    families = _families(family, training, models)
    inputs = [*models, data, *training, *_output_file(how)]
    _refuse_outputs(folder, copy_best, families, inputs)
    named = _named(models)
    typed = driver_of(driver)
    with at_work("comparing") as say:
        say("reading")
        loaded: dict[str, Any] = {name: load_operator(path) for name, path in named.items()}
        known = common_driver(loaded.values())
        files = HowToRead(how, {}, (input_label, output_label), typed, known)
        records = files.records([data])
        if typed is None:
            refuse_several_drivers(loaded.values(), records)
        fitted = identified_families(files.records(training), families, set(loaded), say)
        say("running")
        found = hyst.compare(loaded | fitted, records)
        written: list[Path] = []
        if folder is not None:
            say("figures")
            sources = {name: str(path) for name, path in named.items()}
            written += hyst.report.write_comparison(
                found, folder, sources=sources, data=str(data), save=list(fitted)
            )
            _tell_of_another(folder / "model.json", written)
    if as_json:
        print(json.dumps(found.to_dict(), indent=2, allow_nan=False, ensure_ascii=False))
    else:
        _tell(found)
    copied = _copied(found, named, copy_best)
    for wrote in (written, copied):
        if wrote and not as_json:
            show_files(wrote)
    return DONE if found.chosen is not None else UNFIT


def _output_file(how: dict[str, Any]) -> list[Path]:
    return [] if how["output_file"] is None else [how["output_file"]]


def _families(
    family: str | None, training: Sequence[Path], models: Sequence[Path]
) -> tuple[str, ...]:
    """Give the families to identify, which need records of their own."""
    if family is None and not models:
        raise hyst.InputError(
            "Missing argument 'MODEL': give model files, or --family with --training, before DATA"
        )
    if family is not None and not training:
        raise hyst.InputError(
            "--family needs --training, a record to identify from: on the record that a model was "
            "identified from nothing is tested (hyst identify --family compares families on one "
            "record, by leaving out parts of it)"
        )
    if family is None and training:
        raise hyst.InputError("--training is to identify from; give --family too, or leave it out")
    return () if family is None else tuple(hyst.identification.names_of(family))


def _refuse_outputs(
    folder: Path | None, copy: Path | None, families: Sequence[str], inputs: Sequence[Path]
) -> None:
    outputs = [] if copy is None else [copy]
    if folder is not None:
        require_folder(folder)
        names = (*hyst.report.COMPARISON_FILES, *(f"{each}.json" for each in families))
        outputs += [folder / name for name in names]
        if copy is not None and copy.absolute() in [each.absolute() for each in outputs[1:]]:
            raise hyst.InputError(
                f"--copy-best {copy} is a file of the report in {folder}; name another"
            )
    refuse_inputs_as_outputs(outputs, inputs)


def _named(paths: Sequence[Path]) -> dict[str, Path]:
    """Call each file by as little of the end of its path as tells it from the others."""
    for k, path in enumerate(paths):
        for other in paths[:k]:
            if path.resolve() == other.resolve():
                raise hyst.InputError(f"{path} is given twice; give each model once")
    return {_short_name(path, paths): path for path in paths}


def _short_name(path: Path, paths: Sequence[Path]) -> str:
    ends = {each: each.resolve().with_suffix("").parts for each in paths}
    if len(paths) > 1 and len({each[-1] for each in ends.values()}) == 1:
        ends = {each: parts[:-1] for each, parts in ends.items()}  # model.json, each in its folder
    own = ends[path]
    for count in range(1, len(own) + 1):
        if [each[-count:] for each in ends.values()].count(own[-count:]) == 1:
            return "/".join(own[-count:])
    return str(path)  # of another suffix only


def _tell(found: hyst.Comparison) -> None:
    for sentence in found.sentences():
        print(sentence)
    show_table(hyst.report.compared_errors_table(found))
    show_table(hyst.report.compared_models_table(found))
    for sentence in hyst.report.not_invertible_sentences(found):
        note(sentence)


def _tell_of_another(model: Path, written: Sequence[Path]) -> None:
    if model not in written and model.exists():
        note(f"{model} was there before: every model is unfit, so this comparison took none")


def _copied(found: hyst.Comparison, named: dict[str, Path], to: Path | None) -> list[Path]:
    if found.chosen is None:
        if to is not None:
            note("no model was copied, for every one is unfit")
        return []
    if to is None:
        return []
    path = named.get(found.chosen.name)
    if path is None:
        found.chosen.model.save(to)
        return [to]
    content = read_small(path)
    with replacing(to) as temporary:
        temporary.write_bytes(content)
    return [to]
