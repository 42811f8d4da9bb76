"""Random magnets, at rest and with eddy currents."""

from __future__ import annotations

from hypothesis import strategies as st

from hyst import Operator
from hyst.models import DynamicJilesAtherton, JilesAtherton
from hyst.models.jiles_atherton import VARIANTS

few = st.floats(0.1, 2.0)


@st.composite
def magnets(draw: st.DrawFn, outputs: st.SearchStrategy[str]) -> JilesAtherton:
    """Of any variant, twice whose constants are a magnet, too: alpha Ms / (3 a) at most 0.4."""
    saturation, shape = draw(few), draw(st.floats(0.5, 4.0))
    coupling = draw(st.floats(0.0, 1.2)) * shape / saturation
    pinning, reversible = shape * draw(st.floats(0.2, 4.0)), draw(st.floats(0.05, 0.45))
    variant, output = draw(st.sampled_from(VARIANTS)), draw(outputs)
    return JilesAtherton(saturation, shape, pinning, reversible, coupling, variant, output, 0.5)


def with_losses(outputs: st.SearchStrategy[str]) -> st.SearchStrategy[DynamicJilesAtherton]:
    return st.builds(
        DynamicJilesAtherton, magnets(outputs), st.floats(0.0, 1.0), st.just(0.0), st.just(0.01)
    )


MAGNETS: dict[str, st.SearchStrategy[Operator]] = {
    "jiles-atherton": magnets(st.sampled_from(("M", "B"))),
    "inverse-jiles-atherton": magnets(st.just("B")).map(lambda magnet: magnet.inverse()),
    "dynamic-jiles-atherton": with_losses(st.sampled_from(("M", "B"))),
    "inverse-dynamic-jiles-atherton": with_losses(st.just("B")).map(
        lambda magnet: magnet.inverse()
    ),
}
