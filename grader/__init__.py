"""Reading, judging and explaining what students hand in."""
