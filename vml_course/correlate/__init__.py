"""Kernels of digital image correlation: arrays in, arrays out."""
