"""Reference runs of the period planner: tests/period/reference.csv.

Below the base speed they are Ruckig's velocity control (0.19.4), planned again
from its own state where the target changes. Through and above the base speed
they are a simulation in steps of 1 us of the rule: as much acceleration as
limit and jerk allow, and -J as soon as the landing asks for it.

    python reference.py > reference.csv
"""
from ruckig import ControlInterface, InputParameter, Result, Ruckig, Trajectory

A, V_F, J = 2000.0, 1000.0, 20000.0
PERIOD = 1e-3
EVERY = 10  # periods between the rows that are kept


def ruckig_run(changes, end):
    """States at every period; changes are (period, target)."""
    states, state = [], (0.0, 0.0)
    otg = Ruckig(1)
    for (at, target), (until, _) in zip(changes, changes[1:] + [(end, 0)]):
        inp = InputParameter(1)
        inp.control_interface = ControlInterface.Velocity
        inp.current_position, inp.current_velocity, inp.current_acceleration = [0.0], [state[0]], [state[1]]
        inp.target_velocity, inp.target_acceleration = [target], [0.0]
        inp.max_velocity, inp.max_acceleration, inp.max_jerk = [1e9], [A], [J]
        trajectory = Trajectory(1)
        assert otg.calculate(inp, trajectory) in (Result.Working, Result.Finished)
        for period in range(until - at + 1):
            _, v, a = trajectory.at_time(period * PERIOD)
            state = (v[0], a[0])
            if period > 0:
                states.append(state)
    return [(0.0, 0.0)] + states


def limit(v):
    return A * min(1.0, V_F / abs(v)) if v else A


def simulated_run(changes, end):
    """The rule in small steps; speeds and targets above 0, no reversal of v."""
    fine = 1000
    dt = PERIOD / fine
    v = a = 0.0
    states = [(v, a)]
    changes = dict(changes)
    for period in range(end):
        target = changes.get(period, None) if period in changes else target
        for _ in range(fine):
            e = J * (target - v) - 0.5 * a * abs(a)
            side = 1.0 if e > 0 else -1.0
            # Towards the target; never more than it takes to land.
            want = a + side * J * dt
            if side * want > limit(v + want * dt):
                want = side * max(limit(v + want * dt), side * a - J * dt)
            v2 = v + 0.5 * (a + want) * dt
            e2 = J * (target - v2) - 0.5 * want * abs(want)
            if e2 * side < 0:
                want = a - side * J * dt
                if a * side <= J * dt and abs(target - v) < 2 * J * dt * dt:
                    v2, want = target, 0.0
                else:
                    v2 = v + 0.5 * (a + want) * dt
            v, a = v2, want
        states.append((v, a))
    return states


RUNS = [
    ("start", ruckig_run, [(0, 900.0)], 600),
    ("short", ruckig_run, [(0, 100.0)], 200),
    ("up", ruckig_run, [(0, 500.0), (150, 900.0)], 600),
    ("down", ruckig_run, [(0, 900.0), (250, 300.0)], 700),
    ("reversal", ruckig_run, [(0, 900.0), (600, -900.0)], 1650),
    ("small_reversal", ruckig_run, [(0, 40.0), (130, -40.0)], 300),
    ("through", simulated_run, [(0, 3000.0)], 2700),
    ("power_up", simulated_run, [(0, 2000.0), (900, 3000.0)], 2700),
    ("power_down", simulated_run, [(0, 3000.0), (1500, 1500.0)], 2700),
]
print("run,period,speed,accel,jerk")
for name, run, changes, end in RUNS:
    states = run(changes, end)
    for period in range(EVERY, len(states), EVERY):
        (v, a), (_, before) = states[period], states[period - 1]
        print(f"{name},{period},{v:.6f},{a:.6f},{(a - before) / PERIOD:.3f}")
