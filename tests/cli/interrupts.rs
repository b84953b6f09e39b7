//! Runs that are interrupted: what they leave on the disk.

use std::fmt::Write as _;
use std::io::{Read, Write as _};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use super::Shop;
use super::progress::screen;

/// Sends a signal by its name.
fn signal(child: &Child, name: &str) {
    let killed = Command::new("kill")
        .args([format!("-{name}"), child.id().to_string()])
        .status();
    // It may be through already.
    killed.unwrap();
}

/// Whenever it is interrupted, the output is the old one or the whole new one, and
/// nothing lies next to it: where files need no name until they are whole, after a kill
/// too.
#[test]
fn an_interrupted_run_leaves_nothing() {
    let shop = Shop::new();
    let mut program = String::from("G21 G90 G94 G17\n");
    for number in 0..6000 {
        let at = 200 + number % 2;
        writeln!(program, "G0 X{at} Y200 Z{at}\nG0 X0 Y0 Z0").unwrap();
    }
    shop.put("long.ngc", &program);
    let run = ["limit", "long.ngc", "-o", "out.ngc"];
    let whole = shop.command(&run).output().unwrap();
    assert!(whole.status.success(), "{whole:?}");
    let whole = shop.get("out.ngc");
    shop.put("out.ngc", "M30\n");
    let files = shop.files();
    let killed = if cfg!(target_os = "linux") {
        ["INT", "TERM", "KILL"].as_slice()
    } else {
        ["INT", "TERM"].as_slice()
    };
    let (mut interrupted, mut left) = (0, 0);
    for round in 0..8_u64 {
        for name in killed {
            let mut child = shop.command(&run).stderr(Stdio::null()).spawn().unwrap();
            sleep(Duration::from_millis(5 + 31 * round));
            signal(&child, name);
            let status = child.wait().unwrap();
            interrupted += u32::from(status.code().is_none());
            if *name == "KILL" && shop.files() != files {
                // Between its name and its place there are some microseconds.
                left += 1;
                continue;
            }
            assert_eq!(shop.files(), files, "{name} in round {round}");
            let out = shop.get("out.ngc");
            assert!(out == "M30\n" || out == whole, "{name} in round {round}");
            shop.put("out.ngc", "M30\n");
        }
    }
    assert!(interrupted >= 3, "{interrupted}");
    assert!(left <= 1, "{left}");
    // What was left is gone with the next run.
    assert!(shop.command(&run).output().unwrap().status.success());
    assert_eq!(shop.files(), files);
}

/// Ctrl-C on a terminal takes the bar away, and the output is as it was.
#[test]
fn ctrl_c_takes_the_bar_away() {
    if ignores_ctrl_c() {
        // What runs in the background ignores it, and so does all that it starts.
        eprintln!("skipped: Ctrl-C is ignored here");
        return;
    }
    let shop = Shop::new();
    let mut program = String::from("G21 G90 G94 G17\n");
    for number in 0..40_000 {
        let at = 200 + number % 2;
        writeln!(program, "G0 X{at} Y200 Z{at}\nG0 X0 Y0 Z0").unwrap();
    }
    shop.put("long.ngc", &program);
    shop.put("out.ngc", "M30\n");
    let files = shop.files();
    // `script` may end before it has read all that the terminal got last.
    let cleared = (0..5).any(|_| {
        let Some(seen) = interrupted_on_a_terminal(&shop) else {
            eprintln!("skipped: no terminal can be made by `script`");
            return true;
        };
        assert_eq!(shop.files(), files);
        assert_eq!(shop.get("out.ngc"), "M30\n");
        screen(&seen).replace("^C", "").is_empty()
    });
    assert!(cleared);
}

/// Whether this process was started with SIGINT ignored.
fn ignores_ctrl_c() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 0b10 != 0)
}

/// What a terminal has shown of a run that Ctrl-C has ended once its bar was there.
fn interrupted_on_a_terminal(shop: &Shop) -> Option<String> {
    let gwatt = env!("CARGO_BIN_EXE_gwatt");
    let line = format!("{gwatt} limit long.ngc -m three-axis -o out.ngc --progress always");
    let mut child = Command::new("script")
        .args(["-qec", &line, "/dev/null"])
        .current_dir(shop.path())
        .env("TERM", "xterm")
        .env_remove("AXIS_PROGRESS_BAR")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .ok()?;
    let (mut keys, mut shown) = (child.stdin.take()?, child.stdout.take()?);
    let (mut seen, mut part, mut pressed) = (Vec::new(), [0; 4096], false);
    while let Ok(count @ 1..) = shown.read(&mut part) {
        seen.extend_from_slice(&part[..count]);
        if !pressed && String::from_utf8_lossy(&seen).contains("pass 1 [") {
            keys.write_all(b"\x03").unwrap();
            keys.flush().unwrap();
            pressed = true;
        }
    }
    let status = child.wait().unwrap();
    let seen = String::from_utf8(seen).unwrap();
    assert!(pressed, "{seen:?}");
    // 128 and the number of SIGINT, as of every program that it ends.
    assert_eq!(status.code(), Some(130), "{seen:?}");
    Some(seen)
}
