# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""``tree-sway chart validation``: models on random crooked trees, by their worst cases."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from tree_sway_ros.core.arrays import Floats
from tree_sway_ros.study.validation.crooked_trees import crooked_tree
from tree_sway_ros.study.validation.judge import SWAYS, Judge, Verdict
from tree_sway_ros.study.validation.winds import from_record, hard_cases, turbulent

SEEDS = (1, 4, 8, 9, 11)


def chart_validation(
    out_dir: str | Path,
    *,
    wind: tuple[Floats, Floats] | None = None,
    source: str = "a record",
    seeds: Iterable[int] = SEEDS,
    seconds: float = 8.0,
) -> list[Verdict]:
    """
    Judge all models on crooked trees and write ``validation.md``.

    Parameters
    ----------
    out_dir
        Folder to write into; made if it is not there.
    wind
        Times in [s], (m,), and velocities in [m/s], (m, 3), of a record, taken once and thrice as
        strong; simulated winds alone if None.
    source
        What the record is called.
    seeds
        Of the trees.
    seconds
        Length of each run in [s].

    """
    verdicts: list[Verdict] = []
    steady: dict[str, list[float]] = {}
    for seed in seeds:
        judge = Judge(crooked_tree(seed))
        steady[judge.tree.name] = judge.steady_sway()
        winds = {f"{mean:g} m/s": turbulent(mean, seconds, seed) for mean in (3.0, 9.0)}
        if wind is not None:
            winds |= {f"{source} x{k:g}": from_record(*wind, seconds, k) for k in (1.0, 3.0)}
        verdicts += judge.verdicts(winds | hard_cases(seconds, judge.first_frequency))
    folder = Path(out_dir)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "validation.md").write_text(
        _table(verdicts) + _trees(verdicts, steady), encoding="utf-8"
    )
    return verdicts


def _table(verdicts: list[Verdict]) -> str:
    """Largest tip error over tip motion of each full model in each wind, over all trees."""
    winds = list(dict.fromkeys(one.wind for one in verdicts))
    models = list(dict.fromkeys(one.model for one in verdicts if "frozen" not in one.model))
    lines = ["| model | " + " | ".join(winds) + " |", "|---" * (1 + len(winds)) + "|"]
    for model in models:
        worst = [
            max((v.error for v in verdicts if (v.model, v.wind) == (model, wind)), default=np.nan)
            for wind in winds
        ]
        lines.append(f"| `{model}` | " + " | ".join(f"{each:.3f}" for each in worst) + " |")
    over = [one.over_estimate for one in verdicts if np.isfinite(one.over_estimate)]
    trees = ", ".join(dict.fromkeys(one.tree for one in verdicts))
    lines += ["", f"Largest tip error over tip motion on the trees {trees}.", ""]
    most, median = max(over), np.median(over)
    lines.append(f"True error over estimate: {most:.2f} at most, {median:.2f} in the median.")
    return "\n".join(lines) + "\n"


_SHOWN = ("modes 12", "coupled")


def _trees(verdicts: list[Verdict], steady: dict[str, list[float]]) -> str:
    """What two models do on each tree in turbulence, and how far its steady sways are off."""
    winds = [w for w in dict.fromkeys(one.wind for one in verdicts) if w.endswith("m/s")]
    errors = {(one.tree, one.model, one.wind): one.error for one in verdicts}
    heads = [f"`{model}`, {wind}" for model in _SHOWN for wind in winds]
    heads += [f"`coupled`, steady {100.0 * sway:.0f} %" for sway in SWAYS]
    heads += ["true over estimate: most", "median"]
    lines = ["", "| tree | " + " | ".join(heads) + " |", "|---" * (1 + len(heads)) + "|"]
    for tree, off in steady.items():
        over = [v.over_estimate for v in verdicts if v.tree == tree and v.over_estimate < np.inf]
        told = [f"{errors[tree, model, wind]:.3f}" for model in _SHOWN for wind in winds]
        told += [f"{100.0 * each:+.1f} %" for each in off]
        told += [f"{max(over):.2f}", f"{np.median(over):.2f}"]
        lines.append(f"| {tree} | " + " | ".join(told) + " |")
    lines += [
        "",
        "Steady: sway of the highest tip beyond the truth's, in a wind that leans it so far.",
    ]
    return "\n".join(lines) + "\n"
