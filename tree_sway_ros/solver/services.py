# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The services of the solver: pause, and reset."""

from __future__ import annotations

from typing import Any

from std_srvs.srv import SetBool, Trigger

from tree_sway.core.scene import Run
from tree_sway_ros.process.node import TreeSwayNode


def offer_services(node: TreeSwayNode, run: Run) -> None:
    """Offer `~/reset` and `~/pause` of a run."""

    def reset(_request: Any, _response: Any) -> Any:
        run.request(run.simulator.reset)
        return Trigger.Response(success=True, message='at rest')

    def pause(request: Any, _response: Any) -> Any:
        run.is_paused = bool(request.data)
        text = 'paused' if request.data else 'running'
        return SetBool.Response(success=True, message=text)

    node.create_service(Trigger, '~/reset', reset)
    node.create_service(SetBool, '~/pause', pause)
