"""hyst demo: the whole story on a simulated stage."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import hyst.demo
from hyst._files import require_folder
from hyst.cli.console import at_work, show_files, show_table

if TYPE_CHECKING:
    from hyst.demo import Story
    from hyst.report import Section, Table


def demo(
    folder: Annotated[
        Path, typer.Option("-o", "--out", metavar="DIR", help="Where to write.")
    ] = Path("demo"),
    fleet: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            show_default=False,
            help="Write records of N simulated actuators for hyst fleet, and nothing else.",
        ),
    ] = None,
) -> None:
    """Tell the whole story on a simulated stage: measure, identify, invert, track, compare."""
    require_folder(folder)
    if fleet is not None:
        _write_fleet(folder, fleet)
        return
    with at_work("demo") as say:
        story = hyst.demo.tell(say=say)
        say("report")
        files = hyst.report.write_report(
            story.identified,
            story.training,
            story.validation,
            folder,
            banner=hyst.demo.BANNER,
            sections=[_tracking_section(story)],
        )
        files += _write_signals(story, folder)
    print(hyst.demo.BANNER)
    print(hyst.report.verdict_lines(story.identified.verdict))
    for sentence in hyst.report.in_short(story.identified, (story.training,)):
        print(sentence)
    show_table(hyst.report.metrics_table(story.identified))
    show_table(_tracking_table(story))
    print(_verdict(story))
    show_files(files)
    print(f"\nopen {folder / 'report.html'}, or go on yourself with these simulated files:")
    print(
        f"  hyst identify {folder / 'record.csv'} --input drive --output position --time time "
        f"-o {folder / 'again'}\n"
        f"  hyst compensate {folder / 'model.json'} {folder / 'reference.csv'} --column reference "
        f"--history {folder / 'history.csv'}:drive --with-delay -o {folder / 'again.csv'}"
    )


def _write_fleet(folder: Path, count: int) -> None:
    with at_work("demo"):
        odd = hyst.demo.write_simulated_fleet(folder, count)
    print(hyst.demo.BANNER)
    print(f"wrote {count} records in {folder}; on purpose not like the others are")
    for each in odd:
        print(f"  {each.identifier}: {each.oddness}")
    print(
        "go on with\n"
        f'  hyst fleet "{folder}/*.csv" --input drive --output position --time time '
        f"-o {folder}-fleet"
    )


def _tracking_table(story: Story) -> Table:
    return hyst.report.Table(
        "Tracking error of the simulated stage (true position minus reference)",
        ("command from", "rms [um]", "rms [% of range]", "max [um]", "max [% of range]"),
        tuple(
            (
                each.name,
                f"{each.metrics.rms:.4f}",
                f"{each.metrics.rms_percent:.3f}",
                f"{each.metrics.max_abs:.4f}",
                f"{each.metrics.max_percent:.3f}",
            )
            for each in story.tracking
        ),
    )


def _verdict(story: Story) -> str:
    return (
        f"With the exact inverse of the model the simulated stage follows the reference "
        f"{story.improvement:.1f} times closer than with a straight line."
    )


def _tracking_section(story: Story) -> Section:
    name, unit = story.training.output_name, story.training.output_unit
    outputs = {f"{each.name}": each.y for each in story.tracking}
    return hyst.report.Section(
        heading="Following a trajectory",
        texts=(
            "The stage was swept once through its range, so that its memory is known, and then "
            "had to climb stairs and follow two sines: once with the command a straight line "
            "gives, once with the command of the model's exact inverse.",
            _verdict(story),
        ),
        table=_tracking_table(story),
        picture="tracking.png",
        png=hyst.report.draw_tracking(
            story.training.dt, story.y_ref, outputs, name, unit, hyst.demo.BANNER
        ),
        caption="The simulated stage with both commands; what is left is its resonance and "
        "what the model does not capture.",
    )


def _write_signals(story: Story, folder: Path) -> tuple[Path, ...]:
    record, reference, history, command = (
        folder / name for name in ("record.csv", "reference.csv", "history.csv", "command.csv")
    )
    training = story.training
    hyst.io.write_columns(
        record, ("time [s]", "drive [V]", "position [um]"), (training.time, training.u, training.y)
    )
    hyst.io.write_columns(reference, ("reference [um]",), (story.y_ref,))
    hyst.io.write_columns(history, ("drive [V]",), (story.history,))
    done = story.compensation
    predicted = hyst.identification.earlier(done.y_predicted, -story.identified.delay)
    hyst.io.write_columns(
        command,
        ("reference [um]", "command [V]", "predicted [um]"),
        (story.y_ref, done.u, predicted),
    )
    return record, reference, history, command
