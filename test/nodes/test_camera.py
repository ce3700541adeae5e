# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera over ROS: the tree follows its pictures, and bad ones are refused and counted."""

import time

import pytest

pytest.importorskip('rclpy', reason='ROS 2 is not installed')
cv2 = pytest.importorskip('cv2', reason='needs OpenCV: pip install .[camera]')
pytestmark = pytest.mark.ros

from sensor_msgs.msg import CompressedImage, Image  # noqa: E402, I100

from test.kit.filmed_pictures import clicks, picture, spruce  # noqa: E402
from tree_sway.core.scene import make_simulator  # noqa: E402
from tree_sway.core.tree import tips_of_poses  # noqa: E402
from tree_sway.errors import FormatError, ParameterError  # noqa: E402
from tree_sway.files.export import write_tree  # noqa: E402
from tree_sway_ros.process.topics import CLOCK, IMAGE  # noqa: E402
from tree_sway_ros.reports.diagnostics import OK, WARN  # noqa: E402
from tree_sway_ros.wire.wind_messages import clock_message  # noqa: E402

START, PERIOD = 1_000 * 10**9, 40_000_000
SHOW_AGAIN = 2.0
"""Time [s] after which a picture that is not followed is shown again: a best effort may fail."""


def stamped(message, stamp):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    return message


def image(pixels, stamp=None, **changes):
    message = Image(encoding='mono8', width=pixels.shape[1], height=pixels.shape[0])
    message.step, message.data = message.width, pixels.tobytes()
    for name, value in changes.items():
        setattr(message, name, value)
    return stamped(message, stamp or time.time_ns())


def jpeg(pixels, stamp):
    message = CompressedImage(format='jpeg')
    message.data = cv2.imencode('.jpg', pixels)[1].tobytes()
    return stamped(message, stamp)


@pytest.fixture
def leaning(tmp_path):
    """Give the file of a tree, its clicks, pictures of it on its way to a lean, and that lean."""
    tree = spruce()
    write_tree(tmp_path / 'tree.yaml', tree)
    (tmp_path / 'oak.clicks').write_text(clicks(tree))
    true = make_simulator(tree)
    pictures = [picture(cv2, tree, true.place())]
    rest = tips_of_poses(tree, true.place())[0]
    for k in range(120):
        true.step([min(0.15 * k, 12.0), 0.0, 0.0], 1 / 30)
        if k % 3 == 2:
            pictures.append(picture(cv2, tree, true.place()))
    return tmp_path, pictures, tips_of_poses(tree, true.place())[0] - rest


@pytest.mark.parametrize('make', [image, jpeg])
def test_without_wind_the_tree_leans_as_in_the_pictures(
    compose, observer, leaning, statuses, make
):
    """On simulated time, so that a busy machine shows as many pictures a second."""
    folder, pictures, lean = leaning
    topic = 'tree/image_raw' if make is image else 'tree/image_raw/compressed'
    camera = f'{topic}@{folder / "oak.clicks"}'
    parameters = {'tree': str(folder / 'tree.yaml'), 'leaves': 'off', 'camera': camera}
    solver = compose(solver={**parameters, 'use_sim_time': True})['solver']
    kind = Image if make is image else CompressedImage
    publisher, clock = observer.publisher(IMAGE, kind, name=topic), observer.publisher(CLOCK)
    twin = solver.simulator
    rest = tips_of_poses(twin.tree, twin.place())[0]
    shown = []
    # The first tick begins anew, and would forget pictures that came before it.
    begun = clock_message(START - PERIOD)
    observer.until(lambda: clock.publish(begun) or solver.pacer.timing().ticks, 'the first tick')

    def show(pixels):
        stamp, due = START + len(shown) * PERIOD, 0.0
        shown.append(make(pixels, stamp))

        def is_followed():
            nonlocal due
            clock.publish(clock_message(stamp + PERIOD // 2))
            if time.monotonic() > due:
                due = time.monotonic() + SHOW_AGAIN
                for message in shown[-2:]:
                    publisher.publish(message)
            # Steps follow the clock by wind_delay: the picture before is followed by now.
            return stamp == START or twin._seen_at > 1e-9 * (stamp - 2 * PERIOD)

        observer.until(is_followed, f'picture {len(shown)}')

    for pixels in pictures:
        show(pixels)

    def leans():
        moved = tips_of_poses(twin.tree, twin.place())[0] - rest
        return abs(moved[0] - lean[0]) < 0.2 * lean[0]

    # The clock stands, and so does the tree; a pose that is read within a step is none of it.
    observer.until(leans, f'a lean of {lean[0]:.2f} m')
    name = f'solver: camera {topic}'
    observer.until(
        lambda: show(pictures[-1]) or ((status := statuses(name)) and status.level[0] == OK),
        'a report',
    )
    assert 'points on the tree' in statuses(name).message


def test_bad_pictures_are_counted_with_their_cause(compose, observer, leaning, statuses):
    folder, pictures, _ = leaning
    camera = f'tree/image_raw@{folder / "oak.clicks"}'
    solver = compose(solver={'tree': str(folder / 'tree.yaml'), 'camera': camera})['solver']
    publisher = observer.publisher(IMAGE, name='tree/image_raw')
    still = pictures[0]
    for changes, cause in (
        ({'encoding': 'yuv422'}, "encoding 'yuv422'"),
        ({'step': 3}, 'with a step of 3'),
        ({'data': [1, 2]}, 'in 2 bytes'),
        ({'height': 479, 'data': still[:-1].tobytes()}, '640 x 479 after those of 640 x 480'),
    ):

        def is_told(changes=changes, cause=cause):
            publisher.publish(image(still))
            publisher.publish(image(still, **changes))
            report = statuses('solver: camera tree/image_raw')
            return report is not None and cause in report.message

        observer.until(is_told, cause)
    report = statuses('solver: camera tree/image_raw')
    assert report.level[0] == WARN
    assert int({each.key: each.value for each in report.values}['refused']) >= 4
    assert solver.guard.count == 0


@pytest.mark.parametrize(
    ('text', 'error', 'match'),
    [
        ('tree/image_raw', ParameterError, 'is no topic with clicks'),
        ('2tree@x.clicks', ParameterError, 'is no name of a topic'),
        ('tree/image_raw@no_such.clicks', FormatError, 'no_such.clicks'),
        ('tree/image_raw@1,2;', ParameterError, 'is no clicked point'),
        ('tree/image_raw@1,2,b999:0.5;', ParameterError, 'b999'),
    ],
)
def test_what_is_no_camera_is_refused_at_the_start(compose, tree_file, text, error, match):
    with pytest.raises(error, match=match):
        compose(solver={'tree': tree_file, 'camera': text})


def test_clicks_that_fit_no_camera_are_told(compose, observer, leaning, statuses):
    folder, pictures, _ = leaning
    camera = 'tree/image_raw@10,10,0;600,20,1.5;30,400,2.9;bearing=0'
    compose(solver={'tree': str(folder / 'tree.yaml'), 'camera': camera})
    publisher = observer.publisher(IMAGE, name='tree/image_raw')

    def is_told():
        publisher.publish(image(pictures[0]))
        report = statuses('solver: camera tree/image_raw')
        return report is not None and 'no camera fits the clicks' in report.message

    observer.until(is_told, 'why')
