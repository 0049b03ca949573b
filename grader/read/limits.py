"""How large a workbook may be.

A typical submission has 15 members, 0.6 MB of XML and a compression ratio of 6; each limit leaves a factor of ten
or more, and keeps the worst accepted file within seconds and a few hundred megabytes.
"""

from __future__ import annotations

FILE_BYTES = 10 * 2**20
MEMBERS = 512
MEMBER_BYTES = 64 * 2**20
TOTAL_BYTES = 96 * 2**20
RATIO = 200
RATIO_FROM_BYTES = 2**20  # small members may compress well for honest reasons

XML_DEPTH = 64
XML_ELEMENTS = 5_000_000
XML_NAMES = 1_000  # remembered; a workbook has a few dozen
SHEETS = 64
NAMES = 4_000
STYLES = 66_000  # Excel itself stops at 65 490
STRINGS = 100_000
CELLS = 200_000
MERGES = 20_000

ROWS, COLUMNS = 20_000, 256  # cells beyond are ignored and flagged: Solver keeps its settings at XFD1048550
CELL_LENGTH = 8_192  # of one formula or value: Excel's own limit of formulas
TEXT_LENGTH = 2_000  # longer texts are cut: no answer is that long

CPU_S = 20.0  # a file, of the reading process; the worst honest one, a coloured column of a million rows, needs 6
WALL_S, START_S = 120.0, 120.0  # generous: a busy machine must not fail a file; the clock alone counts on Windows
MEMORY_BYTES = 2**30
ANSWER_BYTES = 2**28  # of what the process says of a file
