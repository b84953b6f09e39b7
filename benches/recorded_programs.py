"""Random machines and programs for recorded.py."""

import math

# Letters of rotary axes.
ROTARY = "ABC"
# By axis: speed in mm/s (deg/s), acceleration in mm/s2 (deg/s2), mass in kg (kg m2), Coulomb
# friction in N (N m), viscous friction in N s/m (N m s/rad), weight in N (N m), efficiency.
FIELDS = ("rapid", "accel", "mass", "coulomb", "viscous", "weight", "efficiency")


def random_machine(rng, axes, uneven=False):
    """`uneven`: the axes are either light or heavy."""
    machine = {}
    for axis in axes:
        rotary = axis in ROTARY
        values = (rng.choice((60, 100, 150, 200, 300)), rng.choice((400, 1000, 1500, 2000, 3500)),
                  rng.uniform(0.5, 12) if rotary else rng.uniform(20, 600), rng.uniform(0, 40 if rotary else 400),
                  rng.choice((0, rng.uniform(0, 10 if rotary else 1000))), rng.uniform(-20, 20) if axis in "AB" else 0,
                  rng.choice((1.0, rng.uniform(0.7, 1.0))))
        machine[axis] = dict(zip(FIELDS, (float(f"{value:.6g}") for value in values)))
        if axis == "Z":
            machine[axis]["weight"] = float(rng.randrange(-300, 500))
        if uneven:
            machine[axis]["mass"] = rng.choice((1.0, 10.0) if axis in ROTARY else (20.0, 500.0))
    return machine


class Maker:
    """Writes a program piece by piece; it knows where the axes are and where they last went."""

    def __init__(self, rng, machine):
        self.rng, self.machine = rng, machine
        self.at = {axis: 0.0 for axis in machine}
        self.angle, self.feed, self.lines, self.seconds = 0.0, 3000, [], 0.0
        self.linear = [axis for axis in machine if axis not in ROTARY]
        self.rotary = [axis for axis in machine if axis in ROTARY]
        self.plane = (17, "X", "Y", "Z", "IJ")
        self.say(f"G21 G90 G17 G94 {self.mode()}")

    def say(self, text):
        self.lines.append(text)

    def mode(self):
        rng = self.rng
        tolerance = rng.choice((0.002, 0.01, 0.05, 0.1, 0.5, 2))
        return rng.choice(("G64", f"G64 P{tolerance}", f"G64 P{tolerance}", f"G64 P{tolerance} Q{tolerance / 4:.4f}", "G61", "G61.1"))

    def go(self, code, far, more=""):
        """A straight move by `far`, by axis; too far from zero it turns back."""
        words, times = [], [1e-9]
        for axis, way in far.items():
            if abs(self.at[axis] + way) > 150:
                way = -way
            there = round(self.at[axis] + way, 4)
            times.append(abs(there - self.at[axis]) / self.machine[axis]["rapid"])
            self.at[axis] = there
            words.append(f"{axis}{there:.4f}")
        length = math.hypot(*(way for axis, way in far.items() if axis in self.linear)) or max(map(abs, far.values()), default=0)
        self.seconds += max(times) + (0 if code == "G0" else length * 60 / self.feed)
        self.say(f"{code} {' '.join(words)}{more}")

    def some(self, reach, axes=None):
        """Ways of some of the axes."""
        axes = axes or self.linear
        chosen = self.rng.sample(axes, self.rng.randint(1, len(axes)))
        return {axis: self.rng.uniform(-reach, reach) for axis in chosen}

    def reach(self):
        return 10 ** self.rng.uniform(-0.7, 1.7)

    def ahead(self, length):
        _, first, second, _, _ = self.plane
        return {first: length * math.cos(self.angle), second: length * math.sin(self.angle)}

    def new_feed(self):
        self.feed = round(10 ** self.rng.uniform(2.8, 4.3))
        self.say(f"F{self.feed}")

    def new_mode(self):
        self.say(self.mode())

    def new_plane(self):
        planes = [plane for plane in ((17, "X", "Y", "Z", "IJ"), (18, "Z", "X", "Y", "KI"), (19, "Y", "Z", "X", "JK")) if plane[1] in self.at and plane[2] in self.at]
        self.plane = self.rng.choice(planes)
        self.say(f"G{self.plane[0]}")

    def rapids(self):
        for _ in range(self.rng.randint(1, 3)):
            self.go("G0", self.some(60))

    def sharp(self):
        reach = self.reach()
        for _ in range(self.rng.randint(2, 6)):
            self.go("G1", self.some(reach))

    def zigzag(self):
        step, first, second = self.reach(), *self.rng.sample(self.linear, 2)
        for row in range(self.rng.randint(2, 8)):
            self.go("G1", {first: step * 3 * (-1) ** row})
            self.go("G1", {second: step / 4})

    def collinear(self):
        ways = self.some(self.reach())
        for _ in range(self.rng.randint(2, 5)):
            scale = self.rng.uniform(0.05, 1)
            self.go("G1", {axis: way * scale for axis, way in ways.items()}, self.rng.choice(("", "", f" F{round(10 ** self.rng.uniform(2.8, 4))}")))
        self.say(f"F{self.feed}")

    def curve(self):
        length, turn = 10 ** self.rng.uniform(-0.7, 0.8), self.rng.uniform(-0.3, 0.3)
        for _ in range(self.rng.randint(5, 40)):
            self.angle += turn * self.rng.uniform(0.5, 1.5)
            self.go("G1", self.ahead(length))

    def arc(self):
        """An arc that goes on in the last direction or with a corner, often between lines;
        sometimes a helix or more than a turn."""
        rng, (_, first, second, third, centre) = self.rng, self.plane
        if rng.random() < 0.5:
            self.go("G1", self.ahead(self.reach()))
        if rng.random() < 0.4:
            self.angle += rng.uniform(-3, 3)
        radius, left = 10 ** rng.uniform(-0.3, 1.6), rng.random() < 0.5
        sweep = rng.choice((rng.uniform(0.1, 1), rng.uniform(1, 6), math.tau))
        side = 1 if left else -1
        offset = (round(-side * radius * math.sin(self.angle), 4), round(side * radius * math.cos(self.angle), 4))
        radius = math.hypot(*offset)
        middle = (self.at[first] + offset[0], self.at[second] + offset[1])
        begin = math.atan2(-offset[1], -offset[0])
        end = begin + side * sweep
        words = " ".join(f"{letter}{value:.4f}" for letter, value in zip(centre, offset))
        if sweep < math.tau:
            there = (round(middle[0] + radius * math.cos(end), 4), round(middle[1] + radius * math.sin(end), 4))
            words = f"{first}{there[0]:.4f} {second}{there[1]:.4f} {words}"
            self.at[first], self.at[second] = there
        if third in self.at and rng.random() < 0.3:
            self.at[third] = round(self.at[third] + rng.uniform(-0.5, 0.5) * radius * sweep * (-1 if self.at[third] > 0 else 1), 4)
            words += f" {third}{self.at[third]:.4f}"
        self.angle += side * sweep
        self.seconds += radius * sweep * 60 / self.feed
        self.say(f"G{3 if left else 2} {words}")
        if rng.random() < 0.5:
            self.go("G1", self.ahead(self.reach()))

    def fine(self):
        """Many short lines, on a line or a wide curve, then a long one: LinuxCNC's optimiser
        leaves some of the short ones at the speeds that they had as the last of its queue."""
        length, turn = self.rng.uniform(0.1, 0.6), self.rng.choice((0, 0.0005, 0.002))
        for _ in range(self.rng.randint(8, 60)):
            self.angle += turn
            self.go("G1", self.ahead(length))
        self.go("G1", self.ahead(self.rng.uniform(5, 50)))

    def bends(self):
        """Lines that hardly bend: LinuxCNC passes their joints as they are, with a step of speed."""
        length, turn = 10 ** self.rng.uniform(-0.3, 0.9), self.rng.choice((-1, 1)) * self.rng.uniform(0.0002, 0.0025)
        self.angle += self.rng.uniform(-3, 3)
        for _ in range(self.rng.randint(10, 60)):
            self.angle += turn * self.rng.choice((-0.5, 1, 1))
            self.go("G1", self.ahead(length))

    def dwell(self):
        self.say(f"G4 P{self.rng.choice((0, 0.02, 0.1))}")

    def word(self):
        self.say(self.rng.choice(("M8", "M9", "M62 P0", "M63 P0", "M64 P0", "M3 S1000", "M5", "T1", "(comment)")))

    def index(self):
        self.go(self.rng.choice(("G0", "G0", "G1")), self.some(90, self.rotary))

    def together(self):
        """Linear and rotary axes in the same blocks, some of them short."""
        reach, code = self.reach(), self.rng.choice(("G1", "G1", "G0"))
        ways = {**self.some(reach), **self.some(reach, self.rotary)}
        for _ in range(self.rng.randint(1, 12)):
            if self.rng.random() < 0.3:
                ways = {**self.some(reach), **self.some(reach, self.rotary)}
            self.go(code, {axis: way * self.rng.uniform(0.5, 1.0) for axis, way in ways.items()})

    def program(self, seconds, fine=False, bends=False):
        pieces = [self.rapids, self.sharp, self.zigzag, self.collinear, self.curve, self.curve, self.arc, self.arc, self.arc,
                  self.new_feed, self.new_feed, self.new_mode, self.new_plane, self.dwell, self.word]
        pieces += [self.index, self.together, self.together, self.together] if self.rotary else []
        pieces += [self.fine, self.fine] if fine else []
        pieces += [self.bends] * 10 if bends else []
        self.new_feed()
        while self.seconds < seconds:
            self.rng.choice(pieces)()
        self.go("G0", {"X": 10.0})
        self.say("M2")
        return "\n".join(self.lines) + "\n"
