"""Known scenes: physics by pymunk, pictures by numpy and OpenCV."""
