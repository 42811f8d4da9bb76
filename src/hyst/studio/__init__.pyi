# The one list of what the studio offers, for type checkers and for hyst/_lazy.py.

from hyst.studio.server.serve import serve as serve
from hyst.studio.server.serve import studio_at as studio_at
