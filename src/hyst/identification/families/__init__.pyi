# The one list of families, for type checkers and for hyst/_lazy.py: a line makes a family known.

from hyst.identification.families.hammerstein.hammerstein import Hammerstein as Hammerstein
from hyst.identification.families.linear import Linear as Linear
from hyst.identification.families.mapped_plays import (
    GeneralizedPrandtlIshlinskii as GeneralizedPrandtlIshlinskii,
)
from hyst.identification.families.mapped_plays import (
    ModifiedPrandtlIshlinskii as ModifiedPrandtlIshlinskii,
)
from hyst.identification.families.prandtl_ishlinskii import PrandtlIshlinskii as PrandtlIshlinskii
from hyst.identification.families.ramberg_osgood import RambergOsgood as RambergOsgood
from hyst.identification.families.rate_dependent import RateDependent as RateDependent
