# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Follow a tree that sways on another machine, and print where its highest tip is.

    tree-sway show goldcrest --port 8765
    python examples/python/follow.py http://127.0.0.1:8765/ --seconds 5

"""

from __future__ import annotations

import argparse
import threading
import time

import numpy as np

from tree_sway.stream import StreamClient


def main() -> None:
    """Print the tip twice a second."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('page', help='address of the page, with its token if it has one')
    parser.add_argument('--seconds', type=float, default=10.0)
    given = parser.parse_args()
    pause = threading.Event()
    with StreamClient(given.page) as client:
        client.wait(60.0)
        poses = client.poses()
        assert poses is not None
        highest = int(np.argmax(poses[:, 2]))
        end = time.monotonic() + given.seconds
        while time.monotonic() < end:
            moment, poses = client.sample(), client.poses()
            if moment is not None and poses is not None:
                x, y, z = poses[highest, :3]
                speed = float(np.linalg.norm(moment.wind))
                print(f'wind {speed:5.2f} m/s, tip at {x:+.3f} {y:+.3f} {z:.3f} m', flush=True)
            pause.wait(0.5)


if __name__ == '__main__':
    main()
