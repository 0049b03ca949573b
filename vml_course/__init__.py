"""The Virtual Mechanics Laboratory: simulate, render, track and solve an impact."""
