"""An infinite plate with a round hole, pulled along x: Kirsch's field in closed form.

Stresses as in Timoshenko and Goodier, Theory of Elasticity, 3rd ed. (1970), §35, eq. 61. Displacements come from the
same solution in complex potentials (Muskhelishvili; Timoshenko and Goodier §§ 57-61): with z = x + i y

    2 G (u + i v) = kappa phi(z) - z conj(phi'(z)) - conj(psi(z)),
    phi = S/4 (z + 2 a^2/z),    psi = -S/2 (z + a^2/z - a^4/z^3),

and kappa = (3 - nu)/(1 + nu) for plane stress. The hole's rim moves along the pull by 3 S a/E.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vml_course.model.arrays import FloatArray

INSIDE = 0.7  # of the radius: the field goes on that far into the hole, then fades evenly to nothing in its middle


@dataclass(frozen=True)
class Kirsch:
    """Hole of radius a at the origin, pull S along x far away, Young's modulus E, Poisson's ratio nu."""

    radius_m: float
    stress_Pa: float  # noqa: N815 - the unit is pascal
    modulus_Pa: float  # noqa: N815
    poisson: float

    @property
    def kappa(self) -> float:
        """Muskhelishvili's constant for plane stress."""
        return (3 - self.poisson) / (1 + self.poisson)

    @property
    def twice_shear_Pa(self) -> float:  # noqa: N802
        """Twice the shear modulus."""
        return self.modulus_Pa / (1 + self.poisson)

    def displacement_m(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement: shape (..., 2) -> (..., 2), m; rigid motion left out."""
        z, faded = self._outside(xy_m)
        near = self.radius_m / z  # powers by products: complex ones by pow are slow
        square, scale = near * near, self.stress_Pa / (4 * self.twice_shear_Pa)
        phi, slope, psi = z * (1 + 2 * square), 1 - 2 * square, -2 * z * (1 + square - square * square)
        w = faded * scale * (self.kappa * phi - z * slope.conj() - psi.conj())
        return np.stack([w.real, w.imag], axis=-1)

    def gradient(self, xy_m: FloatArray) -> FloatArray:
        """Return the displacement gradient du_i / dX_j, outside the hole: shape (..., 2) -> (..., 2, 2)."""
        z, _ = self._outside(xy_m)
        slope, bend, psi_slope = self._slopes(z)
        along = (self.kappa * slope - slope.conj()) / self.twice_shear_Pa  # d/dz
        against = (-z * bend.conj() - psi_slope.conj()) / self.twice_shear_Pa  # d/d conj(z)
        x, y = along + against, 1j * (along - against)
        return np.stack([np.stack([x.real, y.real], axis=-1), np.stack([x.imag, y.imag], axis=-1)], axis=-2)

    def stress(self, xy_m: FloatArray) -> FloatArray:
        """Return s_xx, s_yy, s_xy outside the hole: shape (..., 2) -> (..., 3), Pa."""
        z, _ = self._outside(xy_m)
        slope, bend, psi_slope = self._slopes(z)
        total, turned = 4 * slope.real, 2 * (z.conj() * bend + psi_slope)
        return np.stack([(total - turned.real) / 2, (total + turned.real) / 2, turned.imag / 2], axis=-1)

    def stress_of(self, gradient: FloatArray) -> FloatArray:
        """Return the stress that Hooke's law for plane stress gives to a displacement gradient: (..., 3), Pa."""
        xx, yy, xy = gradient[..., 0, 0], gradient[..., 1, 1], (gradient[..., 0, 1] + gradient[..., 1, 0]) / 2
        stiff = self.modulus_Pa / (1 - self.poisson**2)
        return np.stack(
            [stiff * (xx + self.poisson * yy), stiff * (yy + self.poisson * xx), self.twice_shear_Pa * xy], axis=-1
        )

    def _slopes(self, z: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return phi', phi'' and psi'."""
        s, aa = self.stress_Pa, self.radius_m**2
        return s / 4 * (1 - 2 * aa / z**2), s * aa / z**3, -s / 2 * (1 - aa / z**2 + 3 * aa**2 / z**4)

    def _outside(self, xy_m: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return z, moved out to the innermost circle where it lies within, and by how much that was to be scaled."""
        z = np.asarray(xy_m[..., 0] + 1j * xy_m[..., 1])
        least = INSIDE * self.radius_m
        faded = np.minimum(np.abs(z) / least, 1.0)
        z[faded == 0.0] = least * 1e-12
        return z / np.maximum(faded, 1e-12), faded
