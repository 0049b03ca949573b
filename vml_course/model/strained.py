"""How a body is strained in a simulated clip: the yardstick of every measured strain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vml_course.errors import UnknownNameError
from vml_course.model.arrays import Axes, FloatArray, set_frozen


@dataclass(frozen=True, eq=False)
class StrainTruth:
    """The deformation of a body at its tracked points, in every frame.

    Attributes
    ----------
    load : float array, shape (n,)
        The load of each frame as a part of the full one, 0 to 1.
    gradient : float array, shape (n, p, 2, 2)
        Displacement gradient du_i / dX_j of each tracked point, by its place before loading; x right, y up.
    unknowns : mapping of str to float
        What students look for, by the textbook's letter, at full load where it depends on the load.
    """

    load: FloatArray
    gradient: FloatArray
    unknowns: Mapping[str, float]

    def __post_init__(self) -> None:
        axes = Axes()
        set_frozen(
            self,
            load=axes.freeze("load", self.load, "n"),
            gradient=axes.freeze("gradient", self.gradient, "n", "p", 2, 2),
        )

    def unknown(self, symbol: str) -> float:
        """Return the true value of an unknown, SI units.

        Raises
        ------
        UnknownNameError
            When there is no such unknown.
        """
        if symbol not in self.unknowns:
            raise UnknownNameError("unknown", symbol, sorted(self.unknowns))
        return self.unknowns[symbol]

    @property
    def small_strain(self) -> FloatArray:
        """Engineering strain (e_xx, e_yy, e_xy) of each point, shape (n, p, 3): the gradient's symmetric part."""
        g = self.gradient
        return np.stack([g[..., 0, 0], g[..., 1, 1], (g[..., 0, 1] + g[..., 1, 0]) / 2], axis=-1)

    @property
    def green_strain(self) -> FloatArray:
        """Green-Lagrange strain (E_xx, E_yy, E_xy) of each point, shape (n, p, 3), which no turn changes.

        E = (H + H^T + H^T H) / 2 of the displacement gradient H (Holzapfel 2000, Nonlinear Solid Mechanics, 2.4).
        """
        g = self.gradient
        whole = (g + np.swapaxes(g, -1, -2) + np.swapaxes(g, -1, -2) @ g) / 2
        return np.stack([whole[..., 0, 0], whole[..., 1, 1], whole[..., 0, 1]], axis=-1)

    @property
    def most(self) -> float:
        """The largest strain of any tracked point along an axis, in size."""
        return float(np.abs(self.green_strain[..., :2]).max())
