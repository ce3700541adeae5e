"""The tree in the wind: laws that hold for every rung, and what a live stream may throw at it."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from tree_sway_ros.core.growth.builtin import BUILTIN_TREES, builtin_tree
from tree_sway_ros.core.settings import RUNGS
from tree_sway_ros.core.simulator import LOAD_HELD, OK, WIND_REFUSED, SwaySimulator
from tree_sway_ros.core.tree_building import tree_from_segments
from tree_sway_ros.errors import ParameterError, SpeciesError

MOVING = [rung for rung in RUNGS if rung != "frozen"]
DT = 1.0 / 60.0


def gusts(n, seed=3):
    rng = np.random.default_rng(seed)
    return np.array([6.0, 2.0, 0.5]) + np.cumsum(rng.normal(0.0, 0.6, (n, 3)), axis=0)


def run(sim, winds, dt=DT):
    """Poses after each wind, (k, n, 7)."""
    frames = []
    for wind in winds:
        sim.step(wind, dt)
        frames.append(sim.place().copy())
    return np.array(frames)


@pytest.fixture(params=MOVING)
def rung(request):
    return request.param


def swaying(tree, rung, **changes):
    return SwaySimulator(tree, rung=rung, **({"n_modes": 4} | changes))


def test_the_same_wind_gives_the_same_bits(fork, rung):
    winds = gusts(100)
    one, other = (run(swaying(fork(), rung), winds) for _ in range(2))
    assert one.tobytes() == other.tobytes()


def test_without_wind_a_tree_stands_exactly_at_rest(fork, rung):
    sim = swaying(fork(), rung)
    rest = sim.place().copy()
    frames = run(sim, np.zeros((50, 3)))
    assert (frames == rest).all()
    # The tip is found from its pose, to rounding.
    assert sim.tip_displacement == pytest.approx(np.zeros(3), abs=1e-14)


@pytest.mark.parametrize("name", BUILTIN_TREES)
def test_a_westerly_bends_every_tree_to_the_east(name):
    bends_east(builtin_tree(name), "subtree")


@pytest.mark.parametrize("rung", RUNGS)
def test_a_westerly_bends_the_tree_of_every_rung_to_the_east(fork, rung):
    bends_east(fork(), rung, n_modes=4)


@pytest.mark.long
@pytest.mark.parametrize("name", BUILTIN_TREES)
@pytest.mark.parametrize("rung", ["frozen", "branch", "modes", "coupled"])
def test_a_westerly_bends_every_tree_on_every_rung_to_the_east(name, rung):
    bends_east(builtin_tree(name), rung)


def bends_east(tree, rung, **changes):
    sim = SwaySimulator(tree, rung=rung, damping_ratio=0.5, **changes)
    rest = sim.place()[:, :3].copy()
    for _ in range(240):
        sim.step([6.0, 0.0, 0.0], DT)
    moved = sim.place()[:, :3] - rest
    if rung == "frozen":
        assert not moved.any()
        return
    assert sim.tip_displacement[0] > 1e-5
    mean = (moved * tree.length[:, None]).mean(axis=0)
    assert mean[0] > 5.0 * abs(mean[1])


def test_mirrored_wind_gives_mirrored_motion(mirror_fork, rung):
    tree, partner = mirror_fork()
    mirror = np.array([1.0, -1.0, 1.0])
    winds = gusts(150)
    one = run(swaying(tree, rung, n_modes=12), winds)
    other = run(swaying(tree, rung, n_modes=12), winds * mirror)
    assert np.abs(one[-1] - one[0]).max() > 1e-3
    assert other[:, partner, :3] == pytest.approx(one[:, :, :3] * mirror, abs=1e-9)


@pytest.mark.parametrize("heading", [0.7, np.pi])
@pytest.mark.parametrize(
    ("rung", "within", "gravity"),
    # What is left: the inertia a branch gives way with, and the static rest under weight, go by each axis.
    [("branch", 1e-12, 9.81), ("subtree", 1e-5, 9.81), ("modes", 1e-12, 0.0), ("coupled", 1e-12, 9.81)],
)
def test_a_turned_tree_in_turned_wind_moves_alike(fork, rung, within, gravity, heading):
    tree = fork()
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    turned = tree_from_segments(
        tree.start @ turn,
        tree.end @ turn,
        np.stack([tree.base_diameter, tree.tip_diameter], axis=1),
        parent=tree.segment_parent,
        branch=tree.branch_of_segment,
    )
    winds = gusts(60)
    one, other = (swaying(t, rung, n_modes=8, gravity=gravity) for t in (tree, turned))
    moved = run(one, winds)[:, :, :3]
    assert np.ptp(moved, axis=0).max() > 5e-3
    assert run(other, winds @ turn)[:, :, :3] == pytest.approx(moved @ turn, abs=within)


@pytest.mark.parametrize(
    "bad", [np.nan, np.inf, -np.inf, 1e300, 1e6, -1e6], ids=["nan", "inf", "-inf", "1e300", "1e6", "-1e6"]
)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_wind_that_cannot_be_is_refused_and_the_last_one_held(fork, bad, axis):
    winds = gusts(40)
    for rung in ("subtree", "modes"):
        held, struck = swaying(fork(), rung), swaying(fork(), rung)
        for k, wind in enumerate(winds):
            blow = np.array(wind)
            if k == 20:
                wind = winds[19]
                blow[axis] = bad
            assert held.step(wind, DT) == OK
            assert struck.step(blow, DT) == (WIND_REFUSED if k == 20 else OK)
            assert struck.place().tobytes() == held.place().tobytes()
        assert (struck.counts.refused, struck.counts.steps, held.counts.refused) == (1, 40, 0)


def test_bad_wind_from_the_start_is_no_wind(fork, rung):
    sim = swaying(fork(), rung)
    rest = sim.place().copy()
    assert sim.step([np.nan, 0.0, 0.0], DT) == WIND_REFUSED
    assert (sim.place() == rest).all()


@given(st.lists(st.floats(width=64, allow_nan=True, allow_infinity=True), min_size=3, max_size=3))
@settings(deadline=None, max_examples=80)
def test_no_wind_ever_poisons_a_tree(wild_sim, wind):
    for dt in (DT, 0.5):
        wild_sim.step(wind, dt)
        wild_sim.step([150.0 * (-1) ** wild_sim.counts.steps, 0.0, 0.0], dt)
    poses = wild_sim.place()
    assert np.isfinite(poses).all()
    tree = wild_sim.tree
    assert np.linalg.norm(poses[:, :3] - tree.start[0], axis=1).max() <= tree.length.sum()


@pytest.fixture(scope="module")
def wild_sim(fork):
    return SwaySimulator(fork(), rung="subtree", gravity=0.0)


@pytest.mark.parametrize("rung", RUNGS)
def test_a_step_allocates_nothing(fork, rung):
    sim = swaying(fork(), rung)
    wind, out = np.array([5.0, 1.0, 0.0]), np.zeros((sim.tree.n_segments, 7))
    for _ in range(3):
        sim.step(wind, DT)
        sim.place(out)
    tracemalloc.start()
    try:
        sim.step(wind, DT)
        sim.place(out)
        before, _ = tracemalloc.get_traced_memory()
        tracemalloc.reset_peak()
        for _ in range(500):
            sim.step(wind, DT)
            sim.place(out)
        after, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # A few Python numbers come and go; no array does.
    assert after - before < 512
    assert peak - before < 2048


@pytest.mark.parametrize("taper", [0.0, 0.6])
def test_static_deflection_is_the_beams(stem, rung, taper):
    length, base, wind = 1.2, 0.012, 5.0
    tree = stem(length, base, base * (1 - taper), cuts=8)
    sim = swaying(tree, rung, gravity=0.0, damping_ratio=1.0, n_modes=1)
    for _ in range(1200):
        sim.step([wind, 0.0, 0.0], DT)
    sim.place()

    def moment(x):
        return quad(lambda s: (s - x) * (1 - taper * s), x, 1)[0]

    unit = quad(lambda x: moment(x) * (1 - x) / (1 - taper * x) ** 4, 0, 1)[0]
    load = 0.5 * 1.225 * sim.species.drag_coefficient * wind**2 * base
    tip = unit * load * length**4 / (sim.species.modulus * np.pi / 64 * base**4)
    assert sim.tip_displacement[0] == pytest.approx(tip, rel=2e-3)
    assert abs(sim.tip_displacement[1]) < 1e-9


def test_late_and_uneven_steps_end_at_the_same_place(fork, rung):
    even, uneven = (swaying(fork(), rung, damping_ratio=0.3) for _ in range(2))
    rng = np.random.default_rng(0)
    run(even, [[5.0, 1.0, 0.0]] * 1800)
    for k in range(600):
        uneven.step([5.0, 1.0, 0.0], 0.5 if k % 60 == 59 else rng.uniform(0.005, 0.08))
    assert np.abs(even.tip_displacement).max() > 1e-3
    assert uneven.place() == pytest.approx(even.place(), abs=1e-12)


def test_a_stall_is_one_long_step(stem):
    """Free decay in still air, a breath of it: one step of a time is as many as fit in it."""
    split, whole = (swaying(stem(), "subtree", gravity=0.0) for _ in range(2))
    for sim in (split, whole):
        sim.step([0.01, 0.0, 0.0], DT)
        sim.step([0.0, 0.0, 0.0], DT)
    for _ in range(30):
        split.step([0.0, 0.0, 0.0], DT)
    whole.step([0.0, 0.0, 0.0], 30 * DT)
    one, other = split.place() - whole.place(), split.place()
    moved = np.abs(other[:, 0] - split.tree.start[:, 0]).max()
    assert moved > 0.0
    # Air drag at a micrometre a second is what is left.
    assert np.abs(one).max() < 1e-3 * moved


def test_a_change_of_step_does_not_move_the_tree(fork, rung):
    """Half steps, then whole ones: the same motion to the second order of the step."""
    def wind(t):
        return np.array([5.0 + 2.0 * np.sin(3.0 * t), 0.0, 0.0])

    ends = []
    for plan in ([DT / 8] * 960, [DT / 2] * 120 + [DT] * 60):
        sim, t = swaying(fork(), rung), 0.0
        for dt in plan:
            sim.step(wind(t + dt / 2), dt)
            t += dt
        sim.place()
        ends.append(sim.tip_displacement.copy())
    assert ends[0] == pytest.approx(ends[1], abs=0.01 * np.abs(ends[0]).max())


def test_the_step_is_of_second_order(fork, rung):
    def tip_after(n):
        sim = swaying(fork(), rung, n_modes=8, gravity=0.0)
        h = 1.0 / n
        for k in range(n):
            # Mean over the step of 5 + 3 sin 4t.
            mean = 5.0 + 3.0 * (np.cos(4 * k * h) - np.cos(4 * (k + 1) * h)) / (4 * h)
            sim.step([mean, 0.0, 0.0], h)
        sim.place()
        return sim.tip_displacement.copy()

    truth = tip_after(4096)
    error = [np.abs(tip_after(n) - truth).max() for n in (128, 256)]
    assert np.log2(error[0] / error[1]) == pytest.approx(2.0, abs=0.35)


def test_reset_goes_back_to_rest_and_repeats(fork, rung):
    sim = swaying(fork(), rung)
    winds = gusts(30)
    first = run(sim, winds)
    sim.reset()
    assert sim.place()[:, :3] == pytest.approx(sim.tree.start, abs=1e-12)
    assert sim.step([np.nan] * 3, DT) == WIND_REFUSED
    assert sim.tip_displacement == pytest.approx(np.zeros(3), abs=1e-12)
    sim.reset()
    assert run(sim, winds).tobytes() == first.tobytes()
    assert sim.counts.steps == 61


def test_a_storm_that_is_held_says_so(stem):
    sim = SwaySimulator(stem(length=1.0, base=0.002, cuts=4), rung="subtree", gravity=0.0)
    status = [sim.step([140.0, 0.0, 0.0], DT) for _ in range(30)]
    assert set(status) <= {OK, LOAD_HELD}
    assert LOAD_HELD in status
    assert sim.counts.held >= status.count(LOAD_HELD)


def test_place_writes_where_it_is_told(fork):
    sim = swaying(fork(), "subtree")
    sim.step([8.0, 0.0, 0.0], DT)
    out = np.zeros((sim.tree.n_segments, 7))
    assert sim.place(out) is out
    tip = sim.tip_displacement.copy()
    assert (sim.place() == out).all()
    assert (sim.tip_displacement == tip).all()


def test_what_it_says_of_the_tree(fork):
    sim = swaying(fork(), "coupled", leaf_mass=np.array([0.0, 0.1, 0.1, 0.1]))
    assert sim.rung == "coupled"
    assert sim.mass == pytest.approx(900.0 * sim.tree.volume.sum() + 0.3)
    assert sim.n_solved + sim.n_copied == sim.tree.n_branches
    assert (np.diff(sim.frequencies()) >= 0).all()
    assert len(sim.frequencies(3)) == 3
    assert len(swaying(fork(), "frozen").frequencies()) == 0


@pytest.mark.parametrize("dt", [0.0, -0.1, float("nan"), float("inf")])
def test_a_step_that_is_none_is_refused(fork, dt):
    sim = swaying(fork(), "subtree")
    sim.step([5.0, 0.0, 0.0], DT)
    before = sim.place().copy()
    with pytest.raises(ParameterError, match=r"step: time step of .*; give a finite one above 0"):
        sim.step([5.0, 0.0, 0.0], dt)
    assert (sim.place() == before).all()


def test_errors_of_a_simulator(fork):
    with pytest.raises(SpeciesError, match="unknown species 'plastic'"):
        SwaySimulator(plastic(fork()))
    with pytest.raises(ParameterError, match="100 modes of a tree that has"):
        SwaySimulator(fork(), rung="modes", n_modes=100)
    with pytest.raises(TypeError, match="no_such_setting"):
        SwaySimulator(fork(), no_such_setting=1)


def plastic(tree):
    return tree_from_segments(
        tree.start, tree.end, tree.base_diameter, parent=tree.segment_parent, species="plastic"
    )
