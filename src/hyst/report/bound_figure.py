"""Figure of errors over the Cramer-Rao bound as time goes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from hyst.report.canvas import FAINT, MODELLED, SECOND, blank, drawn

_COLOURS = (MODELLED, SECOND, "#047857")


@drawn
def draw_over_bound(
    times: Sequence[float], ratios: Mapping[str, Mapping[str, Sequence[float]]]
) -> Figure:
    """Draw errors over the bound against time, a panel for each input.

    Parameters
    ----------
    times
        Shape (K,), seconds, above 0.
    ratios
        Root mean square errors over the bound, shape (K,) each, above 0: by input, then by label;
        labels that begin alike, up to a comma, share a colour.

    Returns
    -------
    bytes
        PNG.
    """
    figure, axes = blank(len(ratios), 1, 0.6 + 3.8 * len(ratios), 4.2)
    for panel, (name, lines) in zip(axes, ratios.items(), strict=True):
        kinds = list(dict.fromkeys(label.partition(",")[0] for label in lines))
        seen: dict[str, int] = {}
        for label, values in lines.items():
            kind = label.partition(",")[0]
            seen[kind] = seen.get(kind, -1) + 1
            panel.loglog(
                times,
                values,
                ("o-", "s--")[seen[kind] % 2],
                color=_COLOURS[kinds.index(kind) % 3],
                markersize=4.0,
                label=label,
            )
        panel.axhline(1.0, color=FAINT, linewidth=2.0, zorder=1)
        panel.set_title(name)
        panel.set_xlabel("time [s]")
        panel.set_xticks(times, [f"{t:g}" for t in times])
        panel.minorticks_off()
    every = [value for lines in ratios.values() for values in lines.values() for value in values]
    for panel in axes:
        panel.set_ylim(0.7 * min(every), 1.4 * max(every))
    handles, labels = axes[0].get_legend_handles_labels()
    columns = min(len(labels), 1 + len(ratios))
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)
    axes[0].set_ylabel("rms error of the radii / bound")
    return figure
