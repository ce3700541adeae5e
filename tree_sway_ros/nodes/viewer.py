# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The viewer node: the page of doc/streaming.md, fed from `tree_state` and `tree_description`."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
import json
import time
from typing import Any

from geometry_msgs.msg import Transform, Vector3, Wrench
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from sensor_msgs.msg import MultiDOFJointState
from std_srvs.srv import SetBool, Trigger

from tree_sway.errors import FormatError, ParameterError
from tree_sway.page import PageServer, PageSettings
from tree_sway.parameters import SWAY
from tree_sway.stream import (
    Control,
    ControlPanel,
    decode_description,
    Description,
    encode_state,
    PAUSE_AND_RESET,
    Refused,
)
from tree_sway_ros.process.node import TreeSwayNode
from tree_sway_ros.process.topics import (
    PULL,
    TREE_DESCRIPTION,
    TREE_STATE,
    WIND,
    WIND_FILTERED,
)
from tree_sway_ros.reports.diagnostics import OK, Status, WARN
from tree_sway_ros.reports.one_publisher import OnePublisher
from tree_sway_ros.reports.refusals import Refusals
from tree_sway_ros.wire.tree_state import read_state, read_state_entry

USUAL_OR_FREE = -1
"""Value of `port` for the usual port or, if it is in use, a free one."""
_CHECK_PERIOD = 0.5
_LIVE = {
    'mean_speed': ('anemometer', 'Wind'),
    'intensity': ('anemometer', 'Gustiness'),
    'bearing_to': ('anemometer', 'Blows to'),
    'tolerance': ('solver', 'Tolerance'),
}
_SIMULATORS, _PLAYERS = ('anemometer',), ('player', 'rosbag2_player')
"""Names of nodes whose wind is simulated, or recorded; that of others is measured now."""

_LOOKS = 8
"""Number of looks, a period apart, over which the rate of the wind is counted."""


class ViewerNode(TreeSwayNode):
    """Serves the page; subscribes `tree_state` once a page is connected."""

    def configure(self) -> None:
        """Subscribe to the description, and prepare the controls."""
        self._settings = PageSettings(
            **self.values.subset('address', 'token_file', 'certificate', 'private_key'),
            **self.values.subset('max_clients'),
            port=None if self.values['port'] == USUAL_OR_FREE else self.values['port'],
            origins=tuple(self.values['origins'].split()),
        )
        self._settings.required_token()
        controls = _controls(), self._apply, self._pull
        self._panel = ControlPanel(*controls) if self.values['control'] else None
        self._pulls = self.publisher(replace(PULL, name='solver/pull'))
        self._frame_ids: list[str] = []
        self._description: Description | None = None
        self._described = ''
        self._followed = OnePublisher()
        self._refusals = Refusals(['states'])
        self._held: Any = None
        self._sequence = 0
        self._subscription: Any = None
        self._wind_subscription: Any = None
        self._n_samples = 0
        self._counted: deque[tuple[float, int]] = deque(maxlen=_LOOKS)
        self._wind: dict[str, object] = {'kind': 'none'}
        self._setters = {
            node: self.create_client(SetParameters, f'{node}/set_parameters')
            for node in ('anemometer', 'solver')
        }
        self._reset = self.create_client(Trigger, 'solver/reset')
        self._pause = self.create_client(SetBool, 'solver/pause')
        self.server: PageServer | None = None
        self.subscription(TREE_DESCRIPTION, self._describe)
        self.create_timer(_CHECK_PERIOD, self._look)
        self.report_with('page', self._statuses)

    def activate(self) -> None:
        """Serve the page."""
        server = PageServer(
            self._settings, self._panel, lambda: {'source': 'ROS 2', 'wind': self._wind}
        )
        server.start()
        self.server = server
        self._described = ''
        self.on_close(self._end_page)
        self.get_logger().info(f'the page is at {server.url}')

    def _end_page(self) -> None:
        if self.server is not None:
            self.server.close()
            self.server = None
        self._look()

    def _look(self) -> None:
        """Subscribe to the state while pages are connected; it is not computed without any."""
        server = self.server
        is_seen = server is not None and server.n_clients > 0
        if is_seen and self._subscription is None:
            self._subscription = self.subscription(TREE_STATE, self._receive)
            self._wind_subscription = self.subscription(WIND_FILTERED, self._count)
        elif not is_seen and self._subscription is not None:
            self.destroy_subscription(self._subscription)
            self.destroy_subscription(self._wind_subscription)
            self._subscription = self._wind_subscription = None
        self._take_held()
        self._counted.append((time.monotonic(), self._n_samples))
        self._wind = self._source()

    def _count(self, _sample: Any) -> None:
        self._n_samples += 1

    def _source(self) -> dict[str, object]:
        """Return what the wind is, by the nodes that publish it, and its present rate [Hz]."""
        topic = self.resolve_topic_name(WIND.name)
        names = [info.node_name for info in self.get_publishers_info_by_topic(topic)]
        if not names:
            return {'kind': 'none'}
        if all(name in _SIMULATORS for name in names):
            return {'kind': 'simulated'}
        if all(name in _PLAYERS for name in names):
            return {'kind': 'recorded', 'name': topic}
        (begin, first), (end, last) = self._counted[0], self._counted[-1]
        rate = (last - first) / (end - begin) if end > begin else 0.0
        return {'kind': 'live', 'name': topic, 'rate': round(rate, 1)}

    def _describe(self, message: Any) -> None:
        server = self.server
        if message.data == self._described or server is None:
            return
        # Another solver in this domain describes its own tree, maybe: the first one is shown.
        is_held = self._description is not None and len(self._solvers) > 1
        self._held = message if is_held else None
        if is_held:
            return
        self._described = message.data
        try:
            content = json.loads(message.data)
        except ValueError as error:
            raise FormatError(f'not JSON ({error})', where='tree_description') from None
        data = read_state_entry(content)
        if data is None:
            return
        self._description = decode_description(data)
        names = content['segments']['names']
        self._frame_ids = [f'{content["tree_frame"]}/{each}' for each in names]
        server.describe(data)

    def _take_held(self) -> None:
        """Take the description of another solver once that is the only one."""
        if self._held is not None and len(self._solvers) < 2:
            self._describe(self._held)

    @property
    def _solvers(self) -> list[str]:
        """Names of the nodes that publish states."""
        topic = self.resolve_topic_name(TREE_STATE.name)
        return sorted(self.publishers_of(topic, 'std_msgs/Float64MultiArray'))

    def _receive(self, message: Any, info: Mapping[str, object]) -> None:
        self._take_held()
        description = self._description
        server = self.server
        if description is None or server is None:
            return
        try:
            stamp, wind, flags, coordinates = read_state(message)
        except FormatError as error:
            self._refusals.note('states', str(error))
            return
        count = len(description.scale)
        if len(coordinates) < count or (len(coordinates) - count) % 2 > 0:
            self._refuse_another(len(coordinates), count)
            return
        if not self._followed.admits(info, lambda: len(self._solvers), time.monotonic()):
            return
        frame = encode_state(description, self._sequence, stamp, wind, coordinates, flags)
        self._sequence += 1
        server.publish(frame)

    def _refuse_another(self, sent: int, count: int) -> None:
        """Count a state that is of another tree, by its numbers of coordinates."""
        if len(self._solvers) > 1:
            self._followed.refused += 1
        else:
            self._refusals.note('states', f'{sent} coordinates of a tree with {count}')

    def _statuses(self) -> list[Status]:
        n_pages = 0 if self.server is None else self.server.n_clients
        refused = self._followed.refused
        missed = 0 if self.server is None else self.server.n_missed
        values = {
            'pages': n_pages,
            'frames': self._sequence,
            'missed by pages': missed,
            'refused': refused,
        }
        text = f'{n_pages} pages'
        solvers = self._solvers
        refusals = self._refusals.statuses()
        if len(solvers) < 2:
            return [Status('page', OK, text, values), *refusals]
        mixed = f'{len(solvers)} solvers in this domain: {", ".join(solvers)}'
        cure = 'one is shown; give each system a ROS_DOMAIN_ID or a namespace'
        return [Status('page', WARN, f'{text}; {mixed}: {cure}', values), *refusals]

    def _apply(self, name: str, value: Any) -> None:
        """Forward a viewer's change to its node; a refusal arrives later."""
        if name == 'reset':
            self._ask(self._reset, Trigger.Request())
        elif name == 'pause':
            self._ask(self._pause, SetBool.Request(data=bool(value)))
        else:
            number = Parameter(name, value=float(value)).to_parameter_msg()
            request = SetParameters.Request(parameters=[number])
            self._ask(self._setters[_LIVE[name][0]], request)

    def _pull(
        self, segment: int, to: tuple[float, ...], stiffness: float, _refused: Refused
    ) -> None:
        """Forward a viewer's pull to the solver, which reports refusals in its diagnostics."""
        kinds = self._description.header['kinds'] if self._description else ()
        if any(kind['model'] == 'branch' for kind in kinds):
            raise ParameterError("model 'branch' cannot be pulled", where='pull')
        if self._pulls.get_subscription_count() == 0:
            raise ParameterError('nothing offers solver/pull', cure='start the solver')
        if not 0 <= segment < len(self._frame_ids):
            raise ParameterError(f'no segment {segment} is described', where='pull')
        x, y, z = map(float, to)
        pull = MultiDOFJointState(joint_names=[self._frame_ids[segment]])
        pull.transforms = [Transform(translation=Vector3(x=x, y=y, z=z))]
        pull.wrench = [Wrench(force=Vector3(x=float(stiffness)))]
        self._pulls.publish(pull)

    def _ask(self, client: Any, request: Any) -> None:
        if not client.service_is_ready():
            raise ParameterError(
                f'nothing offers {client.srv_name}', cure='start the node, or do not change this'
            )

        server = self.server

        def answered(future: Any) -> None:
            for result in getattr(future.result(), 'results', ()):  # of parameters
                if not result.successful and server is not None:
                    server.announce({'refused': {'name': '', 'reason': result.reason}})

        client.call_async(request).add_done_callback(answered)


def _controls() -> tuple[Control, ...]:
    """Make the controls of viewers, with the ranges of the nodes' parameters."""
    live = (Control.of(SWAY[name], label) for name, (_, label) in _LIVE.items())
    return (*live, *PAUSE_AND_RESET)
