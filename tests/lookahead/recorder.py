#!/usr/bin/python3
"""Stands in for LinuxCNC's display: runs programs one by one, each from 0, and keeps
every servo cycle of each.

  RECORD_JOBS   a line for each program: its path, and that of the recording
  RECORD_AXES   letters of the axes
"""
import os
import subprocess
import time

import linuxcnc

axes = os.environ["RECORD_AXES"]
jobs = [line.split() for line in open(os.environ["RECORD_JOBS"])]
command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
failed = False


def halcmd(*words):
    return subprocess.run(["halcmd", *words], capture_output=True, text=True, check=True).stdout


def poll():
    global failed
    status.poll()
    while (message := errors.poll()) is not None:
        failed |= message[0] in (linuxcnc.OPERATOR_ERROR, linuxcnc.NML_ERROR)


def wait(done, seconds=20.0):
    end = time.monotonic() + seconds
    while True:
        poll()
        if done():
            return
        if time.monotonic() > end:
            raise TimeoutError
        time.sleep(0.01)


def mode(which):
    command.mode(which)
    command.wait_complete()


def prepare():
    mode(linuxcnc.MODE_MDI)
    at_zero = " ".join(axis + "0" for axis in axes)
    for line in (
        "G21 G90 G94 G97 G40 G49 G80 G64 P0.0254 Q0 M5 M9",
        "G92.1",
        "G10 L2 P1 " + at_zero,
        "G0 " + at_zero,
    ):
        command.mdi(line)
        command.wait_complete(60)
    mode(linuxcnc.MODE_AUTO)


def run(program, recording):
    global failed
    prepare()
    failed = False
    command.program_open(program)
    command.wait_complete()
    wait(lambda: status.file == program)
    with open(recording + ".part", "w") as out:
        sampler = subprocess.Popen(["halsampler", "-t"], stdout=out)
        time.sleep(0.1)
        halcmd("setp", "sampler.0.enable", "1")
        command.auto(linuxcnc.AUTO_RUN, 0)
        wait(lambda: status.interp_state != linuxcnc.INTERP_IDLE or failed, 5.0)
        still = 0
        end = time.monotonic() + 120
        while still < 5 and time.monotonic() < end:
            poll()
            idle = status.interp_state == linuxcnc.INTERP_IDLE and status.inpos
            still = still + 1 if idle and status.queue == 0 else 0
            time.sleep(0.01)
        halcmd("setp", "sampler.0.enable", "0")
        time.sleep(0.1)
        sampler.terminate()
        sampler.wait()
    if still == 5 and not failed and halcmd("getp", "sampler.0.overruns").strip() == "0":
        os.rename(recording + ".part", recording)


for _ in range(400):
    try:
        status.poll()
        break
    except linuxcnc.error:
        time.sleep(0.05)
command.state(linuxcnc.STATE_ESTOP_RESET)
wait(lambda: status.task_state != linuxcnc.STATE_ESTOP)
command.state(linuxcnc.STATE_ON)
wait(lambda: status.task_state == linuxcnc.STATE_ON)
mode(linuxcnc.MODE_MANUAL)
command.teleop_enable(0)
command.wait_complete()
command.home(-1)
wait(lambda: all(status.homed[: status.joints]))
halcmd("-i", "recorder.ini", "-f", "further.hal")
for program, recording in jobs:
    try:
        run(program, recording)
    except (TimeoutError, subprocess.CalledProcessError):
        command.abort()
        command.wait_complete()
