"""A sample of states with the durations that Ruckig finds.

    pip install ruckig==0.19.4
    python tests/jerk/sample.py 3000 > tests/jerk/sample.csv

One state in four each: all quantities around 1; limits within a factor of 10;
limits that are powers of 2 with states at 0, at a limit or half of it; limits
within a factor of 1000 with such states. Some targets are where the start is,
but for 1e-6 to 0.1, or where it leads at full jerk, which is where the fastest
way may become a much longer one. (Closer than that Ruckig's own tolerance of
1e-8 decides.) States that are left out have a target that only states outside
the limits lead to. The duration is empty where Ruckig finds no profile.
"""

import random
import sys

import ruckig

HEADER = "p0,v0,a0,p1,v1,a1,v_max,v_min,a_max,a_min,jerk,duration_s"


def rounded(x):
    return float(f"{x:.7g}")


def limit(rng, decades):
    return rounded(10 ** rng.uniform(-decades, decades))


def quantity(rng, low, high, special):
    if special and rng.random() < 0.4:
        return rng.choice([low, high, 0.0, low / 2, (low + high) / 4])
    return rng.uniform(low, high)


def state(rng, kind):
    special = kind >= 2
    decades = [0, 0.5, 0, 1.5][kind]
    speed, accel, jerk = (limit(rng, decades) for _ in range(3))
    if kind == 2:
        speed, accel, jerk = (rng.choice([0.5, 1.0, 2.0, 4.0]) for _ in range(3))
    slowest = -(speed if rng.random() < 0.5 else limit(rng, decades))
    braking = -(accel if rng.random() < 0.5 else limit(rng, decades))
    start, end = (
        [
            quantity(rng, -4.0, 4.0, special),
            quantity(rng, slowest, speed, special),
            quantity(rng, braking, accel, special),
        ]
        for _ in range(2)
    )
    if rng.random() < 0.4:
        end[2] = 0.0
    if rng.random() < 0.2:
        end[1] = 0.0
    near = rng.random()
    size = 10 ** rng.uniform(-6, -1)
    aside = [size * rng.choice([-1.0, 0.0, 1.0]) for _ in range(3)]
    if special and near < 0.1:
        end = [x + y for x, y in zip(start, aside)]
    elif special and near < 0.2:
        j = jerk if end[2] > start[2] else -jerk
        t = (end[2] - start[2]) / j
        end[1] = start[1] + start[2] * t + j * t * t / 2 + aside[1]
        end[0] = start[0] + start[1] * t + start[2] * t * t / 2 + j * t**3 / 6 + aside[0]
    end[1] = min(max(end[1], slowest), speed)
    end[2] = min(max(end[2], braking), accel)
    numbers = [rounded(x) for x in start + end + [speed, slowest, accel, braking, jerk]]
    before = numbers[4] - numbers[5] * abs(numbers[5]) / (2 * jerk)
    return numbers if slowest <= before <= speed else None


def duration(solver, numbers):
    task = ruckig.InputParameter(1)
    for name, number in zip(
        [
            "current_position",
            "current_velocity",
            "current_acceleration",
            "target_position",
            "target_velocity",
            "target_acceleration",
            "max_velocity",
            "min_velocity",
            "max_acceleration",
            "min_acceleration",
            "max_jerk",
        ],
        numbers,
    ):
        setattr(task, name, [number])
    found = ruckig.Trajectory(1)
    result = solver.calculate(task, found)
    good = result in (ruckig.Result.Working, ruckig.Result.Finished)
    return repr(found.duration) if good else ""


def main():
    count = int(sys.argv[1])
    rng = random.Random(1)
    solver = ruckig.Ruckig(1)
    print(HEADER)
    written = 0
    while written < count:
        numbers = state(rng, written % 4)
        if numbers is None:
            continue
        try:
            seconds = duration(solver, numbers)
        except ruckig.RuckigError:
            seconds = ""
        print(",".join([*map(repr, numbers), seconds]))
        written += 1


if __name__ == "__main__":
    main()
