"""Trees that others scanned and digitised: what comes in equals the files' own sums."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat

from tree_sway_ros.core.simulator.assembly import build_bank
from tree_sway_ros.core.simulator.settings import Settings
from tree_sway_ros.files.export.tree_export import write_tree
from tree_sway_ros.files.trees.tree_file import read_tree

TREES = Path(__file__).parents[4] / "shared/data/trees"
pytestmark = pytest.mark.skipif(
    not TREES.exists(), reason="recorded trees are not at ../shared/data"
)


def table(name, skip=1):
    return np.loadtxt(TREES / name, delimiter=",", skiprows=skip)


def sums_of_simpleforest(name):
    data = table(name)
    length = np.linalg.norm(data[:, 5:8] - data[:, 2:5], axis=1)
    order, parent = data[1:, 14], data[1:, 1].astype(int)
    branches = 1 + np.count_nonzero(order != data[parent, 14])
    height = data[:, [4, 7]].max() - data[0, 4]
    return len(data), branches, height, (np.pi * data[:, 8] ** 2 * length).sum()


def sums_of_archi(name):
    data = table(name)
    height = data[:, [2, 5]].max() - data[0, 2]
    return len(data), len(set(data[:, 12])), height, data[:, 11].sum()


def sums_of_treeqsm(radius, length, start, axis, branch):
    ends = start + length[:, None] * axis
    height = max(start[:, 2].max(), ends[:, 2].max()) - start[0, 2]
    return len(radius), len(np.unique(branch)), height, (np.pi * radius**2 * length).sum()


def sums_of_treeqsm_text(name):
    data = np.loadtxt(TREES / name)
    return sums_of_treeqsm(data[:, 0], data[:, 1], data[:, 2:5], data[:, 5:8], data[:, 12])


def sums_of_treeqsm_mat(name):
    content = loadmat(TREES / name, squeeze_me=True, struct_as_record=False)
    (qsm,) = (value for key, value in content.items() if not key.startswith("__"))
    names = ("radius", "length", "start", "axis", "branch")
    columns = [np.asarray(getattr(qsm.cylinder, name), dtype=float) for name in names]
    sums = sums_of_treeqsm(*columns)
    # What TreeQSM says itself, in litres and in single precision.
    assert sums[3] == pytest.approx(qsm.treedata.TotalVolume / 1000, rel=1e-6)
    return sums


def sums_of_tree121(name):
    data = table(name)
    d0, d1 = data[:, 9], data[:, 10]
    length = np.linalg.norm(data[:, 6:9] - data[:, 3:6], axis=1)
    volume = (np.pi / 12 * length * (d0**2 + d0 * d1 + d1**2)).sum()
    return len(data), len(set(data[:, 2])), data[:, [5, 8]].max() - data[0, 5], volume


@pytest.mark.parametrize(
    ("name", "sums"),
    [
        ("qsm_simpleforest.csv", sums_of_simpleforest),
        ("tree121.simpleforest.csv", sums_of_simpleforest),
        ("qsm_archi.csv", sums_of_archi),
        ("qsm_treeqsm_2.3.txt", sums_of_treeqsm_text),
        ("qsm_treeqsm_v5.mat", sums_of_treeqsm_mat),
        ("qsm_treeqsm_struct.mat", sums_of_treeqsm_mat),
        ("tree121.csv", sums_of_tree121),
    ],
)
def test_equal_to_the_files_own_sums(name, sums):
    tree = read_tree(TREES / name).tree
    segments, branches, height, volume = sums(name)
    assert (tree.n_segments, tree.n_branches) == (segments, branches)
    assert tree.height == pytest.approx(height, rel=1e-6)
    assert tree.volume.sum() == pytest.approx(volume, rel=1e-6)


def test_tree121_from_mean_radii_is_nearly_the_same():
    one, other = (
        read_tree(TREES / f"tree121{suffix}").tree for suffix in (".csv", ".simpleforest.csv")
    )
    np.testing.assert_allclose(other.end, one.end, atol=1e-6)
    np.testing.assert_array_equal(other.branch_parent, one.branch_parent)


def test_walnut():
    """8301 vertices with a position, one root, 7.95 m."""
    tree_file = read_tree(TREES / "walnut.mtg")
    tree = tree_file.tree
    lines = (TREES / "walnut.mtg").read_text().splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith("ENTITY-CODE"))
    cells = [line.split("\t") for line in lines[begin + 1 :] if line.strip()]
    z = np.array([float(row[17]) for row in cells if len(row) > 17 and row[17].strip()])
    assert len(z) == 8301
    assert tree_file.notes[0].startswith("8301 vertices with a position")
    assert tree.height == pytest.approx((z.max() - z[0]) / 100, rel=1e-6)
    assert tree.height == pytest.approx(7.95, abs=0.01)
    assert np.count_nonzero(tree.segment_parent < 0) == 1
    # Every vertex of the finest scale with a position is a segment, or was merged.
    merged = int(re.match(r"\d+", tree_file.notes[1])[0])
    fine = [
        row for row in cells if re.search(r"[SU]\d+", "".join(row[:10])) and "".join(row[15:18])
    ]
    assert tree.n_segments + merged == len(fine)
    assert tree.base_diameter[0] == pytest.approx(0.270)


def test_the_walnut_sways_as_walnuts_do():
    """
    f1 within 1.2 to 1.9 Hz, and 20 modes or more below 2.9 Hz, with the walnut wood of the table.

    """
    tree_file = read_tree(TREES / "walnut.mtg", species="walnut")
    settings = Settings(model="modes", n_modes=20, mode_choice="slowest")
    slowest = build_bank(tree_file.tree, tree_file.species, settings).frequencies
    assert 1.2 <= slowest[0] <= 1.9
    assert len(slowest) == 20
    assert slowest[-1] < 2.9


@pytest.mark.parametrize("name", ["walnut.mtg", "qsm_treeqsm_v5.mat"])
def test_written_and_read_again(tmp_path, name):
    first = read_tree(TREES / name).tree
    write_tree(tmp_path / "again.yaml", first)
    again = read_tree(tmp_path / "again.yaml").tree
    for key, value in vars(first).items():
        if key != "source_index":
            np.testing.assert_array_equal(getattr(again, key), value, err_msg=key)


def test_world_coordinates_are_moved_and_reported():
    tree_file = read_tree(TREES / "qsm_archi.csv")
    np.testing.assert_array_equal(tree_file.tree.start[0], 0.0)
    assert tree_file.origin[2] == pytest.approx(253.948, abs=1e-3)
    assert any(note.startswith("moved by") for note in tree_file.notes)
