//! The page with the responses, run by node and by Chromium.

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gwatt::identify::flexible::Method;
use gwatt::identify::tune::{Discretization, Parameters, Tuned, Wish, of_recording};
use gwatt::report::tune_page;
use serde_json::Value;

use super::{axis, pair, tuned, wish};
use crate::identify::{choice, one_side, recording};

/// A page with one axis from a file and one with a measured response.
fn page() -> String {
    let mut axes = vec![
        axis('X', &[(40.0, 0.03)]),
        axis('Y', &[(31.0, 0.03), (70.0, 0.02)]),
    ];
    "</script><b>&\"".clone_into(&mut axes[0].source);
    let recording = recording(&one_side(), 4.0, 0.05, 1);
    axes[1].measured = of_recording(&recording, 'Y', &choice(Method::Iv))
        .unwrap()
        .measured;
    axes[0].poles = vec![pair(45.0, 0.03)];
    let mut page = Vec::new();
    let shown = tuned(axes, wish(Discretization::Matched));
    tune_page(&shown, &mut page).unwrap();
    String::from_utf8(page).unwrap()
}

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/tune")
        .join(name)
}

/// Radius and speed of the page's test circle.
const RADIUS_MM: f64 = 20.0;
const FEED_MM_MIN: f64 = 3000.0;

/// Out of round, and smaller than programmed, µm, of a circle that has settled, by two gains
/// and phases.
fn circle([a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let distances: Vec<f64> = (0..720)
        .map(|k| {
            let t = TAU * f64::from(k) / 720.0;
            let x = RADIUS_MM * a[0] * libm::cos(t + a[1]);
            let y = RADIUS_MM * b[0] * libm::sin(t + b[1]);
            libm::hypot(x, y)
        })
        .collect();
    let most = distances.iter().copied().fold(0.0, f64::max);
    let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = distances.iter().sum::<f64>() / 720.0;
    [1e3 * (most - least), 1e3 * (RADIUS_MM - mean)]
}

/// The circle of a tuning as the page says it, without filters and with them.
fn circles(tuned: &Tuned) -> [String; 2] {
    let hz = FEED_MM_MIN / 60.0 / (TAU * RADIUS_MM);
    let says = |filtered: bool| {
        let axes = [0, 1].map(|index| {
            let plain = tuned.axes[index].follows().at_hz(hz);
            let filter = tuned.correction.at_hz(index, hz);
            let own = if filtered { plain * filter } else { plain };
            [own.norm(), libm::atan2(own.im, own.re)]
        });
        let [round, smaller] = circle(axes);
        let word = if smaller < 0.0 { "larger" } else { "smaller" };
        format!("{round:.2} µm out of round, {:.2} µm {word}", smaller.abs())
    };
    [says(false), says(true)]
}

/// What a script has found: curves were drawn again, what the page saves gwatt
/// reads, and what the page computes is what gwatt computes.
fn check(found: &Value) {
    assert_eq!(found["broken"], 0);
    assert!(found["redrawn"].as_u64().unwrap() >= 2);
    let read = Parameters::read(found["toml"].as_str().unwrap()).unwrap();
    assert_eq!(read.axes[0].zeros[0].omega_rad_s.value, 42.5 * TAU);
    assert_eq!(read.axes[0].zeros[0].damping.value, 0.03);
    // The slider at a half: times √2.
    assert!((read.axes[0].inertia.unwrap() - 100.0 * 2_f64.sqrt()).abs() < 1e-9);
    let wish = Wish {
        order: read.order,
        bandwidth_hz: read.bandwidth_hz,
        ..wish(Discretization::Matched)
    };
    let again = Tuned::new(read.axes, wish, 50.0).unwrap();
    let rows = found["rows"].as_array().unwrap().iter();
    let page_rows: Vec<Vec<String>> = rows
        .map(|row| {
            row.as_array()
                .unwrap()
                .iter()
                .map(|c| c.as_str().unwrap().to_owned())
                .collect()
        })
        .collect();
    if let Some(said) = found["circle"].as_str() {
        let [before, after] = circles(&again);
        assert!(
            said.contains(&format!(": {before} (grey)")),
            "{before}: {said}"
        );
        assert!(
            said.contains(&format!("with the filters {after} (green)")),
            "{after}: {said}"
        );
    }
    let mut ours = Vec::new();
    for (axis, filter) in again.axes.iter().zip(&again.correction.filters) {
        for (index, section) in filter.sections.iter().enumerate() {
            let mut row = vec![axis.letter.to_string(), (index + 1).to_string()];
            row.extend(section.coefficients().map(|c| format!("{c:.9}")));
            ours.push(row);
        }
    }
    assert_eq!(page_rows.len(), ours.len());
    for (page, ours) in page_rows.iter().zip(&ours) {
        assert_eq!(page[..2], ours[..2]);
        for (a, b) in page[2..].iter().zip(&ours[2..]) {
            let (a, b): (f64, f64) = (a.parse().unwrap(), b.parse().unwrap());
            assert!((a - b).abs() < 2e-9, "{page:?} {ours:?}");
        }
    }
}

#[test]
fn the_page_computes_redraws_and_saves() {
    let text = page();
    assert_eq!(text.matches("</script>").count(), 2);
    assert!(!text.contains("/*") && !text.contains("http://127"));
    assert!(text.matches("://").count() == text.matches("http://www.w3.org/2000/svg").count());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.html");
    fs::write(&path, text).unwrap();
    let Ok(output) = Command::new("node")
        .arg(script("page.js"))
        .arg(&path)
        .output()
    else {
        crate::evidence::cannot_run("there is no node");
        return;
    };
    crate::evidence::runs();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    check(&found);
    roots_come_and_go(&found);
}

/// Zeros were added and removed, the low-pass taken away and back: each time gwatt reads what is
/// saved, and designs filters from it.
fn roots_come_and_go(found: &Value) {
    let read = |key: &str| Parameters::read(found[key].as_str().unwrap()).unwrap();
    let designed = |key: &str| {
        let read = read(key);
        let wish = Wish {
            order: read.order,
            bandwidth_hz: read.bandwidth_hz,
            no_low_pass: read.no_low_pass,
            ..wish(Discretization::Matched)
        };
        Tuned::new(read.axes, wish, 50.0).unwrap()
    };
    assert_eq!(found["zeros"], 3);
    // Three zeros in the filter of Y: the low-pass has six poles.
    let added = designed("added");
    assert_eq!(added.axes[0].zeros.len(), 3);
    assert_eq!(read("added").order, Some(6));
    assert_eq!(added.correction.filters[1].numerator.len(), 3);
    assert!(read("plain").no_low_pass && read("plain").order.is_none());
    designed("plain");
    assert_eq!(read("back").order, Some(6));
    designed("back");
    let removed = designed("removed");
    assert_eq!(removed.axes[0].zeros.len(), 1);
    assert_eq!(removed.axes[0].poles.len(), 2);
    // Y was measured: how far its model is from that stands below the curves.
    let apart = found["apart"].as_array().unwrap();
    assert!(
        apart.len() == 1 && apart[0].as_str().unwrap().contains(" dB apart"),
        "{apart:?}"
    );
}

/// One axis alone: nothing to compare it with, and the circle has an ideal second axis.
#[test]
fn a_page_of_one_axis() {
    let shown = tuned(
        vec![axis('X', &[(40.0, 0.03)])],
        wish(Discretization::Matched),
    );
    let mut page = Vec::new();
    tune_page(&shown, &mut page).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.html");
    fs::write(&path, page).unwrap();
    let ran = Command::new("node")
        .arg(script("one_axis.js"))
        .arg(&path)
        .output();
    let Ok(output) = ran else {
        crate::evidence::cannot_run("there is no node");
        return;
    };
    crate::evidence::runs();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["headline"], "How X answers");
    let circle = found["circle"].as_str().unwrap();
    assert!(
        circle.starts_with("X with an ideal axis, 0.40 turns a second: "),
        "{circle}"
    );
    // The gain of X is 1 − (0.398/40)² = 1 − 0.0000990, so that its 40 mm of travel are 3.96 µm
    // short: 1.98 µm of radius at the ends of X, none at those of Y, 0.99 µm on the whole.
    assert!(circle.contains("0.99 µm smaller (grey)"), "{circle}");
    let note = found["note"].as_str().unwrap();
    assert!(
        note.contains("A filter has the zeros of the other axes"),
        "{note}"
    );
    Parameters::read(found["toml"].as_str().unwrap()).unwrap();
}

/// The page in a browser, wide and narrow.
#[test]
fn the_page_works_in_chromium() {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let is_there = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    let Some(browser) = names.into_iter().find(is_there) else {
        crate::evidence::cannot_run("there is no Chromium");
        return;
    };
    crate::evidence::runs();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.html");
    let probe = fs::read_to_string(script("browser.js")).unwrap();
    let text = page().replace("</body>", &format!("<script>\n{probe}</script>\n</body>"));
    fs::write(&path, text).unwrap();
    for size in ["1300,1600", "700,1600"] {
        let output = Command::new(browser)
            .args(["--headless=new", "--no-sandbox", "--disable-gpu"])
            .args(["--dump-dom", "--no-first-run"])
            .arg(format!("--window-size={size}"))
            .arg(format!(
                "--user-data-dir={}",
                folder.path().join("profile").display()
            ))
            .arg(format!("file://{}", path.display()))
            .output()
            .unwrap();
        let dom = String::from_utf8_lossy(&output.stdout);
        let left = dom
            .split_once("id=\"probe\">")
            .and_then(|(_, rest)| rest.split_once("</pre>"));
        let Some((left, _)) = left else {
            panic!("{dom}\n{}", String::from_utf8_lossy(&output.stderr));
        };
        let found: Value = serde_json::from_str(left).unwrap();
        check(&found);
        for key in ["outside", "overlaps", "outlined", "network", "wide"] {
            assert_eq!(found[key], 0, "{size}: {key}");
        }
        assert!(found["under_buttons"].as_f64().unwrap() >= 8.0, "{size}");
    }
}
