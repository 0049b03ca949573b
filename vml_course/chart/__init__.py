"""Small pictures as lines and words: axes, shapes, and what turns them into SVG or PNG."""
