"""
The parameters of each node, one table a node.

Defaults stand here and nowhere else: the files in ``config/`` hold overrides only.

"""

from __future__ import annotations

from tree_sway_ros.core.oscillators.step_rules import REAL_TIME
from tree_sway_ros.core.scene.make import FIDELITIES
from tree_sway_ros.core.simulator.season import LEAVES
from tree_sway_ros.core.simulator.settings import STIFFNESS_RULES, Settings
from tree_sway_ros.core.wind.averaging import INTERPOLATIONS
from tree_sway_ros.core.wind.height_profile import PROFILES
from tree_sway_ros.core.wind.limits import FASTEST_WIND
from tree_sway_ros.core.wind.simulated.gust_event import EVENT_KINDS
from tree_sway_ros.core.wind.simulated.spectra import SPECTRA
from tree_sway_ros.ros.parameters.parameter import Parameter, Table

_MODEL = Settings()
WIND_TYPE_NAMES = (
    "geometry_msgs/Vector3Stamped",
    "geometry_msgs/TwistStamped",
    "geometry_msgs/TwistWithCovarianceStamped",
    "geometry_msgs/Vector3",
)


def _convention(verb: str) -> Parameter:
    sentence = (
        f"{verb} vectors that say where the wind blows `to` (ROS) or comes `from` (meteorology)."
    )
    choices = ("to", "from")
    return Parameter("direction_convention", "to", sentence, choices=choices, source="REP-103")


_FRAME = Parameter("frame_id", "map", "Frame of what is published.", source="REP-105")

ANEMOMETER: Table = (
    Parameter("rate", 20.0, "Samples a second.", "Hz", 1.0, 100.0, source="sensors seen: 1-80 Hz"),
    Parameter("output_type", WIND_TYPE_NAMES[0], "Message type.", choices=WIND_TYPE_NAMES),
    _convention("Writes"),
    _FRAME,
    Parameter("mean_speed", 6.0, "Mean wind speed.", "m/s", 0.0, 40.0, live=True),
    Parameter(
        "bearing_to",
        1.5708,
        "Where the mean wind blows to, clockwise from north; the default is a westerly.",
        "rad",
        -6.3,
        6.3,
        live=True,
    ),
    Parameter(
        "turbulence",
        "kaimal",
        "Spectrum of the turbulence.",
        choices=(*SPECTRA, "none"),
        live=True,
        source="IEC 61400-1",
    ),
    Parameter(
        "intensity",
        0.2,
        "Standard deviation along the wind over the mean.",
        "",
        0.0,
        1.0,
        live=True,
    ),
    Parameter("height", 10.0, "Of the anemometer above the ground.", "m", 0.5, 200.0),
    Parameter("seed", 0, "Of the turbulence.", "", 0, 2**31 - 1),
    Parameter(
        "gust",
        "none",
        "What happens to the wind from time to time.",
        choices=("none", *EVENT_KINDS),
        live=True,
        source="IEC 61400-1",
    ),
    Parameter("gust_speed", 6.0, "Rise of a gust or step.", "m/s", -40.0, 40.0, live=True),
    Parameter(
        "gust_angle",
        1.5708,
        "Angle of a change of direction or a turn.",
        "rad",
        -3.15,
        3.15,
        live=True,
    ),
    Parameter("gust_duration", 5.0, "Length of the event.", "s", 0.1, 60.0, live=True),
    Parameter(
        "gust_every",
        20.0,
        "From one event to the next; 0 for one only.",
        "s",
        0.0,
        3600.0,
        live=True,
    ),
)

WIND: Table = (
    Parameter("input_type", WIND_TYPE_NAMES[0], "Message type of `wind`.", choices=WIND_TYPE_NAMES),
    _convention("Reads"),
    Parameter(
        "speed_scale",
        1.0,
        "Unit of the speed: knots .514444, km/h .277778.",
        "",
        0.001,
        1000.0,
        live=True,
    ),
    Parameter(
        "yaw_offset",
        0.0,
        "Turn of the mast or of north, counter-clockwise.",
        "rad",
        -6.3,
        6.3,
        live=True,
    ),
    Parameter(
        "plane_normal",
        (0.0, 0.0, 1.0),
        "Normal of the force plane.",
        "",
        -1.0,
        1.0,
        source="the paper, 3.2",
    ),
    _FRAME,
    Parameter("max_speed", 40.0, "Faster samples are refused.", "m/s", 1.0, FASTEST_WIND),
    Parameter("max_rate", 20.0, "Samples that change faster are refused.", "m/s^2", 1.0, 1000.0),
    Parameter("longest_refusal", 0.5, "After so long a change is taken as true.", "s", 0.05, 10.0),
    Parameter("frozen_after", 10.0, "Equal samples for so long are reported.", "s", 1.0, 3600.0),
    Parameter(
        "timeout",
        2.0,
        "Without a good sample for so long: WARN; five times: STALE.",
        "s",
        0.1,
        60.0,
        live=True,
    ),
)

SOLVER: Table = (
    Parameter("tree", "benjamina", "Built-in name, or file of a tree or a forest."),
    Parameter("species", "", "Key of the wood, or a species file; empty for the tree's own."),
    Parameter("rate", 60.0, "Steps a second.", "Hz", 1.0, 1000.0),
    Parameter(
        "publish_every", 1, "Frames: one in so many steps is published.", "", 1, 1000, live=True
    ),
    Parameter(
        "fidelity",
        "modes",
        "Model of the sway, from the least to the most; `auto` takes the least within tolerance "
        "and budget.",
        choices=FIDELITIES,
        source="`branch` is the paper's, `segments` its predecessors'",
    ),
    Parameter(
        "modes", 0, "How many modes `modes` solves; 0 for 12, or all if fewer.", "", 0, 10_000
    ),
    Parameter(
        "tolerance",
        0.005,
        "Largest error of the tips that `auto` allows, while no `camera` is heard.",
        "m",
        1e-6,
        10.0,
        live=True,
    ),
    Parameter(
        "tolerance_pixels",
        0.5,
        "Largest error of the tips that `auto` allows on the picture of a `camera`.",
        "px",
        0.01,
        100.0,
        live=True,
    ),
    Parameter(
        "budget",
        0.0,
        "Longest time that `auto` lets a frame take, before any tolerance; 0 for no limit.",
        "us",
        0.0,
        1e6,
        live=True,
    ),
    Parameter("focal_length", 1000.0, "Of that camera.", "px", 1.0, 100_000.0, live=True),
    Parameter(
        "stiffness",
        _MODEL.stiffness,
        "Stiffness of a branch from its beam, or from its volume.",
        choices=STIFFNESS_RULES,
        source="`volume_rule` is the paper's",
    ),
    Parameter(
        "integrator",
        _MODEL.integrator,
        "Method that steps the oscillators; refused where its step would be unstable.",
        choices=REAL_TIME,
        source="doc/choosing_a_method.md",
    ),
    Parameter(
        "leaves",
        "auto",
        "Leaves, with their mass, drag and damping: `auto` where the species is evergreen; in a "
        "forest, of trees that do not say.",
        choices=tuple(LEAVES),
    ),
    Parameter(
        "leaf_clusters",
        1000,
        "With leaves, so many clusters are told in `tree_description`; 0 for none.",
        "",
        0,
        100_000,
    ),
    Parameter(
        "profile", _MODEL.profile.kind, "Wind over height: the same, or by a law.", choices=PROFILES
    ),
    Parameter(
        "anemometer_height",
        _MODEL.profile.anemometer_height,
        "Of the anemometer over the ground, for the profile.",
        "m",
        0.1,
        200.0,
    ),
    Parameter(
        "profile_exponent",
        _MODEL.profile.exponent,
        "Of the power law.",
        "",
        0.0,
        1.0,
        source="Davenport 1960",
    ),
    Parameter(
        "roughness", _MODEL.profile.roughness, "Roughness length of the log law.", "m", 1e-5, 5.0
    ),
    Parameter(
        "gravity",
        _MODEL.gravity,
        "Its weight softens a tree; 0 leaves it out, for a scan too noisy to stand.",
        "m/s^2",
        0.0,
        30.0,
    ),
    Parameter("damping_ratio", 0.0, "Of every branch; 0 for the species' own.", "", 0.0, 1.0),
    Parameter(
        "interpolation",
        "linear",
        "The wind between two samples.",
        choices=INTERPOLATIONS,
    ),
    Parameter(
        "wind_delay",
        0.02,
        "The wind is felt so much later; samples that arrive within it give the same motion in "
        "every run.",
        "s",
        0.0,
        2.0,
        live=True,
    ),
    Parameter("timeout", 2.0, "The last wind is held for so long.", "s", 0.1, 60.0),
    Parameter(
        "decay", 6.0, "Time constant of the wind after that; the force halves it.", "s", 0.1, 60.0
    ),
    _FRAME,
    Parameter("x", 0.0, "Where the tree's own origin lies in the frame.", "m", -1e6, 1e6),
    Parameter("y", 0.0, "The same to the north.", "m", -1e6, 1e6),
    Parameter("z", 0.0, "The same upwards; the ground of the wind profile.", "m", -1e4, 1e4),
    Parameter("yaw", 0.0, "Turn of the tree, counterclockwise from above.", "rad", -6.3, 6.3),
    Parameter(
        "hash_in_frame",
        False,
        "Poses say `frame_id#hash`, with the hash of `tree_description`: whose they are is seen.",
    ),
    Parameter("marker_rate", 20.0, "Markers a second; 0 for none.", "Hz", 0.0, 20.0),
    Parameter("marker_classes", 6, "Line widths of the markers.", "", 1, 32),
    Parameter(
        "state_rate", 30.0, "States per second on `tree_state`; 0 for none.", "Hz", 0.0, 1000.0
    ),
    Parameter("publish_tf", False, "Publish a frame a segment as well; needs tf2_msgs."),
)

PLAYER: Table = (
    Parameter("file", "", "The wind record: TOA5, NMEA 0183, CSV or a rosbag2 bag."),
    Parameter("output_type", WIND_TYPE_NAMES[0], "Message type.", choices=WIND_TYPE_NAMES),
    _convention("Writes"),
    _FRAME,
    Parameter("speed", 1.0, "Times real time.", "", 0.01, 1000.0),
    Parameter("loop", True, "Start again at the end; time goes on."),
    Parameter("start", 0.0, "Skip so much of the record.", "s", 0.0),
    Parameter("publish_clock", False, "Publish /clock, for nodes with `use_sim_time`."),
    Parameter("clock_rate", 250.0, "Clock messages a second of real time.", "Hz", 10.0, 1000.0),
    Parameter("wait_for_subscriber", True, "Start when somebody listens."),
)

VIEWER: Table = (
    Parameter("address", "127.0.0.1", "To bind to; any but this machine's own needs a token."),
    Parameter("port", 8765, "Of the page; 0 for a free one.", "", 0, 65535),
    Parameter("token", "", "What pages must know, as `?token=`."),
    Parameter("certificate", "", "PEM file, to serve the page over TLS."),
    Parameter("private_key", "", "PEM file of the certificate's key."),
    Parameter("max_clients", 64, "Most pages at once.", "", 1, 1000),
    Parameter("control", False, "Pages may change the wind and the tolerance, pause and reset."),
)

NODE_PARAMETERS: dict[str, Table] = {
    "anemometer": ANEMOMETER,
    "wind": WIND,
    "solver": SOLVER,
    "player": PLAYER,
    "viewer": VIEWER,
}
