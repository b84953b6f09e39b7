//! Recordings as drives and controls export them.

use std::fmt::Write as _;

use gwatt::identify::rigid::{self, Friction};
use gwatt::identify::{ReadAs, Recording};

use super::PERIOD_S;

const SAMPLES: usize = 3000;

/// Time, force and position of 50 kg with 100 N·s/m and 20 N.
fn rows() -> Vec<[f64; 3]> {
    let row = |k: usize| {
        let t = k as f64 * PERIOD_S;
        let (sin, cos) = libm::sincos(10.0 * t);
        let (sin2, cos2) = libm::sincos(31.0 * t);
        let x = 0.02 * sin + 0.004 * sin2;
        let v = 0.2 * cos + 0.124 * cos2;
        let a = -2.0 * sin - 3.844 * sin2;
        [t, 50.0 * a + 100.0 * v + 20.0 * v.signum(), x]
    };
    (0..SAMPLES).map(row).collect()
}

fn read_as(map: &[&str], rate_hz: Option<f64>) -> ReadAs {
    ReadAs {
        axis: Some('X'),
        map: map.iter().map(|text| text.parse().unwrap()).collect(),
        rate_hz,
        preset: None,
    }
}

/// Reads a text, and finds the 50 kg.
fn finds_the_mass(text: &str, how: &ReadAs) -> Recording {
    let recording = Recording::read_as(text.as_bytes(), how).unwrap();
    let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
    assert!(
        (found.mass.value / 50.0 - 1.0).abs() < 0.01,
        "{:?}",
        found.mass
    );
    assert!((recording.period_s / PERIOD_S - 1.0).abs() < 1e-6);
    recording
}

#[test]
fn tabs_semicolons_decimal_commas_and_lines_before_the_names_are_read() {
    let mut german = "Aufzeichnung 3;Achse X\n\nZeit;Iq;Lage\nms;A;mm\n".to_owned();
    let mut tabs = "Trace\nTime [ms]\tForce [N]\tX Position [µm]\t\n".to_owned();
    for [t, f, x] in rows() {
        let line = format!("{:.3};{:.6};{:.7};", 1e3 * t, f / 2.5, 1e3 * x);
        writeln!(german, "{}", line.replace('.', ",")).unwrap();
        writeln!(tabs, "{:.3}\t{f:.6}\t{:.4}\t", 1e3 * t, 1e6 * x).unwrap();
    }
    let map = ["time=Zeit*1ms", "force=Iq*2.5N/A", "position=Lage*1mm"];
    finds_the_mass(&german, &read_as(&map, None));
    finds_the_mass(&tabs, &read_as(&[], None));
}

/// Latin-1, percent of a rated force, counts of an encoder, no times.
#[test]
fn counts_and_percent_are_read_by_a_map() {
    let mut bytes = b"Kraft in %,Z\xE4hler\n".to_vec();
    for [_, f, x] in rows() {
        let line = format!("{:.6},{:.0}\n", f / 4.0, x * 1e8);
        bytes.extend_from_slice(line.as_bytes());
    }
    let how = read_as(&["force=#1*4N/%", "position=Zähler*1e-5mm"], Some(1000.0));
    let recording = Recording::read_as(bytes.as_slice(), &how).unwrap();
    let found = rigid::fit(&recording, Friction::Symmetric, None).unwrap();
    assert!(
        (found.mass.value / 50.0 - 1.0).abs() < 0.01,
        "{:?}",
        found.mass
    );
}

/// One sample is missing, and times jitter by 10 µs and more.
#[test]
fn a_lost_sample_and_jitter_are_made_good_with_a_note() {
    let mut text = "time_s,force_n,position_m\n".to_owned();
    for (k, [t, f, x]) in rows().into_iter().enumerate() {
        let wobble = if k % 3 == 1 { 1.5e-5 } else { 0.0 };
        if k != 1200 {
            writeln!(text, "{:.6},{f},{x}", t + wobble).unwrap();
        }
    }
    let recording = finds_the_mass(&text, &read_as(&[], None));
    assert_eq!(recording.len(), SAMPLES);
    let notes = recording.notes.join("; ");
    assert!(
        notes.contains("1 sample is missing, the first after line 1201"),
        "{notes}"
    );
    assert!(notes.contains("uneven by up to"), "{notes}");
}

#[test]
fn what_does_not_go_together_is_refused() {
    let mut text = "time_s,force_n,position_m,Iq\n".to_owned();
    for [t, f, x] in rows() {
        writeln!(text, "{t:.3},{f},{x},{f}").unwrap();
    }
    let refuse = |text: &str, how: &ReadAs| {
        let trouble = Recording::read_as(text.as_bytes(), how).unwrap_err();
        trouble.to_string()
    };
    let said = refuse(&text, &read_as(&[], Some(1000.0)));
    assert!(
        said.contains("has times: --rate-hz has no meaning"),
        "{said}"
    );
    let said = refuse(&text, &read_as(&["torque=Id*1Nm"], None));
    assert!(said.contains("there is no column Id"), "{said}");
    let twice = ["torque=Iq*1Nm", "force=Iq*1N"];
    let said = refuse(&text, &read_as(&twice, None));
    assert!(
        said.contains("two columns for one quantity: Iq is the second"),
        "{said}"
    );
    let unnamed = text.replace("time_s", "seconds");
    let said = refuse(&unnamed, &read_as(&[], None));
    assert!(said.contains("or give --rate-hz"), "{said}");
    // What is given by hand goes before what the names say.
    let recording = Recording::read_as(text.as_bytes(), &read_as(&["force=Iq*2N"], None)).unwrap();
    assert_eq!(recording.ignored, ["force_n"]);
}
