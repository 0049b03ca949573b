"""From tracked points to velocities, forces, restitution and inertia."""
