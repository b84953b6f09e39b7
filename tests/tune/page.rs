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
    check(&serde_json::from_slice(&output.stdout).unwrap());
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
