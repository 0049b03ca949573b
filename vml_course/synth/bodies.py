"""Sizes on which what is tracked and what is drawn must agree."""

from __future__ import annotations

from dataclasses import dataclass

BAT_CLAMP_M = 0.05
CATCHER_HUB_M = 0.036
HAMMER_HUB_M = 0.045


@dataclass(frozen=True, slots=True)
class Catcher:
    """Sizes in metres: how deep below the pivot the tunnel lies, its pellet, and the mark below the tunnel."""

    depth_m: float
    pellet_m: float
    mark_m: float

    @property
    def half_m(self) -> float:
        """Half the width of the box."""
        return 2.3 * self.pellet_m + 0.02

    @property
    def card_m(self) -> float:
        """Radius of the card around the mark."""
        return 0.036

    @property
    def bottom_m(self) -> float:
        """How deep the box reaches below the pivot."""
        return self.depth_m + self.mark_m + self.card_m + 0.008
