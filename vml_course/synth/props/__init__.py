"""Things to draw, shared by scenes: limbs, balls, rooms, scale bars."""
