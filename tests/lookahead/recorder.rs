//! Runs programs on `LinuxCNC` without a display or a real-time kernel, on a machine of
//! any axes, and keeps what it puts out.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// An axis: letter, largest speed and acceleration, mm or degrees and s.
pub type AxisLimits = (char, [f64; 2]);

const BASE: &str = "[EMC]\nMACHINE = recorder\nVERSION = 1.1\nDEBUG = 0\n\
    [DISPLAY]\nDISPLAY = ./recorder.py\nPROGRAM_PREFIX = .\nMAX_FEED_OVERRIDE = 1.0\n\
    [TASK]\nTASK = milltask\nCYCLE_TIME = 0.001\n\
    [RS274NGC]\nPARAMETER_FILE = kept.var\nSUBROUTINE_PATH = .\n\
    [EMCMOT]\nEMCMOT = motmod\nCOMM_TIMEOUT = 10.0\nSERVO_PERIOD = 1000000\n\
    [HAL]\nHALFILE = recorder.hal\n\
    [EMCIO]\nEMCIO = io\nCYCLE_TIME = 0.005\nTOOL_TABLE = tools.tbl\n";
const TRAJECTORY: &str = "LINEAR_UNITS = mm\nANGULAR_UNITS = degree\nNO_FORCE_HOMING = 1\n\
    DEFAULT_LINEAR_VELOCITY = 50\nMAX_LINEAR_VELOCITY = 10000\n\
    DEFAULT_ANGULAR_VELOCITY = 50\nMAX_ANGULAR_VELOCITY = 10000\n\
    DEFAULT_LINEAR_ACCELERATION = 1000\nMAX_LINEAR_ACCELERATION = 1000000\n";
const HAL: &str = "loadrt [KINS]KINEMATICS\n\
    loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS num_aio=8 num_dio=8\n\
    loadrt sim_spindle names=turner\n\
    addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n\
    net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n\
    net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n\
    net change iocontrol.0.tool-change => iocontrol.0.tool-changed\n";

/// Whether `LinuxCNC` is there.
pub fn is_installed() -> bool {
    let found = Command::new("sh")
        .args(["-c", "command -v linuxcnc"])
        .output();
    found.is_ok_and(|output| output.status.success())
}

fn configuration(axes: &[AxisLimits]) -> String {
    let letters: String = axes.iter().map(|(letter, _)| *letter).collect();
    let mut text = format!(
        "{BASE}[KINS]\nKINEMATICS = trivkins coordinates={letters}\nJOINTS = {}\n\
         [TRAJ]\nCOORDINATES = {letters}\n{TRAJECTORY}",
        axes.len()
    );
    for (joint, (letter, [speed, accel])) in axes.iter().enumerate() {
        let kind = if "ABC".contains(*letter) {
            "ANGULAR"
        } else {
            "LINEAR"
        };
        let limits = format!(
            "MIN_LIMIT = -100000\nMAX_LIMIT = 100000\nMAX_VELOCITY = {speed}\nMAX_ACCELERATION = {accel}\n"
        );
        let _ = write!(
            text,
            "[AXIS_{letter}]\n{limits}[JOINT_{joint}]\nTYPE = {kind}\nHOME = 0\nHOME_SEQUENCE = 0\n\
             {limits}FERROR = 10000\nMIN_FERROR = 10000\n"
        );
    }
    text
}

/// Line and speeds of all axes in each cycle.
fn hal(axes: usize) -> String {
    let mut text = format!(
        "{HAL}loadrt sampler depth=40000 cfg=s{}\n",
        "f".repeat(axes)
    );
    text += "addf sampler.0 servo-thread\naddf turner servo-thread\nsetp sampler.0.enable 0\n";
    text += "net line motion.program-line => sampler.0.pin.0\n";
    for joint in 0..axes {
        let _ = writeln!(
            text,
            "net at-{joint} joint.{joint}.motor-pos-cmd => joint.{joint}.motor-pos-fb"
        );
        let pin = joint + 1;
        let _ = writeln!(
            text,
            "net speed-{joint} joint.{joint}.vel-cmd => sampler.0.pin.{pin}"
        );
    }
    text
}

/// Speeds of the axes in each millisecond of each program; nothing where it failed.
pub fn record(axes: &[AxisLimits], programs: &[String], speedup: u32) -> Vec<Vec<Vec<f64>>> {
    record_with(axes, programs, speedup, "")
}

/// The same with further lines of HAL, once all pins exist.
pub fn record_with(
    axes: &[AxisLimits],
    programs: &[String],
    speedup: u32,
    further: &str,
) -> Vec<Vec<Vec<f64>>> {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| std::fs::write(at(name), text).expect("a file");
    write("recorder.ini", &configuration(axes));
    write("recorder.hal", &hal(axes.len()));
    write("further.hal", further);
    write("recorder.py", include_str!("recorder.py"));
    write("kept.var", "");
    write("tools.tbl", "T1 P1 D6 Z10\n");
    let mut jobs = String::new();
    for (index, program) in programs.iter().enumerate() {
        write(&format!("{index}.ngc"), program);
        let path = |kind: &str| at(&format!("{index}.{kind}")).display().to_string();
        let _ = writeln!(jobs, "{} {}", path("ngc"), path("out"));
    }
    write("jobs", &jobs);
    let letters: String = axes.iter().map(|(letter, _)| *letter).collect();
    // It gives its rights up, and refuses those of root.
    let opened = "chmod 777 . && chmod -R a+rX . && chmod +x recorder.py && exec timeout -k 20 580 linuxcnc -r recorder.ini";
    let mut command = Command::new("sh");
    command
        .args(["-c", opened])
        .current_dir(folder.path())
        .env("HOME", folder.path())
        .env("RTAPI_UID", "65534")
        .env("RECORD_JOBS", at("jobs"))
        .env("RECORD_AXES", letters)
        .env_remove("DISPLAY")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    if let Some(library) = faketime() {
        command
            .env("LD_PRELOAD", library)
            .env("FAKETIME", format!("+0 x{speedup}"))
            .env("FAKETIME_NO_CACHE", "0")
            .env("DONT_FAKE_MONOTONIC", "0");
    }
    let _ = command.status();
    let recording = |index: usize| std::fs::read_to_string(at(&format!("{index}.out")));
    let all = 0..programs.len();
    all.map(|index| speeds(&recording(index).unwrap_or_default(), axes.len()))
        .collect()
}

/// The library that lets time run faster, if it is installed.
fn faketime() -> Option<PathBuf> {
    let folders = std::fs::read_dir("/usr/lib").ok()?;
    let mut paths = folders
        .flatten()
        .map(|entry| entry.path().join("faketime/libfaketimeMT.so.1"));
    paths.find(|path: &PathBuf| Path::exists(path))
}

/// The rows of a recording: its number of the cycle, line and speeds.
fn speeds(text: &str, axes: usize) -> Vec<Vec<f64>> {
    let rows = text.lines().map(|line| {
        let cells = line.split_whitespace().map_while(|cell| cell.parse().ok());
        cells.skip(2).collect::<Vec<f64>>()
    });
    rows.filter(|row| row.len() == axes).collect()
}
