//! gwatt as a filter of LinuxCNC: run as its user interfaces run filters, with the lines that
//! docs/linuxcnc.md gives for the INI file.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::{Ran, STEEP, Shop};

/// The filter of the INI file for an extension.
fn filter(shop: &Shop, extension: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/linuxcnc.md");
    let page = fs::read_to_string(page).unwrap();
    let (_, section) = page.split_once("[FILTER]\n").unwrap();
    let (section, _) = section.split_once("```").unwrap();
    let entry = format!("{extension} = ");
    let filter = section.lines().find_map(|line| line.strip_prefix(&entry));
    let shown = filter.unwrap();
    fs::copy(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("machine-configs/three-axis.toml"),
        shop.path().join("router.toml"),
    )
    .unwrap();
    let machine = shop.path().join("router.toml");
    let filter = shown.replacen("gwatt", env!("CARGO_BIN_EXE_gwatt"), 1);
    let filter = filter.replace("/home/cnc/router.toml", machine.to_str().unwrap());
    assert!(filter.contains(machine.to_str().unwrap()), "{shown}");
    filter
}

/// Runs a filter: `sh -c "FILTER 'FILE'"` without input, standard output into a file. Gives
/// what came, with the percentages and without their lines.
fn run(shop: &Shop, filter: &str, file: &str) -> (Ran, Vec<u32>) {
    let quoted = file.replace('\'', "'\\''");
    let into = shop.path().join("filtered");
    let output = Command::new("sh")
        .args(["-c", &format!("{filter} '{quoted}'")])
        .current_dir("/")
        .env("AXIS_PROGRESS_BAR", "1")
        .stdin(Stdio::null())
        .stdout(fs::File::create(&into).unwrap())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
        .wait_with_output()
        .unwrap();
    let mut ran = Ran::from(output);
    ran.stdout = fs::read_to_string(into).unwrap();
    let mut percentages = Vec::new();
    let mut said = String::new();
    for line in ran.stderr.lines() {
        match line.strip_prefix("FILTER_PROGRESS=") {
            Some(digits) => percentages.push(digits.parse().unwrap()),
            None => said = said + line + "\n",
        }
    }
    ran.stderr = said;
    (ran, percentages)
}

#[test]
fn a_program_is_limited_on_its_way() {
    let shop = Shop::new();
    shop.put("it's a part.ngc", STEEP);
    let file = shop.path().join("it's a part.ngc");
    let (ran, percentages) = run(&shop, &filter(&shop, "ngc"), file.to_str().unwrap());
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(ran.stderr.contains("certificate: "), "{}", ran.stderr);
    let other = shop.run(&["limit", "steep.ngc", "-m", "three-axis"]);
    assert_eq!(ran.stdout, other.stdout);
    assert_ne!(ran.stdout, STEEP);
    assert!(percentages.is_sorted(), "{percentages:?}");
    assert_eq!(percentages.first(), Some(&0));
    assert_eq!(percentages.last(), Some(&100));
    // The file itself stays.
    assert_eq!(shop.get("it's a part.ngc"), STEEP);
}

/// What LinuxCNC shows is the text on standard error, and nothing is opened.
#[test]
fn what_does_not_fit_is_not_opened() {
    let shop = Shop::new();
    shop.put("hard.nc", "G21 G90 G94\nG1 X200 Y200 Z200 F60000\nM30\n");
    let file = shop.path().join("hard.nc");
    let (ran, _) = run(&shop, &filter(&shop, "nc"), file.to_str().unwrap());
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert_eq!(ran.stdout, "");
    assert!(ran.stderr.contains("line 2"), "{}", ran.stderr);
    shop.put("wrong.nc", "G1 X\n");
    let file = shop.path().join("wrong.nc");
    let (ran, _) = run(&shop, &filter(&shop, "nc"), file.to_str().unwrap());
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("wrong.nc:1"), "{}", ran.stderr);
}

/// Asked for by name, the lines come without LinuxCNC; not asked for, they do not.
#[test]
fn progress_is_written_where_it_is_asked_for() {
    let shop = Shop::new();
    let check = |more: &[&'static str]| {
        shop.run(&[&["check", "gentle.ngc", "-m", "three-axis"], more].concat())
    };
    let asked = check(&["--progress", "linuxcnc"]);
    assert_eq!(asked.stderr, "FILTER_PROGRESS=0\nFILTER_PROGRESS=100\n");
    for more in [&[][..], &["--progress", "always"], &["--progress", "never"]] {
        assert_eq!(check(more).stderr, "", "{more:?}");
    }
    check(&["--progress", "sometimes"]).refused("possible values: auto, always, never, linuxcnc");
}
