# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a live stream must survive, row by row, and the tests that show it."""

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
HERE = 'faults/test_live_wind.py'
ROWS = {
    'no wind ever': [
        ('nodes/test_solver.py', 'test_without_wind_the_rest_pose_comes_at_the_full_rate')
    ],
    'dropout of 0.1 to 2 s': [(HERE, 'test_dropout_of_a_moment_is_held_without_a_visible_step')],
    'dropout beyond the time-out': [
        (HERE, 'test_dropout_beyond_the_time_out_decays_and_the_first_sample_resumes'),
        ('nodes/test_solver.py', 'test_a_dropout_decays_to_rest_while_poses_go_on'),
        ('nodes/test_wind.py', 'test_a_silent_sensor_goes_from_warn_to_error'),
    ],
    'NaN, inf, 999.99, 1e300': [
        (HERE, 'test_what_is_no_wind_is_refused_and_counted_by_cause'),
        ('nodes/test_wind.py', 'test_bad_samples_are_refused_and_counted'),
        ('nodes/test_solver.py', 'test_bad_wind_leaves_the_state_alone'),
    ],
    'spikes, steps, frozen sensor': [
        (HERE, 'test_what_is_no_wind_is_refused_and_counted_by_cause'),
        (HERE, 'test_frozen_sensor_is_a_warning_and_the_stream_goes_on'),
        ('faults/test_half_hour.py', 'test_every_spike_is_refused_and_hardly_a_true_sample'),
        ('nodes/test_wind.py', 'test_a_spike_is_refused_and_a_true_step_passes'),
    ],
    'stamp zero, future, duplicate, out of order': [
        (HERE, 'test_stamps_that_lie_are_counted_and_never_step_back'),
        ('nodes/test_wind.py', 'test_stamps_that_lie_are_counted_and_never_step_back'),
    ],
    'clock jumps back': [
        (
            'nodes/test_simulated_time.py',
            'test_a_clock_set_back_resets_and_goes_on_within_two_periods',
        ),
    ],
    'clock jumps forward, pause': [
        ('nodes/test_simulated_time.py', 'test_a_clock_set_forward_is_no_explosion'),
        ('nodes/test_simulated_time.py', 'test_poses_follow_the_clock_and_stop_with_it'),
        ('ros/timing/test_pacer.py', 'test_a_wall_clock_set_forward_skips_nothing'),
    ],
    'late joiner': [
        ('nodes/test_solver.py', 'test_a_late_joiner_gets_the_structure_and_the_next_pose')
    ],
    'slow subscriber or page': [
        ('nodes/test_solver.py', 'test_a_subscriber_that_takes_nothing_slows_nobody'),
        ('page/test_server.py', 'test_a_slow_viewer_sees_new_frames_and_holds_up_nobody'),
        ('page/test_long_line.py', 'test_a_slow_reader_sees_what_is_new'),
    ],
    'solver slower than the period': [
        (
            'ros/timing/test_pacer.py',
            'test_work_that_takes_too_long_skips_frames_without_a_backlog',
        ),
        ('ros/timing/test_pacer.py', 'test_what_is_skipped_is_counted_whatever_its_length'),
        (
            'ros/reports/test_reports.py',
            'test_frames_that_are_skipped_are_a_warning_until_it_keeps_up',
        ),
    ],
    'SIGKILL and restart, any order of start': [
        (
            'nodes/test_executables.py',
            'test_killed_and_started_again_it_sways_as_if_nothing_had_been',
        ),
        (
            'nodes/test_player.py',
            'test_replays_are_the_same_bit_for_bit_whatever_the_machine_does_beside',
        ),
        ('faults/test_kill.py', 'test_whoever_is_killed_the_stream_is_whole_again'),
    ],
    'parameter out of range': [
        ('nodes/test_solver.py', 'test_a_change_out_of_range_is_refused_with_the_reason'),
        (
            'nodes/test_anemometer.py',
            'test_a_live_change_that_overlaps_faults_is_refused_with_an_answer',
        ),
        ('core/run/test_tuning.py', 'test_no_pose_jumps'),
    ],
    "hostile input on the page's socket": [
        ('page/test_server.py', 'test_what_is_no_request_is_closed'),
        ('page/test_server.py', 'test_bad_frames_are_closed'),
        ('page/test_server.py', 'test_slow_headers_are_closed'),
        ('page/test_server.py', 'test_hostile_input_costs_no_memory_and_a_viewer_no_frame'),
    ],
}


@pytest.mark.parametrize('row', ROWS)
def test_each_row_has_its_tests(row):
    for file, name in ROWS[row]:
        tree = ast.parse((TESTS / file).read_text(encoding='utf-8'))
        assert name in {each.name for each in tree.body if isinstance(each, ast.FunctionDef)}
