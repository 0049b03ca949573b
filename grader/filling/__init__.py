"""What exports share: the record of a job, tables that keep their bytes, whose row is whose, points in words."""
