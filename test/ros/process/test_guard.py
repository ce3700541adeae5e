# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import inspect

from tree_sway_ros.process.guard import CallbackGuard


def fail(number):
    raise ValueError(f'no {number}')


def fail_otherwise(request, response):
    raise KeyError('elsewhere')


def test_what_is_raised_is_counted_and_reported_once_from_each_place():
    said = []
    guard = CallbackGuard(said.append)
    callback = guard.wrapped(fail)
    for number in range(5):
        callback(number)
    assert (guard.count, len(said)) == (5, 1)
    assert guard.latest == 'ValueError: no 4'
    assert 'ValueError: no 0' in said[0]
    assert 'in fail' in said[0]
    guard.wrapped(fail_otherwise)('request', 'response')
    assert (guard.count, len(said)) == (6, 2)


def test_a_service_answers_with_the_response_as_it_was_made():
    guard = CallbackGuard(lambda text: None)
    assert guard.wrapped(fail_otherwise)('request', 'response') == 'response'
    assert guard.wrapped(lambda: 3)() == 3


def test_rclpy_still_sees_the_arguments_of_the_callback():
    assert list(inspect.signature(CallbackGuard(print).wrapped(fail)).parameters) == ['number']
