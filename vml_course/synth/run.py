"""What a simulation gives: poses in every frame, and the states around the contact.

Positions and velocities of b bodies come as arrays of shape (b, 3): x, y and angle, or vx, vy and angular
velocity, of each body's origin; metres, y up, radians counter-clockwise.
"""

from __future__ import annotations

from dataclasses import dataclass

from vml_course.model.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Contact:
    """The first contact; the normal points from the first to the second body, the impulse acts on the second.

    Attributes
    ----------
    step : int
        The step at whose end the bodies meet.
    point_m, normal, impulse_N_s : float array, shape (2,)
    pose, before, after : float array, shape (b, 3)
        Where the bodies are, and their velocities before and after.
    """

    step: int
    point_m: FloatArray
    normal: FloatArray
    impulse_N_s: FloatArray  # noqa: N815 - the unit is newton second
    pose: FloatArray
    before: FloatArray
    after: FloatArray


@dataclass(frozen=True, eq=False)
class Run:
    """A simulated clip.

    Attributes
    ----------
    pose : float array, shape (n, b, 3)
        Logged poses, the first at time 0.
    start, end : float array, shape (b, 3)
        Velocities at the first and the last of them.
    contact : Contact or None
    episodes, other_contacts : int
        How often the two bodies met, and how often any others did.
    later_impulse_N_s : float
        What the contact gave after its first step.
    """

    pose: FloatArray
    start: FloatArray
    end: FloatArray
    contact: Contact | None
    episodes: int
    other_contacts: int
    later_impulse_N_s: float  # noqa: N815

    @property
    def met(self) -> Contact:
        """The contact of a run that has one; runs without are refused before anybody asks."""
        if self.contact is None:
            raise ValueError("nothing is hit")
        return self.contact
