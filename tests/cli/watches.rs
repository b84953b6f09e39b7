//! `gwatt watch`: what appears in the folder of results, and what goes.

use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::{thread::sleep, time::Duration};

use super::{GENTLE, Ran, STEEP, Shop};

/// Does not fit without `--allow feed`.
const HARD: &str = "G21 G90 G94\nG1 X200 Y200 Z200 F60000\nM30\n";

/// A shop with a folder `in`.
fn shop() -> Shop {
    let shop = Shop::new();
    fs::create_dir_all(shop.path().join("in/b")).unwrap();
    shop
}

/// What lies in `out` and below.
fn results(shop: &Shop) -> Vec<String> {
    fn below(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                below(&path, found);
            } else {
                found.push(path);
            }
        }
    }
    let out = shop.path().join("out");
    let mut found = Vec::new();
    below(&out, &mut found);
    let names = found.iter().map(|path| path.strip_prefix(&out).unwrap());
    let mut names: Vec<String> = names.map(|it| it.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

const NOW: [&str; 8] = [
    "watch",
    "in",
    "out",
    "-m",
    "three-axis",
    "--now",
    "--settle",
    "0",
];

fn now(shop: &Shop, more: &[&str]) -> Ran {
    shop.run(&[&NOW[..], more].concat())
}

#[test]
fn what_lies_there_is_limited_or_refused() {
    let shop = shop();
    shop.put("in/steep.ngc", STEEP);
    shop.put("in/b/gentle.nc", GENTLE);
    shop.put("in/hard.nc", HARD);
    shop.put("in/broken.nc", "G1 X\n");
    shop.put("in/notes.txt", "remember the milk\n");
    shop.put("in/.hidden.nc", GENTLE);
    let ran = now(&shop, &[]);
    assert_eq!(ran.code, 2, "{}", ran.stderr);
    assert_eq!(ran.stdout, "");
    let totals = "4 programs: 2 fit, 1 does not, 1 is not read";
    assert_eq!(ran.stderr.lines().last(), Some(totals));
    assert_eq!(
        results(&shop),
        [
            "b/gentle.nc",
            "b/gentle.nc.certificate.txt",
            "b/gentle.nc.csv",
            "broken.nc.refused.txt",
            "hard.nc.refused.txt",
            "steep.ngc",
            "steep.ngc.certificate.txt",
            "steep.ngc.csv",
        ]
    );
    // As `limit` writes them.
    let limited = shop.run(&[
        "limit",
        "in/steep.ngc",
        "-m",
        "three-axis",
        "--report",
        "r.csv",
    ]);
    assert_eq!(shop.get("out/steep.ngc"), limited.stdout);
    assert_eq!(shop.get("out/steep.ngc.certificate.txt"), limited.stderr);
    assert_eq!(shop.get("out/steep.ngc.csv"), shop.get("r.csv"));
    assert_eq!(shop.get("out/b/gentle.nc"), GENTLE);
    let why = shop.get("out/broken.nc.refused.txt");
    assert!(why.contains("in/broken.nc:1"), "{why}");
    let why = shop.get("out/hard.nc.refused.txt");
    assert!(why.contains("cannot be made to fit"), "{why}");
}

/// Nobody runs an old version: neither where the new one does not fit, nor where it cannot
/// be read.
#[test]
fn old_results_are_removed() {
    let shop = shop();
    for bad in [HARD, "G1 X\n"] {
        shop.put("in/part.nc", STEEP);
        assert_eq!(now(&shop, &["-q"]).code, 0);
        let fit = ["part.nc", "part.nc.certificate.txt", "part.nc.csv"];
        assert_eq!(results(&shop), fit);
        shop.put("in/part.nc", bad);
        let ran = now(&shop, &["-q"]);
        assert_ne!(ran.code, 0);
        let removed = "out/part.nc is removed: it was limited from an earlier version";
        assert!(ran.stderr.contains(removed), "{}", ran.stderr);
        assert_eq!(results(&shop), ["part.nc.refused.txt"]);
        assert!(shop.get("out/part.nc.refused.txt").contains(removed));
    }
    // With another permission it fits.
    shop.put("in/part.nc", HARD);
    let ran = now(&shop, &["--allow", "feed", "-q"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(ran.stderr, "1 program: 1 fits, 0 do not, 0 are not read\n");
    assert_eq!(results(&shop).len(), 3);
}

#[test]
fn what_cannot_be_watched_is_refused() {
    let shop = shop();
    let watch = |from, into, more: &[&'static str]| {
        let usual = ["watch", from, into, "-m", "three-axis", "--now"];
        shop.run(&[&usual[..], more].concat())
    };
    watch("none", "out", &[]).refused("none is no folder");
    watch("steep.ngc", "out", &[]).refused("steep.ngc is no folder");
    watch("in", "in/out", &[]).refused("in and in/out lie in one another");
    watch("in", "in", &[]).refused("lie in one another");
    watch("in/b", "in", &[]).refused("lie in one another");
    watch("in", "steep.ngc", &[]).refused("cannot make the folder steep.ngc");
    watch("in", "out", &["--settle=-1"]).refused("a time in s, from 0 to 3600");
    watch("in", "out", &["--preset-else", "speed"]).refused("--strategy preset");
    shop.put("in/b/gwatt.toml", "");
    watch("in", "out", &[]).refused("in/b has settings of its own (gwatt.toml)");
}

/// A program that calls another one says so in its certificate.
#[test]
fn what_is_called_is_named() {
    let shop = shop();
    shop.put("in/main.nc", "G21 G90 G94\nM98 P77\nM30\n");
    shop.put("in/0077.nc", "O77\nG1 X10 F100\nM99\n");
    let fanuc = Path::new(env!("CARGO_MANIFEST_DIR")).join("machine-configs/three-axis.toml");
    let text = fs::read_to_string(fanuc).unwrap();
    shop.put(
        "mill.toml",
        text.replace("controller = \"iso\"", "controller = \"fanuc\""),
    );
    let run = [
        "watch",
        "in",
        "out",
        "-m",
        "mill.toml",
        "--now",
        "--settle=0",
        "-q",
    ];
    let ran = shop.run(&run);
    let refused = shop.path().join("out/main.nc.refused.txt");
    assert!(
        !refused.exists(),
        "{}",
        fs::read_to_string(refused).unwrap()
    );
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let said = shop.get("out/main.nc.certificate.txt");
    assert!(
        said.contains("in/main.nc: it is certified with in/0077.nc as"),
        "{said}"
    );
}

/// The settings of the folder count, and those of its subfolders are the same.
#[test]
fn settings_of_the_folder_count() {
    let shop = shop();
    shop.put(
        "in/gwatt.toml",
        "machine = \"three-axis\"\nallow = [\"feed\"]\n",
    );
    shop.put("in/b/hard.nc", HARD);
    let ran = shop.run(&["watch", "in", "out", "--now", "--settle", "0"]);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(shop.path().join("out/b/hard.nc").exists());
}

/// A run that goes on.
#[cfg(unix)]
struct Watch<'a> {
    shop: &'a Shop,
    child: std::process::Child,
}

#[cfg(unix)]
impl<'a> Watch<'a> {
    fn begin(shop: &'a Shop, machine: &str) -> Self {
        let child = shop
            .command(&["watch", "in", "out", "-m", machine, "--settle", "0.2"])
            .stderr(fs::File::create(shop.path().join("said")).unwrap())
            .spawn()
            .unwrap();
        Self { shop, child }
    }

    /// Waits until something holds.
    #[track_caller]
    fn until(&self, what: &str, holds: impl Fn() -> bool) {
        for _ in 0..3000 {
            if holds() {
                return;
            }
            sleep(Duration::from_millis(20));
        }
        panic!(
            "{what}: {:?}\n{}",
            results(self.shop),
            self.shop.get("said")
        );
    }

    /// Interrupts it; it ends by the signal.
    fn interrupt(mut self) {
        use std::os::unix::process::ExitStatusExt;
        let id = self.child.id().to_string();
        let killed = std::process::Command::new("kill")
            .args(["-TERM", &id])
            .status();
        assert!(killed.unwrap().success());
        assert_eq!(self.child.wait().unwrap().signal(), Some(15));
    }
}

#[cfg(unix)]
impl Drop for Watch<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A program that comes in pieces, then changes, then goes: what is written is always of a
/// whole one.
#[cfg(unix)]
#[test]
fn a_folder_is_watched_until_it_is_interrupted() {
    use std::io::Write as _;
    let shop = shop();
    let watch = Watch::begin(&shop, "three-axis");
    let out = |name: &str| shop.path().join("out").join(name);
    // In pieces, the first of which is no program yet.
    let mut file = fs::File::create(shop.path().join("in/part.nc")).unwrap();
    let (first, second) = STEEP.split_at(30);
    file.write_all(first.as_bytes()).unwrap();
    sleep(Duration::from_millis(50));
    file.write_all(second.as_bytes()).unwrap();
    drop(file);
    let limited = shop.run(&["limit", "steep.ngc", "-m", "three-axis"]).stdout;
    let is = |name: &str, text: &str| fs::read_to_string(out(name)).is_ok_and(|it| it == text);
    watch.until("the program", || {
        is("part.nc", &limited) && out("part.nc.certificate.txt").exists()
    });
    // An editor writes another file and renames it.
    shop.put("in/part.nc.new", HARD);
    let at = |name: &str| shop.path().join("in").join(name);
    fs::rename(at("part.nc.new"), at("part.nc")).unwrap();
    watch.until("refused", || {
        out("part.nc.refused.txt").exists() && !out("part.nc").exists()
    });
    // It fits again.
    shop.put("in/part.nc", GENTLE);
    watch.until("fits again", || {
        is("part.nc", GENTLE) && !out("part.nc.refused.txt").exists()
    });
    // A call of what is not there yet.
    shop.put("in/b/main.nc", "G21 G90 G94\nM98 P77\nM30\n");
    watch.until("no subprogram", || out("b/main.nc.refused.txt").exists());
    fs::remove_file(at("part.nc")).unwrap();
    watch.until("gone", || shop.get("said").contains("in/part.nc is gone"));
    assert!(out("part.nc").exists());
    watch.interrupt();
    assert_eq!(
        results(&shop),
        [
            "b/main.nc.refused.txt",
            "part.nc",
            "part.nc.certificate.txt",
            "part.nc.csv",
        ]
    );
}

/// What is written belongs to the machine file as it was at the start.
#[cfg(unix)]
#[test]
fn another_machine_file_ends_the_run() {
    let shop = shop();
    let machine = Path::new(env!("CARGO_MANIFEST_DIR")).join("machine-configs/three-axis.toml");
    let machine = fs::read_to_string(machine).unwrap();
    shop.put("mill.toml", &machine);
    shop.put("in/part.nc", STEEP);
    let mut watch = Watch::begin(&shop, "mill.toml");
    watch.until("the program", || shop.path().join("out/part.nc").exists());
    shop.put("mill.toml", machine + "\n# more\n");
    // What appears has it look at once.
    shop.put("in/other.nc", GENTLE);
    assert_eq!(watch.child.wait().unwrap().code(), Some(2));
    let said = shop.get("said");
    assert!(
        said.contains("mill.toml has changed: start `gwatt watch` again"),
        "{said}"
    );
}
