"""Runs in a process of its own: what a first frame costs after a start, and what a long clip costs in memory."""

from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path


def main() -> None:
    """Track a video: child.py VIDEO SEEDS-JSON; prints one line of JSON."""
    video, seeds = Path(sys.argv[1]), json.loads(sys.argv[2])
    from vml_course.io.source import open_source  # noqa: PLC0415 - the imports are what is measured
    from vml_course.model.track import Seed  # noqa: PLC0415
    from vml_course.track.run import run  # noqa: PLC0415
    from vml_course.track.tracker import make_tracker  # noqa: PLC0415

    stamps: list[float] = []
    tracker = make_tracker("dic")
    points = [Seed(name, *place) for name, place in seeds.items()]
    track = run(tracker, open_source(video).frames(0, None, 1), points, on_frame=lambda *_: stamps.append(time.time()))
    facts = {
        "first_picture_at": stamps[1],  # the first one is the seeds themselves
        "stamps": stamps,
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "lost": int(track.is_lost.sum()),
    }
    sys.stdout.write(json.dumps(facts) + "\n")


if __name__ == "__main__":
    main()
