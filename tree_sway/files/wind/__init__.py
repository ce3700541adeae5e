# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Wind records of loggers, stations, services, bags and reanalyses.

All become times in [s] and velocities in [m/s], the way the air goes, east, north, up. A layout of
a table is one module of `layouts`; names and units of columns are data. Live instruments use the
same readers of lines (`parse_nmea`, `read_instrument`).
"""

from typing import TYPE_CHECKING

from tree_sway.faces import face

if TYPE_CHECKING:
    from tree_sway.files.layouts.lines import form_of as form_of
    from tree_sway.files.layouts.station_messages import SIGNALK_PAIRS as SIGNALK_PAIRS
    from tree_sway.files.layouts.station_messages import signalk_values as signalk_values
    from tree_sway.files.layouts.station_messages import SIGNALK_WIND as SIGNALK_WIND
    from tree_sway.files.layouts.station_messages import tempest_values as tempest_values
    from tree_sway.files.wind.instruments import INSTRUMENTS as INSTRUMENTS
    from tree_sway.files.wind.instruments import LOGGED as LOGGED
    from tree_sway.files.wind.instruments import read_instrument as read_instrument
    from tree_sway.files.wind.nmea import parse_nmea as parse_nmea
    from tree_sway.files.wind.nmea import SENTENCES as SENTENCES
    from tree_sway.files.wind.phone import read_phone_sway as read_phone_sway
    from tree_sway.files.wind.reading import of_velocity as of_velocity
    from tree_sway.files.wind.reading import Reading as Reading
    from tree_sway.files.wind.reading import Readings as Readings
    from tree_sway.files.wind.reading import Refusal as Refusal
    from tree_sway.files.wind.reading import Velocity as Velocity
    from tree_sway.files.wind.reading import WindReading as WindReading
    from tree_sway.files.wind.record import WindRecord as WindRecord
    from tree_sway.files.wind.sway_table import read_csv_sway as read_csv_sway
    from tree_sway.files.wind.sway_table import SwayRecord as SwayRecord
    from tree_sway.files.wind.values import bearing_of as bearing_of
    from tree_sway.files.wind.values import number as number
    from tree_sway.files.wind.values import reading_of as reading_of
    from tree_sway.files.wind.wind_file import EXAMPLES as EXAMPLES
    from tree_sway.files.wind.wind_file import read_wind as read_wind
else:
    __getattr__, __dir__, __all__ = face(__name__)
