#!/usr/bin/env python3
"""A program of so many blocks, the same each time: a surface milled line by line, with an arc and
rapids at the end of each line.

    benches/large_program.py 400000 > large.nc
"""
import math
import sys

LINE_MM, STEP_MM, ACROSS_MM = 200.0, 0.8, 0.5


def height(x, y):
    return -3.0 + 2.0 * math.sin(x / 17.0) * math.cos(y / 11.0)


def main():
    if len(sys.argv) != 2 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    left = int(sys.argv[1])
    out = sys.stdout
    out.write("G21 G90 G17\nM3 S12000\nG0 Z10\n")
    y = 0.0
    while left > 0:
        out.write(f"G0 X0 Y{y:.3f}\nG1 Z{height(0.0, y):.4f} F800\n")
        for point in range(1, int(LINE_MM / STEP_MM) + 1):
            x = point * STEP_MM
            feed = " F2400" if point == 1 else ""
            out.write(f"G1 X{x:.3f} Y{y:.3f} Z{height(x, y):.4f}{feed}\n")
        out.write(f"G2 X{LINE_MM:.3f} Y{y + 10.0:.3f} I0 J5\nG0 Z10\n")
        left -= int(LINE_MM / STEP_MM) + 4
        y += ACROSS_MM
    out.write("M5\nM30\n")


main()
