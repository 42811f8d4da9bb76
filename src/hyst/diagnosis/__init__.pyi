# The one list of names of diagnosis, for type checkers and for hyst/_lazy.py.

from hyst.diagnosis.diagnose_records import Diagnosis as Diagnosis
from hyst.diagnosis.diagnose_records import diagnose as diagnose
from hyst.diagnosis.finding import Finding as Finding
