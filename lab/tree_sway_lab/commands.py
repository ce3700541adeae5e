# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The commands of the laboratory, found by the entry point of the package."""

from __future__ import annotations

from tree_sway.commands import Command

COMMANDS: dict[str, Command] = {
    'battery': Command(
        'the cases where methods of integration fail, and what ours does there',
        'battery T4',
        'tree_sway_lab.battery.command',
    ),
    'bench': Command(
        'time the solver',
        'bench step --rounds 2',
        'tree_sway_lab.bench.command',
    ),
    'chart': Command(
        'speed against accuracy: of methods, of models, against size',
        'chart methods -o charts',
        'tree_sway_lab.chart.command',
    ),
    'compare': Command(
        'our simulator against MuJoCo, in one run',
        'compare goldcrest --seconds 1',
        'tree_sway_lab.compare.command',
    ),
    'docs': Command(
        'write the tables of topics and parameters into the pages',
        'docs --check',
        'tree_sway_lab.pages.command',
    ),
    'film': Command(
        'how far a camera brings the model to the tree that it films',
        'film "spruce 8" --points --seconds 20',
        'tree_sway_lab.twin.film_command',
    ),
    'fuzz': Command(
        'damaged messages to every reader of a line, by their numbers',
        'fuzz --minutes 0.1 --only "Modbus TCP"',
        'tree_sway_lab.fuzz.command',
    ),
    'hours': Command(
        'whether a tree with a sensor drifts or raises false alarms in hours of weather',
        'hours --hours 0.1',
        'tree_sway_lab.twin.hours_command',
    ),
    'paper': Command(
        'the experiment of Kanda & Ohya as it is written, and what ours does instead',
        'paper',
        'tree_sway_lab.paper.command',
    ),
    'score': Command(
        'how well a measured sway follows from its wind and sensors',
        'score oak.yaml --wind wind.csv --sway sway.csv --motion motion.csv --at 3.2',
        'tree_sway_lab.twin.score_command',
    ),
    'soak': Command(
        'run the chain through every fault of a sensor, and report what it costs',
        'soak --hours 0.002 --every 1',
        'tree_sway_lab.soak.command',
    ),
    'twin': Command(
        'how far motion sensors bring the model to a tree that it does not know',
        'twin straight --seconds 60 --sensors 0 1',
        'tree_sway_lab.twin.command',
    ),
    'validate': Command(
        'every check with its figure and its limit, as validation.md',
        'validate --kind limbs8 --wind 9 --quick',
        'tree_sway_lab.validation.command',
    ),
}
