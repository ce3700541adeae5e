# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The parameters of each node, one table per node.

Defaults are here, or in `sway_parameters` where commands share them, and nowhere else: the files
in ``config/`` hold overrides only.
"""

from __future__ import annotations

from tree_sway.core.simulator.season import LEAVES
from tree_sway.core.simulator.settings import Settings
from tree_sway.core.wind.height_profile import PROFILES
from tree_sway.core.wind.limits import FASTEST_WIND
from tree_sway.core.wind.simulated.gust_event import EVENT_KINDS
from tree_sway.core.wind.simulated.sensor_faults import FAULTS
from tree_sway.core.wind.simulated.spectra import SPECTRA
from tree_sway.files.wind.nmea import SENTENCES
from tree_sway.files.wind.sonic_ascii import KINDS as SONIC_KINDS
from tree_sway.parameters.parameter import Parameter, Table
from tree_sway.parameters.sway_parameters import (
    BEARING_TO,
    DAMPING_RATIO,
    INTENSITY,
    MEAN_SPEED,
    MODEL,
    TOLERANCE,
)

_MODEL = Settings()
_KANDA = 'Kanda & Ohya, equation 2'
WIND_TYPE_NAMES = (
    'geometry_msgs/Vector3Stamped',
    'geometry_msgs/TwistStamped',
    'geometry_msgs/TwistWithCovarianceStamped',
    'geometry_msgs/Vector3',
)


def _convention(verb: str) -> Parameter:
    text = f'{verb} vectors that point where the wind blows `to` (ROS) or comes `from`.'
    return Parameter('direction_convention', 'to', text, choices=('to', 'from'), source='REP-103')


_FRAME = Parameter('frame_id', 'map', 'Frame of all that the node publishes.', source='REP-105')

_OUTPUT = (
    Parameter('output_type', WIND_TYPE_NAMES[0], 'Type of the messages.', choices=WIND_TYPE_NAMES),
    _convention('Writes'),
    _FRAME,
)

_AUTOSTART = Parameter(
    'autostart', True, 'The node starts by itself; false leaves that to a lifecycle manager.'
)

ANEMOMETER: Table = (
    _AUTOSTART,
    Parameter('rate', 20.0, 'Samples per second.', 'Hz', 1.0, 100.0),
    *_OUTPUT,
    MEAN_SPEED,
    BEARING_TO,
    INTENSITY,
    Parameter(
        'turbulence',
        'kaimal',
        'Spectrum of the turbulence.',
        choices=(*SPECTRA, 'none'),
        live=True,
        source='IEC 61400-1',
    ),
    Parameter('height', 10.0, 'Height of the anemometer above the ground.', 'm', 0.5, 200.0),
    Parameter('seed', 0, 'Seed of the turbulence.', '', 0, 2**31 - 1),
    Parameter(
        'gust',
        'none',
        'Event that happens to the wind from time to time.',
        choices=('none', *EVENT_KINDS),
        live=True,
        source='IEC 61400-1',
    ),
    Parameter(
        'gust_speed', 6.0, 'Rise of the wind in a gust or step.', 'm/s', -40.0, 40.0, live=True
    ),
    Parameter(
        'gust_angle', 1.5708, 'Angle of a change of direction.', 'rad', -3.15, 3.15, live=True
    ),
    Parameter('gust_duration', 5.0, 'Duration of an event.', 's', 0.1, 60.0, live=True),
    Parameter(
        'gust_every', 20.0, 'Time between events; 0 for one alone.', 's', 0.0, 3600.0, live=True
    ),
    Parameter(
        'fault',
        'none',
        'Fault of the sensor from time to time; `all` for each in turn.',
        choices=FAULTS,
        live=True,
    ),
    Parameter(
        'fault_every',
        20.0,
        'Time to the first fault and to each next.',
        's',
        0.1,
        3600.0,
        live=True,
    ),
    Parameter('fault_duration', 1.0, 'Duration of each fault.', 's', 0.01, 600.0, live=True),
)

WIND: Table = (
    _AUTOSTART,
    Parameter('input_type', WIND_TYPE_NAMES[0], 'Type of `wind`.', choices=WIND_TYPE_NAMES),
    _convention('Reads'),
    Parameter(
        'speed_scale',
        1.0,
        'Unit of the speed in m/s: 0.514444 for knots, 0.277778 for km/h.',
        '',
        0.001,
        1000.0,
        live=True,
    ),
    Parameter(
        'yaw_offset',
        0.0,
        'Turn of the wind, counterclockwise, against a turned mast.',
        'rad',
        -6.3,
        6.3,
        live=True,
    ),
    Parameter(
        'plane_normal',
        (0.0, 0.0, 1.0),
        'Normal of the force plane.',
        '',
        -1.0,
        1.0,
        source='the paper, 3.2',
    ),
    _FRAME,
    Parameter('max_speed', 40.0, 'Faster samples are refused.', 'm/s', 1.0, FASTEST_WIND),
    Parameter('max_rate', 20.0, 'Samples that change faster are refused.', 'm/s^2', 1.0, 1000.0),
    Parameter(
        'longest_refusal', 0.5, 'A change that lasts this time is taken as true.', 's', 0.05, 10.0
    ),
    Parameter(
        'frozen_after',
        10.0,
        'Equal samples for this time are reported as frozen.',
        's',
        1.0,
        3600.0,
    ),
    Parameter(
        'timeout',
        2.0,
        'Time without a good sample to WARN; five times that to STALE.',
        's',
        0.1,
        60.0,
        live=True,
    ),
)

SOLVER: Table = (
    _AUTOSTART,
    Parameter('tree', 'benjamina', 'Built-in name, or the file of a tree or a forest.'),
    Parameter('species', '', "Wood: species or species file; the tree's own if empty."),
    Parameter(
        'leaves',
        'auto',
        'Whether trees bear leaves, where their file leaves that open; `auto` if '
        'the species is evergreen.',
        choices=tuple(LEAVES),
    ),
    Parameter(
        'shard.count',
        1,
        'Number of solvers that share the trees of a stand.',
        '',
        1,
        10_000,
        source='doc/shards.md',
    ),
    Parameter('shard.index', 0, 'Which of them this solver is, from 0 on.', '', 0, 9_999),
    _FRAME,
    Parameter(
        'pose',
        (0.0, 0.0, 0.0, 0.0),
        "Place of the tree's origin in the frame, east, north, up "
        '[m], and its turn, counterclockwise from above [rad].',
        '',
        -1e6,
        1e6,
    ),
    Parameter('rate', 60.0, 'Steps of the solver per second.', 'Hz', 1.0, 1000.0),
    Parameter('publish_every', 1, 'Steps from poses to poses.', '', 1, 1000, live=True),
    Parameter('state_rate', 30.0, 'States per second; 0 for none.', 'Hz', 0.0, 1000.0),
    Parameter('publish_tf', False, 'Also one TF frame per segment; this needs tf2_msgs.'),
    MODEL,
    TOLERANCE,
    Parameter(
        'tolerance_angle',
        5e-4,
        'Largest error of the tips in the model `auto`, seen from a '
        '`camera`: a pixel over the focal length in pixels.',
        'rad',
        1e-7,
        1.0,
        live=True,
    ),
    Parameter(
        'budget',
        0.0,
        'Largest time of a frame in the model `auto`, before any tolerance; 0 for no limit.',
        'us',
        0.0,
        1e6,
        live=True,
    ),
    DAMPING_RATIO,
    Parameter(
        'stiffness_factor',
        1.0,
        "Stiffness of the wood over its species'.",
        '',
        0.1,
        10.0,
        live=True,
    ),
    Parameter(
        'gravity',
        _MODEL.gravity,
        'Weight, which softens a tree; 0 for a scan too noisy to stand.',
        'm/s^2',
        0.0,
        30.0,
        live=True,
    ),
    Parameter(
        'volume_rule.stiffness',
        0.0,
        'Stiffness of a branch over its volume, for the model `branch`; 0 for that of its beam.',
        'N m/rad/m^3',
        0.0,
        1e9,
        live=True,
        source=_KANDA,
    ),
    Parameter(
        'volume_rule.damping',
        _MODEL.volume_damping,
        'Damping of a branch over its volume, by that rule.',
        'N m s/rad/m^3',
        1e-3,
        1e9,
        live=True,
        source=_KANDA,
    ),
    Parameter('profile', _MODEL.profile.kind, 'Law of the wind over height.', choices=PROFILES),
    Parameter(
        'anemometer_height',
        _MODEL.profile.anemometer_height,
        'Height of the anemometer over the ground, for the profile.',
        'm',
        0.1,
        200.0,
    ),
    Parameter(
        'wind_delay',
        0.02,
        'The tree feels the wind later by this time; samples that arrive '
        'within it give the same motion in every run.',
        's',
        0.0,
        2.0,
        live=True,
    ),
    Parameter(
        'exact_replay', False, 'In simulated time a frame waits until the wind reaches beyond it.'
    ),
)

PLAYER: Table = (
    _AUTOSTART,
    Parameter('file', '', 'Wind record to play: TOA5, NMEA 0183, CSV or a rosbag2 bag.'),
    Parameter(
        'play',
        'wind',
        'The `wind` of the record, to be solved again, or the `state` of a bag.',
        choices=('wind', 'state'),
    ),
    *_OUTPUT,
    Parameter('rate', 1.0, 'Playback rate: 2 takes half the time.', '', 0.01, 1000.0),
    Parameter('loop', True, 'At its end the record starts again, while time goes on.'),
    Parameter('start', 0.0, 'Time skipped at the beginning of the record.', 's', 0.0),
    Parameter('publish_clock', False, 'Publish `/clock`, for nodes with `use_sim_time`.'),
    Parameter('clock_rate', 250.0, 'Clock messages per real second.', 'Hz', 10.0, 1000.0),
    Parameter(
        'wait_for',
        'wind',
        'Topics that must have a subscriber, or the number in `topic:number`, '
        'before it starts. With `publish_clock` and `wind/filtered` the replay is exact.',
    ),
    Parameter(
        'reader_options',
        '',
        'For the reader of the file: `topic=/mast/wind`, `yaw=1.57` (from '
        'east to its x axis), `direction_convention=from`, `rate=20`, `sentence=MWV`.',
    ),
)

VIEWER: Table = (
    _AUTOSTART,
    Parameter('address', '127.0.0.1', "Where it listens; any but this machine's needs a token."),
    Parameter('port', 8765, 'Port of the page; 0 for a free one.', '', 0, 65535),
    Parameter('token_file', '', 'File of the token that pages must know; none if empty.'),
    Parameter('certificate', '', 'PEM file, to serve the page over TLS.'),
    Parameter('private_key', '', "PEM file of the certificate's key."),
    Parameter('max_clients', 64, 'Largest number of pages at once.', '', 1, 1000),
    Parameter('origins', '', 'Origins whose pages may follow: `https://a.org https://b.org`.'),
    Parameter('control', False, 'Pages may change wind and tolerance, pause and reset.'),
)

SENSOR: Table = (
    _AUTOSTART,
    Parameter(
        'address',
        'udp://:10110',
        'The instrument: `tcp://host:port`, `udp://:port` or `serial:/dev/x:4800`.',
    ),
    Parameter(
        'sentence',
        'auto',
        'Kind of sentences to read; `auto` for the first good one.',
        choices=('auto', *SENTENCES, *SONIC_KINDS),
    ),
    Parameter(
        'heading',
        0.0,
        'Bearing of the bow or the north marker, clockwise from true north.',
        'rad',
        -6.3,
        6.3,
        live=True,
    ),
    Parameter('declination', 0.0, 'Magnetic, east positive.', 'rad', -3.2, 3.2, live=True),
    Parameter('need_checksum', False, 'Sentences without a checksum are refused.', live=True),
    Parameter('silence', 10.0, 'A link silent for this time is reopened.', 's', 0.1, 3600.0),
    *_OUTPUT,
)

NODE_PARAMETERS: dict[str, Table] = {
    'anemometer': ANEMOMETER,
    'wind': WIND,
    'solver': SOLVER,
    'player': PLAYER,
    'sensor': SENSOR,
    'viewer': VIEWER,
}
