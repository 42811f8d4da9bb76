"""hyst observer: design a disturbance observer, try it, and say what to implement."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import hyst
from hyst._files import replacing_files, require_folder
from hyst.cli.arguments import DespiteVerdict
from hyst.cli.console import at_work, note, show_files, show_table
from hyst.cli.observer.design import designed
from hyst.cli.observer.spec import read_spec
from hyst.cli.observer.template import TEMPLATE
from hyst.cli.observer.trial import tried
from hyst.operators.verdict import refuse_if_unfit

if TYPE_CHECKING:
    from hyst.cli.observer.spec import ObserverSpec
    from hyst.report import ObserverAnswer

SpecFile = Annotated[
    Path | None, typer.Argument(metavar="SPEC.toml", show_default=False, help="What to design.")
]
Folder = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", show_default=False, help="Where to write."),
]
Template = Annotated[
    bool, typer.Option("--template", help="Print a spec to start from, and do nothing else.")
]

Stress = Annotated[
    int | None,
    typer.Option(
        "--stress",
        metavar="N",
        min=1,
        show_default=False,
        help="Look among N plants within Wu for one that breaks the block.",
    ),
]


def observer(
    spec_file: SpecFile = None,
    folder: Folder = None,
    template: Template = False,
    stress: Stress = None,
    despite_verdict: DespiteVerdict = False,
) -> None:
    """Design a disturbance observer; say if the loop is safe, and write what to implement."""
    if template:
        if spec_file is not None or folder is not None:
            raise hyst.InputError("--template prints a spec and takes nothing else; leave out rest")
        print(TEMPLATE, end="")
        return
    if spec_file is None or folder is None:
        raise hyst.InputError(
            "give a spec and -o DIR; hyst observer --template > spec.toml makes a spec"
        )
    require_folder(folder)
    spec = read_spec(spec_file)
    for each in (spec.hysteresis, spec.inverse):
        judged = None if each is None else each.description.verdict
        refuse_if_unfit(judged, "no controller is designed", despite_verdict)
    answer = tried(spec, designed(spec), stress)
    with at_work("drawing"):
        bode, loops = _bode(spec, answer), _loops(answer)
        page = hyst.report.observer_page(answer, bode, loops)
    names = ["certificate.json", "report.html", "bode.png", "closed_loop.png", "signals.csv"]
    with replacing_files(folder) as temporary:
        text = json.dumps(answer.to_dict(), indent=2, allow_nan=False)
        (temporary / names[0]).write_text(text + "\n", encoding="utf-8")
        (temporary / names[1]).write_text(page, encoding="utf-8")
        (temporary / names[2]).write_bytes(bode)
        (temporary / names[3]).write_bytes(loops)
        _write_signals(temporary / names[4], answer)
        if answer.safe:
            names.append("controller.json")
            answer.block.save(temporary / names[5])
    if not answer.safe:
        # One of an earlier run would stand beside a page that is not about it.
        (folder / "controller.json").unlink(missing_ok=True)
    _tell(answer)
    for said in () if spec.identified is None else spec.identified.notes:
        note(said)
    lag = hyst.report.delay_to_act_on(spec.hysteresis.description)
    if lag:
        note(f"the recorded output lagged the model by {lag}: put that lag into plant or Wu")
    show_files([folder / name for name in names])


def _bode(spec: ObserverSpec, answer: ObserverAnswer) -> bytes:
    return hyst.report.draw_observer_bode(
        hyst.control.sampled_responses(
            answer.block,
            spec.plant,
            spec.Wu,
            spec.Wp,
            delay=spec.delay,
            true_plant=spec.true_plant,
        ),
        "Disturbance observer",
    )


def _loops(answer: ObserverAnswer) -> bytes:
    name = answer.inverse_name
    loops = {f"{name}, without": answer.without[name].loop}
    if answer.has_observer:
        loops[f"{name}, observer"] = answer.observed[name].loop
    if hyst.control.EXACT in answer.without and name != hyst.control.EXACT:
        loops["exact, without"] = answer.without[hyst.control.EXACT].loop
    return hyst.report.draw_closed_loops(loops, "Closed loop with the true hysteresis")


def _write_signals(path: Path, answer: ObserverAnswer) -> None:
    loop = answer.loop
    columns = [loop.t, loop.r, loop.y, loop.u, loop.eta, loop.d_hat]
    hyst.io.write_columns(path, ["time [s]", "y_ref", "y", "u", "w", "d_hat"], columns)


def _tell(answer: ObserverAnswer) -> None:
    print(answer.verdict())
    print(answer.gain_sentence())
    print(f"To implement: {answer.implement_sentence()}")
    for table in hyst.report.answer_tables(answer):
        show_table(table)
