# The one list of what reports offer, for type checkers and for hyst/_lazy.py.

from hyst.report.closed_loop_figure import draw_closed_loops as draw_closed_loops
from hyst.report.description_tables import description_table as description_table
from hyst.report.description_tables import errors_table as errors_table
from hyst.report.description_tables import provenance_table as provenance_table
from hyst.report.distortion_section import distortion_sections as distortion_sections
from hyst.report.drive_figure import draw_drive as draw_drive
from hyst.report.drive_summary import drive_table as drive_table
from hyst.report.dynamics_figures import dynamics_sections as dynamics_sections
from hyst.report.estimation_figure import draw_estimates as draw_estimates
from hyst.report.identification_report import Section as Section
from hyst.report.identification_report import write_report as write_report
from hyst.report.observer_answer import ObserverAnswer as ObserverAnswer
from hyst.report.observer_figures import draw_observer_bode as draw_observer_bode
from hyst.report.tables import Table as Table
from hyst.report.tables import candidates_table as candidates_table
from hyst.report.tables import compensation_table as compensation_table
from hyst.report.tables import constants_table as constants_table
from hyst.report.tables import metrics_table as metrics_table
from hyst.report.tables import number as number
from hyst.report.tables import parameters_table as parameters_table
from hyst.report.tables import traits_table as traits_table
from hyst.report.tracking_figure import draw_tracking as draw_tracking
from hyst.report.words import delay_sentence as delay_sentence
from hyst.report.words import in_short as in_short
from hyst.report.words import invertible_sentence as invertible_sentence
