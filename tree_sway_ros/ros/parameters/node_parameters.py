# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The parameters of each node, one table per node.

Defaults stand here and nowhere else: the files in ``config/`` hold overrides only.
"""

from __future__ import annotations

from tree_sway_ros.core.oscillators.rule_names import REAL_TIME
from tree_sway_ros.core.simulator.season import LEAVES
from tree_sway_ros.core.simulator.settings import FIDELITIES, Settings, STIFFNESS_RULES
from tree_sway_ros.core.wind.averaging import INTERPOLATIONS
from tree_sway_ros.core.wind.height_profile import PROFILES
from tree_sway_ros.core.wind.limits import FASTEST_WIND
from tree_sway_ros.core.wind.simulated.gust_event import EVENT_KINDS
from tree_sway_ros.core.wind.simulated.sensor_faults import FAULTS
from tree_sway_ros.core.wind.simulated.spectra import SPECTRA
from tree_sway_ros.files.wind.nmea import SENTENCES
from tree_sway_ros.files.wind.sonic_ascii import KINDS as SONIC_KINDS
from tree_sway_ros.ros.parameters.parameter import Parameter, Table

_MODEL = Settings()
WIND_TYPE_NAMES = (
    'geometry_msgs/Vector3Stamped',
    'geometry_msgs/TwistStamped',
    'geometry_msgs/TwistWithCovarianceStamped',
    'geometry_msgs/Vector3',
)


def _convention(verb: str) -> Parameter:
    sentence = (
        f'{verb} vectors that say where the wind blows `to` (ROS) or comes `from` (meteorology).'
    )
    choices = ('to', 'from')
    return Parameter('direction_convention', 'to', sentence, choices=choices, source='REP-103')


_FRAME = Parameter(
    'frame_id', 'map', 'The frame of everything that this node publishes.', source='REP-105'
)

_OUTPUT = (
    Parameter(
        'output_type',
        WIND_TYPE_NAMES[0],
        'The node publishes messages of this type.',
        choices=WIND_TYPE_NAMES,
    ),
    _convention('Writes'),
    _FRAME,
)

_LIFECYCLE = Parameter(
    'lifecycle',
    False,
    'The node waits for a manager to configure and activate it, as a managed node of ROS does.',
)

ANEMOMETER: Table = (
    _LIFECYCLE,
    Parameter(
        'rate',
        20.0,
        'The node publishes so many samples per second.',
        'Hz',
        1.0,
        100.0,
        source='sensors seen: 1-80 Hz',
    ),
    *_OUTPUT,
    Parameter('mean_speed', 6.0, 'The mean wind speed.', 'm/s', 0.0, 40.0, live=True),
    Parameter(
        'bearing_to',
        1.5708,
        'The mean wind blows to this bearing, clockwise from north; the default is a westerly.',
        'rad',
        -6.3,
        6.3,
        live=True,
    ),
    Parameter(
        'turbulence',
        'kaimal',
        'The spectrum of the turbulence.',
        choices=(*SPECTRA, 'none'),
        live=True,
        source='IEC 61400-1',
    ),
    Parameter(
        'intensity',
        0.2,
        'The turbulence intensity: the standard deviation along the wind over the mean speed.',
        '',
        0.0,
        1.0,
        live=True,
    ),
    Parameter('height', 10.0, 'The height of the anemometer above the ground.', 'm', 0.5, 200.0),
    Parameter('seed', 0, 'The seed of the turbulence.', '', 0, 2**31 - 1),
    Parameter(
        'gust',
        'none',
        'The event that happens to the wind from time to time.',
        choices=('none', *EVENT_KINDS),
        live=True,
        source='IEC 61400-1',
    ),
    Parameter(
        'gust_speed',
        6.0,
        'A gust or step raises the wind by this much.',
        'm/s',
        -40.0,
        40.0,
        live=True,
    ),
    Parameter(
        'gust_angle',
        1.5708,
        'A change of direction or a turn goes through this angle.',
        'rad',
        -3.15,
        3.15,
        live=True,
    ),
    Parameter('gust_duration', 5.0, 'An event lasts so long.', 's', 0.1, 60.0, live=True),
    Parameter(
        'gust_every',
        20.0,
        'The time from one event to the next; with 0 there is only one.',
        's',
        0.0,
        3600.0,
        live=True,
    ),
    Parameter(
        'fault',
        'none',
        'The sensor fails in this way from time to time, in each in turn with `all`.',
        choices=FAULTS,
        live=True,
    ),
    Parameter(
        'fault_every',
        20.0,
        'Time from one fault to the next; the first comes after so long.',
        's',
        0.1,
        3600.0,
        live=True,
    ),
    Parameter('fault_duration', 1.0, 'Each fault lasts so long.', 's', 0.01, 600.0, live=True),
)

WIND: Table = (
    _LIFECYCLE,
    Parameter(
        'input_type',
        WIND_TYPE_NAMES[0],
        'The node reads messages of this type from `wind`.',
        choices=WIND_TYPE_NAMES,
    ),
    _convention('Reads'),
    Parameter(
        'speed_scale',
        1.0,
        'The unit of the speed in m/s: 0.514444 for knots, 0.277778 for km/h.',
        '',
        0.001,
        1000.0,
        live=True,
    ),
    Parameter(
        'yaw_offset',
        0.0,
        'The wind is turned by this angle, counter-clockwise, to undo a turned mast.',
        'rad',
        -6.3,
        6.3,
        live=True,
    ),
    Parameter(
        'plane_normal',
        (0.0, 0.0, 1.0),
        'The normal of the force plane.',
        '',
        -1.0,
        1.0,
        source='the paper, 3.2',
    ),
    _FRAME,
    Parameter('max_speed', 40.0, 'Faster samples are refused.', 'm/s', 1.0, FASTEST_WIND),
    Parameter('max_rate', 20.0, 'Samples that change faster are refused.', 'm/s^2', 1.0, 1000.0),
    Parameter(
        'longest_refusal', 0.5, 'A change that lasts so long is taken as true.', 's', 0.05, 10.0
    ),
    Parameter(
        'frozen_after',
        10.0,
        'A sensor whose samples are equal for so long is reported as frozen.',
        's',
        1.0,
        3600.0,
    ),
    Parameter(
        'timeout',
        2.0,
        'Diagnostics say WARN after so long without a good sample, STALE after five times that; '
        'of a slow sensor after three of its periods.',
        's',
        0.1,
        60.0,
        live=True,
    ),
)

SOLVER: Table = (
    _LIFECYCLE,
    Parameter(
        'tree', 'benjamina', 'The tree: a built-in name, or the file of a tree or a forest.'
    ),
    Parameter(
        'shards',
        1,
        'The trees of a stand are dealt over so many solvers, of which this is one.',
        '',
        1,
        10_000,
        source='doc/shards.md',
    ),
    Parameter('shard', 0, "This solver's own shard, from 0 on.", '', 0, 9_999),
    Parameter(
        'species',
        '',
        "The wood: a key of the species table or a species file; the tree's own if empty.",
    ),
    Parameter('rate', 60.0, 'The tree is solved so many times per second.', 'Hz', 1.0, 1000.0),
    Parameter(
        'publish_every', 1, 'Poses are published once in so many steps.', '', 1, 1000, live=True
    ),
    Parameter(
        'fidelity',
        _MODEL.model,
        'The model of the sway, from the least to the most; `auto` takes the least that keeps '
        'within tolerance and budget.',
        choices=FIDELITIES,
        source="`branch` is the paper's, `segments` its predecessors'",
    ),
    Parameter(
        'modes',
        0,
        'The model `modes` solves so many natural modes; 0 means 12, or all if there are fewer.',
        '',
        0,
        10_000,
    ),
    Parameter(
        'tolerance',
        0.005,
        'The model `auto` lets the tips err by no more than this, while no `camera` is heard.',
        'm',
        1e-6,
        10.0,
        live=True,
    ),
    Parameter(
        'tolerance_pixels',
        0.5,
        'The model `auto` lets the tips err by no more than this on the picture of a `camera`.',
        'px',
        0.01,
        100.0,
        live=True,
    ),
    Parameter(
        'budget',
        0.0,
        'The model `auto` keeps a frame within this time, before any tolerance; 0 means no limit.',
        'us',
        0.0,
        1e6,
        live=True,
    ),
    Parameter(
        'focal_length', 1000.0, 'The focal length of that camera.', 'px', 1.0, 100_000.0, live=True
    ),
    Parameter(
        'stiffness',
        _MODEL.stiffness,
        'The stiffness of a branch follows from its beam, or from its volume.',
        choices=STIFFNESS_RULES,
        source="`volume_rule` is the paper's",
    ),
    Parameter(
        'integrator',
        _MODEL.integrator,
        'The method that steps the oscillators; it is refused where its step would be unstable.',
        choices=REAL_TIME,
        source='doc/choosing_a_method.md',
    ),
    Parameter(
        'leaves',
        'auto',
        'The tree bears leaves, with their mass, drag and damping; with `auto` where its species '
        'is evergreen. In a forest this is for trees that do not say.',
        choices=tuple(LEAVES),
    ),
    Parameter(
        'leaf_clusters',
        1000,
        'In leaf, `tree_description` tells so many clusters of leaves; 0 means none.',
        '',
        0,
        100_000,
    ),
    Parameter(
        'profile',
        _MODEL.profile.kind,
        'The wind changes with height by this law, or is the same everywhere.',
        choices=PROFILES,
    ),
    Parameter(
        'anemometer_height',
        _MODEL.profile.anemometer_height,
        'The height of the anemometer over the ground, for the profile.',
        'm',
        0.1,
        200.0,
    ),
    Parameter(
        'profile_exponent',
        _MODEL.profile.exponent,
        'The exponent of the power law.',
        '',
        0.0,
        1.0,
        source='Davenport 1960',
    ),
    Parameter(
        'roughness',
        _MODEL.profile.roughness,
        'The roughness length of the logarithmic law.',
        'm',
        1e-5,
        5.0,
    ),
    Parameter(
        'gravity',
        _MODEL.gravity,
        'The weight of a tree softens it; 0 leaves it out, for a scan too noisy to stand.',
        'm/s^2',
        0.0,
        30.0,
        live=True,
    ),
    Parameter(
        'stiffness_factor',
        1.0,
        'The wood is stiffer by this factor than its species says.',
        '',
        0.1,
        10.0,
        live=True,
    ),
    Parameter(
        'volume_stiffness',
        _MODEL.volume_stiffness,
        'The constant of stiffness of the volume rule.',
        'N m/rad/m^3',
        1e-3,
        1e9,
        live=True,
        source='Kanda & Ohya, equation 2',
    ),
    Parameter(
        'volume_damping',
        _MODEL.volume_damping,
        'The constant of damping of the volume rule.',
        'N m s/rad/m^3',
        1e-3,
        1e9,
        live=True,
        source='Kanda & Ohya, equation 2',
    ),
    Parameter(
        'crown_coherence',
        _MODEL.crown_coherence,
        'Share of a gust that reaches the whole crown at once; the rest comes limb by limb.',
        '',
        0.0,
        1.0,
        source='Davenport 1961',
    ),
    Parameter(
        'root_stiffness',
        0.0,
        "The stiffness of the roots against tilting, 1e15 for rigid ones; 0 means the tree's own.",
        'N m/rad',
        0.0,
        1e15,
    ),
    Parameter(
        'damping_ratio',
        0.0,
        "The damping ratio of every branch; 0 means the species' own.",
        '',
        0.0,
        1.0,
        live=True,
    ),
    Parameter(
        'interpolation',
        'linear',
        'The wind between two samples follows a line, or is held.',
        choices=INTERPOLATIONS,
    ),
    Parameter(
        'wind_delay',
        0.02,
        'The tree feels the wind so much later; samples that arrive within this time give the '
        'same motion in every run.',
        's',
        0.0,
        2.0,
        live=True,
    ),
    Parameter(
        'exact_replay',
        False,
        'In simulated time a frame waits until the wind reaches beyond it, as a player sends it.',
    ),
    Parameter(
        'timeout',
        2.0,
        'When samples stop, the last wind is held for so long; that of a slow sensor for three of '
        'its periods.',
        's',
        0.1,
        60.0,
    ),
    Parameter(
        'decay',
        6.0,
        'After that the wind dies away with this time constant (its force with half of it).',
        's',
        0.1,
        60.0,
    ),
    _FRAME,
    Parameter('x', 0.0, "Where the tree's own origin lies in the frame.", 'm', -1e6, 1e6),
    Parameter('y', 0.0, 'The same to the north.', 'm', -1e6, 1e6),
    Parameter('z', 0.0, 'The same upwards; the ground of the wind profile.', 'm', -1e4, 1e4),
    Parameter('yaw', 0.0, 'Turn of the tree, counterclockwise from above.', 'rad', -6.3, 6.3),
    Parameter(
        'hash_in_frame',
        False,
        'Poses say `frame_id#hash`, with the hash of `tree_description`: whose they are is seen.',
    ),
    Parameter(
        'marker_rate',
        20.0,
        'Markers are published so many times per second; 0 means never.',
        'Hz',
        0.0,
        20.0,
    ),
    Parameter('marker_classes', 6, 'The markers have so many line widths.', '', 1, 32),
    Parameter(
        'state_rate', 30.0, 'States per second on `tree_state`; 0 for none.', 'Hz', 0.0, 1000.0
    ),
    Parameter(
        'publish_tf',
        False,
        'The node also publishes one TF frame per segment; this needs tf2_msgs.',
    ),
)

PLAYER: Table = (
    _LIFECYCLE,
    Parameter('file', '', 'The wind record to play: TOA5, NMEA 0183, CSV or a rosbag2 bag.'),
    Parameter(
        'play',
        'wind',
        'The player publishes the `wind` of the record, to be solved anew, or of a bag the '
        '`state` as it was sent: `tree_state` and `tree_description`.',
        choices=('wind', 'state'),
    ),
    *_OUTPUT,
    Parameter(
        'speed',
        1.0,
        'The record is played so many times as fast as it was made.',
        '',
        0.01,
        1000.0,
    ),
    Parameter('loop', True, 'At its end the record starts again, while time goes on.'),
    Parameter('start', 0.0, 'So much of the record is skipped at its beginning.', 's', 0.0),
    Parameter(
        'publish_clock', False, 'The node publishes `/clock`, for nodes with `use_sim_time`.'
    ),
    Parameter(
        'clock_rate',
        250.0,
        'The clock is published so many times per second of real time.',
        'Hz',
        10.0,
        1000.0,
    ),
    Parameter('wait_for_subscriber', True, 'The record starts when those of `wait_for` listen.'),
    Parameter(
        'wait_for',
        'wind',
        'These topics must have a subscriber, or so many as `topic:number` says. With '
        '`publish_clock` and `wind/filtered` among them time waits for the solver: the replay is '
        'exact.',
    ),
    Parameter('topic', '', 'The topic of the wind in a bag; may be empty if it has but one.'),
    Parameter('yaw', 0.0, 'Angle from east to the x axis of the sensor.', 'rad', -6.3, 6.3),
    Parameter(
        'input_convention',
        '',
        "The record's vectors say where the wind blows `to` or comes `from`; empty for the "
        "format's own.",
        choices=('', 'to', 'from'),
    ),
    Parameter(
        'reader_options', '', 'More for the reader of the file, such as `rate=20 sentence=MWV`.'
    ),
)

VIEWER: Table = (
    Parameter('address', '127.0.0.1', "To bind to; any but this machine's own needs a token."),
    Parameter('port', 8765, 'Of the page; 0 for a free one.', '', 0, 65535),
    Parameter('token', '', 'What pages must know, as `?token=`.'),
    Parameter('certificate', '', 'PEM file, to serve the page over TLS.'),
    Parameter('private_key', '', "PEM file of the certificate's key."),
    Parameter('max_clients', 64, 'Most pages at once.', '', 1, 1000),
    Parameter(
        'origins',
        '',
        'Pages of these origins may follow the stream: `https://a.org https://b.org`.',
    ),
    Parameter('control', False, 'Pages may change the wind and the tolerance, pause and reset.'),
)

SENSOR: Table = (
    _LIFECYCLE,
    Parameter(
        'address',
        'udp://:10110',
        'The instrument is heard at `tcp://host:port`, `udp://:port` or `serial:/dev/x:4800`.',
    ),
    Parameter(
        'sentence',
        'auto',
        'The node reads sentences of this kind; with `auto` the kind of the first good one.',
        choices=('auto', *SENTENCES, *SONIC_KINDS),
    ),
    Parameter(
        'heading',
        0.0,
        'The bow or the north marker points there, clockwise from true north.',
        'rad',
        -6.3,
        6.3,
        live=True,
    ),
    Parameter(
        'declination', 0.0, 'Magnetic declination, east positive.', 'rad', -3.2, 3.2, live=True
    ),
    Parameter('need_checksum', False, 'Sentences without a checksum are refused.', live=True),
    Parameter(
        'silence', 10.0, 'A link without a byte for so long is made anew.', 's', 0.1, 3600.0
    ),
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
