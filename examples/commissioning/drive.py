"""A drive that is put into service, simulated: makes the recordings of docs/commissioning.md.

    python3 examples/commissioning/drive.py examples/commissioning

A motor with a screw of 10 mm lead moves a table of 260 kg. Motor and screw have
0.0021 kg·m²; all as the slide sees it: 260 + 0.0021·(2π/0.01)² = 1089 kg. The screw has
50 N/µm and a play of 2 µm; the table swings on it at 69.8 Hz, damped by 0.03. Friction:
150 N and 600 N·s/m of the table, 0.15 N·m of the motor's bearings; 244 N in all. The motor
cogs by 0.06 N·m, 24 times a revolution. A torque constant of 0.58 N·m/A, at most 9 A, a
current loop of 0.5 ms, an encoder of 131072 counts a revolution, and currents that are
recorded in steps of 2 mA.
"""

import math
import random
import sys

STEP_S = 5e-5
LEAD_M = 0.01
RADIUS_M = LEAD_M / (2 * math.pi)
MOTOR_KG_M2, TABLE_KG = 0.0021, 260.0
STIFFNESS_N_M, DAMPING_N_S_M = 5e7, 2 * 0.03 * 260 * math.sqrt(5e7 / 260)
PLAY_M = 2e-6
TABLE_N, TABLE_N_S_M, MOTOR_NM = 150.0, 600.0, 0.15
COGGING_NM, COGS = 0.06, 24
TORQUE_NM_A, CURRENT_MAX_A, LAG_S = 0.58, 9.0, 5e-4
COUNTS = 131072
RESISTANCE_OHM, STANDBY_W = 0.3, 45.0


class Drive:
    """Motor (rad) and table (m) from rest, and the current that moves them."""

    def __init__(self):
        self.angle = self.speed = self.way = self.velocity = 0.0
        self.current = self.sum = 0.0

    def step(self, asked_a):
        asked_a = max(-CURRENT_MAX_A, min(CURRENT_MAX_A, asked_a))
        self.current += STEP_S / LAG_S * (asked_a - self.current)
        gap = self.angle * RADIUS_M - self.way
        pressed = gap - max(-PLAY_M / 2, min(PLAY_M / 2, gap))
        force = 0.0
        if pressed != 0.0:
            force = STIFFNESS_N_M * pressed
            force += DAMPING_N_S_M * (self.speed * RADIUS_M - self.velocity)
        torque = TORQUE_NM_A * self.current - force * RADIUS_M
        torque -= COGGING_NM * math.sin(COGS * self.angle)
        self.speed = rubbed(self.speed, torque, MOTOR_NM, MOTOR_KG_M2)
        free = force - TABLE_N_S_M * self.velocity
        self.velocity = rubbed(self.velocity, free, TABLE_N, TABLE_KG)
        self.angle += STEP_S * self.speed
        self.way += STEP_S * self.velocity

    def follow(self, way, velocity):
        """The current of a position loop with a speed loop in it."""
        wanted = velocity / RADIUS_M + 40.0 * (way / RADIUS_M - self.angle)
        error = wanted - self.speed
        self.sum += STEP_S * error
        return (0.35 * error + 6.0 * self.sum) / TORQUE_NM_A

    def power_w(self):
        """What the drive draws, with the losses of its winding."""
        current = self.current
        return (
            STANDBY_W
            + TORQUE_NM_A * current * self.speed
            + 1.5 * RESISTANCE_OHM * current * current
        )


def rubbed(speed, force, friction, mass):
    """The speed after a step, with friction that holds what it can."""
    free = speed + STEP_S * force / mass
    held = STEP_S * friction / mass
    return 0.0 if abs(free) <= held else free - math.copysign(held, free)


def strokes(acceleration, speeds, stroke_m):
    """Way and velocity at a time: to and fro at these speeds, with a short rest."""
    begin, parts, sign, at = 0.1, [], 1.0, 0.0
    for top in speeds:
        ramp_s = top / acceleration
        even_s = stroke_m / top - ramp_s
        parts.append((begin, sign, at, top, ramp_s, even_s))
        begin += 2 * ramp_s + even_s + 0.05
        at, sign = at + sign * stroke_m, -sign

    def motion(time_s):
        way = velocity = 0.0
        for begin, sign, at, top, ramp_s, even_s in parts:
            since = time_s - begin
            if since < 0:
                break
            up = min(since, ramp_s)
            even = min(max(since - ramp_s, 0.0), even_s)
            down = min(max(since - ramp_s - even_s, 0.0), ramp_s)
            velocity = sign * acceleration * (up - down)
            way = up * up / 2 + up * even + (up - down / 2) * down
            way = at + sign * acceleration * way
            if down >= ramp_s:
                velocity = 0.0
        return way, velocity

    return motion, begin + 0.1


def record(name, seconds, rate_hz, current_of, column="Iq"):
    """A table as drives export it: semicolons, decimal commas, no times."""
    random.seed(1)
    drive, every = Drive(), round(1 / (rate_hz * STEP_S))
    with open(name, "w", encoding="utf-8", newline="\n") as file:
        file.write(f"Trace of axis X\n{column} [A];Enc\n")
        for k in range(round(seconds / STEP_S)):
            asked = current_of(drive, k * STEP_S)
            if k % every == 0:
                counts = math.floor(drive.angle / (2 * math.pi) * COUNTS)
                amps = drive.current if column == "Iq" else asked
                amps = round((amps + random.gauss(0, 0.01)) / 0.002) * 0.002
                file.write(f"{amps:.3f};{counts}\n".replace(".", ","))
            drive.step(asked)


def moved(motion):
    return lambda drive, time_s: drive.follow(*motion(time_s))


def shaken(signal_nm, rate_hz, speed_m_s):
    """A signal on top of what keeps the axis at a speed; each value is held."""
    held = [-1, 0.0]

    def current(drive, time_s):
        at = int(time_s * rate_hz + 1e-6)
        if at != held[0]:
            lazy = 0.04 * (speed_m_s / RADIUS_M - drive.speed)
            drag = MOTOR_NM + (TABLE_N + TABLE_N_S_M * speed_m_s) * RADIUS_M
            value = signal_nm[min(at, len(signal_nm) - 1)]
            held[:] = [at, (value + lazy + drag) / TORQUE_NM_A]
        return held[1]

    return current


def log_power(name, motion, seconds):
    """Speed, acceleration and power every 4 ms, as means."""
    random.seed(1)
    drive, every = Drive(), 80
    with open(name, "w", encoding="utf-8", newline="\n") as file:
        file.write("x_velocity_mm_s,x_accel_mm_s2,x_power_w\n")
        mean, before = [0.0, 0.0], 0.0
        for k in range(1, round(seconds / STEP_S) + 1):
            drive.step(drive.follow(*motion(k * STEP_S)))
            mean[0] += drive.speed * RADIUS_M / every
            mean[1] += drive.power_w() / every
            if k % every == 0:
                now = drive.speed * RADIUS_M
                slope = (now - before) / (every * STEP_S)
                power = mean[1] + random.gauss(0, 4)
                file.write(f"{1e3 * mean[0]:.3f},{1e3 * slope:.1f},{power:.0f}\n")
                mean, before = [0.0, 0.0], now


def main():
    folder = sys.argv[1]
    speeds = [0.2, 0.2, 0.05, 0.05, 0.3, 0.3, 0.1, 0.1, 0.25, 0.25]
    motion, seconds = strokes(1.5, speeds, 0.08)
    record(f"{folder}/moves.txt", seconds, 500, moved(motion))
    log_power(f"{folder}/power.csv", motion, seconds)
    try:
        rows = open(f"{folder}/signal.csv", encoding="utf-8").read().split()[1:]
    except FileNotFoundError:
        print("signal.csv is not there yet: gwatt excite makes it")
        return
    signal = [float(row.split(",")[1]) * RADIUS_M for row in rows]
    record(f"{folder}/shaken.txt", len(signal) / 1000, 1000, shaken(signal, 1000, 0.01), "Iset")


main()
