# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What motion sensors have told about a tree, and its species with that."""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

from tree_sway.core.species import Species

_RANGES = {'stiffness': (0.4, 2.5), 'damping': (0.2, 5.0), 'drag': (0.2, 3.0)}
"""Factors that several runs can add up to: some four deviations of each within a species."""


@dataclass(frozen=True)
class LearnedTree:
    """
    Factors over the tree before, each with the standard deviation of its logarithm.

    Parameters
    ----------
    frequency
        First natural frequency with the learned stiffness in [Hz].
    stiffness, stiffness_error
        Factor on the modulus and on the stiffness of the roots [-].
    damping, damping_error
        Factor on the damping ratio of the season [-].
    drag, drag_error
        Factor on the drag [-].
    hours
        Length of the motion that it was learned from in [h].
    change
        How its sway has changed meanwhile, a sentence; empty if it has not.

    """

    frequency: float
    stiffness: float
    stiffness_error: float
    damping: float
    damping_error: float
    drag: float
    drag_error: float
    hours: float
    change: str = ''

    def __str__(self) -> str:
        """Return it as a sentence."""
        # The frequency goes with the root of the stiffness.
        of_frequency = 50.0 * self.stiffness_error
        return (
            f'learned from {self.hours:.2g} h of motion: first frequency '
            f'{self.frequency:.4g} Hz +- {of_frequency:.1f} %, stiffness {self.stiffness:.3g} '
            f'times that before +- {100.0 * self.stiffness_error:.1f} %, damping '
            f'{self.damping:.3g} times +- {100.0 * self.damping_error:.0f} %, drag '
            f'{self.drag:.3g} times +- {100.0 * self.drag_error:.0f} %'
            f'{"; " + self.change if self.change else ""}'
        )

    def after(self, before: LearnedTree | None) -> LearnedTree:
        """
        Join it with what was learned before, by which its own tree was made.

        Logarithms are weighted by hours. Errors of stiffness and damping are independent; that of
        the drag is not, for the anemometer stands where it stood.
        """
        if before is None:
            return self
        share = self.hours / max(self.hours + before.hours, 1e-9)
        found = {
            name: min(max(getattr(before, name) * getattr(self, name) ** share, low), high)
            for name, (low, high) in _RANGES.items()
        }
        errors = {
            name: math.hypot(share * getattr(self, name), (1.0 - share) * getattr(before, name))
            for name in ('stiffness_error', 'damping_error')
        }
        return LearnedTree(
            **found,
            **errors,
            drag_error=share * self.drag_error + (1.0 - share) * before.drag_error,
            frequency=before.frequency * (self.frequency / before.frequency) ** share,
            hours=before.hours + self.hours,
            change=self.change or before.change,
        )

    def over(self, before: LearnedTree | None) -> LearnedTree:
        """Return it with factors over the tree in which ``before`` is already."""
        if before is None:
            return self
        found = {name: getattr(self, name) / getattr(before, name) for name in _RANGES}
        return replace(self, **found)

    def of(self, species: Species, *, in_leaf: bool) -> Species:
        """Return a species with what was learned in a season."""
        damping = 'damping_in_leaf' if in_leaf else 'damping_bare'
        changes = {
            'modulus': self.stiffness * species.modulus,
            'root_stiffness': self.stiffness * species.root_stiffness,
            damping: min(self.damping * getattr(species, damping), 1.0),
            'drag_coefficient': self.drag * species.drag_coefficient,
            'bare_drag_coefficient': self.drag * species.bare_drag_coefficient,
        }
        return replace(species, **changes, is_estimate=False)  # type: ignore[arg-type]
