//! Response correction: filters, delays, files, and the page.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gwatt::identify::flexible::Method;
use gwatt::identify::tune::{
    AxisResponse, Biquad, Correction, Discretization, Gain, LowPass, Parameters, Tuned, Wish, Zero,
    delays_agree, design, excited, of_recording,
};
use gwatt::identify::{Factor, Measured, TransferFunction, simulate};
use gwatt::report::{tune_page, tuned_json, tuned_text};

use crate::identify::{
    PERIOD_S, branched, choice, csv, m_sequence, one_side, recording, spring, table,
};

fn pair(hz: f64, damping: f64) -> Factor {
    Factor::Pair {
        omega_rad_s: TAU * hz,
        damping,
    }
}

fn wish(discretization: Discretization) -> Wish {
    Wish {
        period_s: 1e-3,
        discretization,
        no_low_pass: false,
        order: None,
        bandwidth_hz: None,
    }
}

/// An axis as a file gives it: from force, rigid but for these zeros.
fn axis(letter: char, zeros: &[(f64, f64)]) -> AxisResponse {
    let mut text =
        format!("schema = 1\n[axes.{letter}]\ninput = \"force\"\nmass_kg = 100\nzeros = [\n");
    for (hz, damping) in zeros {
        let _ = writeln!(text, "{{ frequency_hz = {hz:?}, damping = {damping:?} }},");
    }
    text += "]\n";
    Parameters::read(&text).unwrap().axes.remove(0)
}

fn from_command(letter: char, poles: &[Factor], delay_s: f64) -> AxisResponse {
    AxisResponse {
        from_command: true,
        inertia: None,
        poles: poles.to_vec(),
        delay_s,
        ..axis(letter, &[])
    }
}

fn lag(time_constant_s: f64) -> Factor {
    Factor::Real { time_constant_s }
}

#[test]
fn filters_are_those_of_scipy() {
    // tests/tune/reference.py: X gets the zeros of the others.
    let zeros = [
        ('X', vec![]),
        ('Y', vec![pair(40.0, 0.03)]),
        ('Z', vec![pair(75.0, 0.02)]),
    ];
    let tustin = [
        (10.0, 0.918_286_750_816, -0.084_557_117_286),
        (40.0, 0.017_983_709_299, 0.039_504_386_570),
        (55.0, -0.339_908_816_836, 0.265_056_242_701),
        (180.0, -112.596_834_860_411, -55.290_441_581_764),
    ];
    let held = [
        (10.0, 0.901_062_169_670, -0.293_156_441_801),
        (40.0, 0.019_221_555_548, -0.407_567_112_574),
        (55.0, -0.147_476_991_508, -0.211_648_264_348),
        (180.0, -4.017_385_843_920, 74.192_604_303_241),
    ];
    for (kind, order, reference) in [
        (Discretization::Tustin, 4, tustin),
        (Discretization::Hold, 6, held),
    ] {
        let wish = Wish {
            bandwidth_hz: Some(200.0),
            ..wish(kind)
        };
        let correction = design(&zeros, &wish).unwrap();
        let low_pass = LowPass::Butterworth {
            order,
            bandwidth_hz: 200.0,
        };
        assert_eq!(correction.low_pass, low_pass);
        for (hz, re, im) in reference {
            let found = correction.at_hz(0, hz);
            let apart = (found.re - re).hypot_with(found.im - im);
            assert!(
                apart < 1e-9 * re.hypot_with(im).max(0.1),
                "{kind:?} {hz}: {found}"
            );
        }
        assert!(correction.filters[0].sections.iter().all(Biquad::is_stable));
    }
}

trait Hypot {
    fn hypot_with(self, other: f64) -> f64;
}

impl Hypot for f64 {
    fn hypot_with(self, other: f64) -> f64 {
        libm::hypot(self, other)
    }
}

fn tuned(axes: Vec<AxisResponse>, wish: Wish) -> Tuned {
    Tuned::new(axes, wish, 50.0).unwrap()
}

#[test]
fn filters_with_the_true_zeros_make_axes_alike() {
    let flexible = || axis('X', &[(40.0, 0.03)]);
    let cases: [Vec<AxisResponse>; 4] = [
        vec![flexible(), axis('Y', &[(31.0, 0.03)])],
        vec![flexible(), axis('Y', &[])],
        vec![
            axis('X', &[(40.0, 0.03), (75.0, 0.02)]),
            axis('Y', &[(31.0, 0.03)]),
        ],
        vec![flexible(), axis('Y', &[(31.0, 0.03)]), axis('Z', &[])],
    ];
    for axes in cases {
        let worst = |tuned: &Tuned, after: bool| {
            let each = tuned.pairs.iter().map(|pair| {
                let m = if after { pair.after } else { pair.before };
                (m.gain_db, m.phase_deg)
            });
            each.fold((0.0_f64, 0.0_f64), |a, b| (a.0.max(b.0), a.1.max(b.1)))
        };
        let matched = tuned(axes.clone(), wish(Discretization::Matched));
        let (before, after) = (worst(&matched, false), worst(&matched, true));
        assert!(before.0 > 20.0 && before.1 > 150.0, "{before:?}");
        assert!(after.0 < 0.005 && after.1 < 0.04, "{after:?}");
        // Tustin's rule bends frequencies, of a zero on one side alone by
        // ω²·T²/6 at 50 Hz: 0.14 dB.
        let bent = worst(&tuned(axes.clone(), wish(Discretization::Tustin)), true);
        assert!(bent.0 < 0.3 && bent.1 < 0.7, "{bent:?}");
        // Without a low-pass the same numerators, and no denominators.
        let bare = Wish {
            no_low_pass: true,
            ..wish(Discretization::Matched)
        };
        let bare = tuned(axes, bare);
        let after = worst(&bare, true);
        assert!(after.0 < 0.005 && after.1 < 0.04, "{after:?}");
        let sections = bare.correction.filters.iter().flat_map(|f| &f.sections);
        assert!(sections.clone().count() > 0);
        assert!(sections.into_iter().all(|section| section.a == [0.0, 0.0]));
    }
}

#[test]
fn filters_leave_rest_as_it_is_and_say_how_late_they_are() {
    let axes = vec![axis('X', &[(40.0, 0.03)]), axis('Y', &[(31.0, 0.03)])];
    let bare = Wish {
        no_low_pass: true,
        ..wish(Discretization::Matched)
    };
    // One pair of zeros: one period late.
    let correction = tuned(axes.clone(), bare).correction;
    assert!((correction.delay_s() - 1e-3).abs() < 3e-6);
    let correction = tuned(axes, wish(Discretization::Matched)).correction;
    let LowPass::Butterworth { bandwidth_hz, .. } = correction.low_pass else {
        panic!("a low-pass");
    };
    assert_eq!(bandwidth_hz, 120.0);
    // √2/ω by Tustin's rule, pre-warped: √2·T/(2·tan(ω·T/2)).
    let low_pass_s = std::f64::consts::SQRT_2 * 0.5e-3 / libm::tan(PI * 0.12);
    // Numerator and denominator are late by T both, and so their quotient not.
    assert!((correction.delay_s() - low_pass_s).abs() < 3e-6);
    for filter in &correction.filters {
        for section in &filter.sections {
            let [b0, b1, b2, a1, a2] = section.coefficients();
            assert!((b0 + b1 + b2 - (1.0 + a1 + a2)).abs() < 1e-12);
        }
    }
}

/// The true mismatch behind filters that were made from noisy recordings.
#[test]
fn estimated_zeros_make_axes_alike() {
    let [k, c] = spring(0.008, 40.0, 0.03);
    let x = branched(0.006, 0.01, spring(0.0045, 150.0, 0.05), &[[0.008, k, c]]);
    let [k, c] = spring(0.009, 31.0, 0.03);
    let y = branched(0.006, 0.014, spring(0.0045, 160.0, 0.05), &[[0.009, k, c]]);
    let rigid = TransferFunction::constant(50.0);
    for (a, b) in [(&x, &y), (&rigid, &y)] {
        let axes: Vec<AxisResponse> = [('X', a, 1), ('Y', b, 2)]
            .into_iter()
            .map(|(letter, truth, seed)| {
                let recording = recording(truth, 8.0, 0.05, seed);
                of_recording(&recording, letter, &choice(Method::Iv)).unwrap()
            })
            .collect();
        for (axis, truth) in axes.iter().zip([a, b]) {
            assert_eq!(axis.zeros.len(), truth.anti_resonances().count());
            assert!(axis.notes.is_empty(), "{:?}", axis.notes);
        }
        let tuned = tuned(axes, wish(Discretization::Matched));
        let before = true_mismatch([a, b], None);
        let after = true_mismatch([a, b], Some(&tuned.correction));
        assert!(before[0] > 20.0 && before[1] > 150.0, "{before:?}");
        let error = tuned.pairs[0].error;
        assert!(
            after[0] < error.gain_db && after[1] < error.phase_deg,
            "{after:?} {error:?}"
        );
        assert!(after[0] < 0.5 && after[1] < 3.0, "{after:?}");
    }
}

fn true_mismatch(axes: [&TransferFunction; 2], correction: Option<&Correction>) -> [f64; 2] {
    let zeros = axes.map(|axis| TransferFunction {
        gain: 1.0,
        zeros: axis
            .anti_resonances()
            .map(|(w, d)| pair(w / TAU, d))
            .collect(),
        ..TransferFunction::constant(1.0)
    });
    let mut worst = [0.0_f64; 2];
    for k in 1..=500 {
        let hz = 0.1 * f64::from(k);
        let mut ratio = zeros[0].at_hz(hz) / zeros[1].at_hz(hz);
        if let Some(correction) = correction {
            ratio *= correction.at_hz(0, hz) / correction.at_hz(1, hz);
        }
        worst[0] = worst[0].max((20.0 * libm::log10(ratio.norm())).abs());
        worst[1] = worst[1].max(libm::atan2(ratio.im, ratio.re).abs() * 180.0 / PI);
    }
    worst
}

#[test]
fn delays_are_told_and_made_to_agree() {
    // 1/40 s and 1/50 s of the loops, 1 ms more of dead time on Y.
    let axes = vec![
        from_command('X', &[lag(0.025)], 0.0),
        from_command('Y', &[lag(0.02)], 1e-3),
    ];
    let result = tuned(axes, wish(Discretization::Matched));
    let advice = result.advice.as_ref().unwrap();
    assert!(!delays_agree(advice));
    assert!((advice[0].delay_s - 0.025).abs() < 1e-15 && advice[0].command_delay_s == 0.0);
    assert!((advice[1].command_delay_s - 4e-3).abs() < 1e-15);
    let text = tuned_text(&result);
    assert!(
        text.contains(
            "delays do not agree: X 25.000 ms, Y 21.000 ms; circles come 66.7 µm out of round for each m/min of feed\n  \
             Y: lower the gain of its position loop to 0.8400 of what it is, or delay its command by 4.000 ms"
        ),
        "{text}"
    );
    // With the gains known: 1/(1/50 + 5 ms) = 40.
    let mut axes = vec![axis('X', &[]), axis('Y', &[])];
    axes[0].position_gain_1_s = Some(40.0);
    assert!(
        tuned(axes.clone(), wish(Discretization::Matched))
            .advice
            .is_none()
    );
    axes[1].position_gain_1_s = Some(50.0);
    let advice = tuned(axes.clone(), wish(Discretization::Matched))
        .advice
        .unwrap();
    let Some(Gain::Absolute(gain)) = advice[1].gain else {
        panic!("{advice:?}");
    };
    assert!((gain - 40.0).abs() < 1e-12);
    axes[1].position_gain_1_s = Some(gain);
    assert!(delays_agree(
        &tuned(axes, wish(Discretization::Matched)).advice.unwrap()
    ));
}

#[test]
fn a_pole_besides_a_zero_does_not_hide_the_judgement() {
    // Two resonances without a zero between them: a valley, but no dip.
    let chain = branched(0.006, 0.01, spring(0.004, 120.0, 0.03), &[]);
    let found = of_recording(&recording(&chain, 4.0, 0.05, 3), 'X', &choice(Method::Iv)).unwrap();
    assert!(
        found.zeros.is_empty() && found.notes.is_empty(),
        "{:?}",
        found.notes
    );
    let found = of_recording(
        &recording(&one_side(), 4.0, 0.05, 3),
        'X',
        &choice(Method::Iv),
    );
    let found = found.unwrap();
    assert_eq!(found.zeros.len(), 1);
    assert!((found.zeros[0].omega_rad_s.value / TAU - 40.0).abs() < 0.1);
}

/// A command that is held between samples, and one that the drive joins by
/// straight lines a period later: both give the zero of the load.
#[test]
fn commands_may_be_held_or_run_on() {
    let truth = TransferFunction {
        gain: 1.0,
        zeros: vec![pair(40.0, 0.03)],
        poles: vec![pair(45.0, 0.4), pair(90.0, 0.5)],
        delay_s: 0.0,
    };
    let mut position = Vec::new();
    let (mut speed, mut place) = (0.0, 0.0);
    for accel in m_sequence(4000) {
        speed += accel * PERIOD_S;
        place += speed * PERIOD_S;
        position.push(place);
    }
    let held = simulate(&truth, Measured::Direct, PERIOD_S, &position).unwrap();
    let slopes: Vec<f64> = std::iter::once(0.0)
        .chain(
            position
                .windows(2)
                .map(|pair| (pair[1] - pair[0]) / PERIOD_S),
        )
        .collect();
    let speeds = simulate(&truth, Measured::Velocity, PERIOD_S, &slopes).unwrap();
    let joined: Vec<f64> = speeds
        .iter()
        .scan(position[0], |at, v| {
            *at += v * PERIOD_S;
            Some(*at)
        })
        .collect();
    for load in [held, joined] {
        let recording = table(&["position_command_m", "position_m"], &[&position, &load]);
        let found = of_recording(&recording, 'X', &choice(Method::Iv)).unwrap();
        assert_eq!(found.zeros.len(), 1);
        let zero = found.zeros[0];
        assert!(
            (zero.omega_rad_s.value / TAU - 40.0).abs() < 0.2,
            "{zero:?}"
        );
        assert!((zero.damping.value - 0.03).abs() < 0.003, "{zero:?}");
        assert!(found.delay_s < PERIOD_S, "{}", found.delay_s);
    }
}

fn refusal<T: std::fmt::Debug>(outcome: gwatt::identify::Outcome<T>) -> (String, String) {
    let trouble = outcome.unwrap_err();
    (trouble.message, trouble.help)
}

#[test]
fn filters_that_cannot_be_had_are_refused() {
    let zeros = |hz: f64, damping: f64| [('X', vec![pair(hz, damping)]), ('Y', vec![])];
    let base = wish(Discretization::Matched);
    let refused = |zeros: &[(char, Vec<Factor>)], wish: Wish| refusal(design(zeros, &wish)).0;
    let of = |wish: Wish| refused(&zeros(40.0, 0.03), wish);
    assert_eq!(
        of(Wish {
            period_s: 0.0,
            ..base
        }),
        "the period of the filters is not positive"
    );
    assert_eq!(
        of(Wish {
            period_s: 0.02,
            ..base
        }),
        "axis X: the zero at 40.0 Hz is too fast for filters at 50 Hz"
    );
    assert_eq!(
        of(Wish {
            order: Some(1),
            ..base
        }),
        "a low-pass of order 1 under a numerator of order 2: the filter would not be causal"
    );
    assert_eq!(
        of(Wish {
            order: Some(99),
            ..base
        }),
        "a low-pass of order 99: at most 24 can be had"
    );
    assert_eq!(
        of(Wish {
            bandwidth_hz: Some(450.0),
            ..base
        }),
        "a low-pass of 450 Hz cannot be had at 1000 Hz"
    );
    assert_eq!(
        of(Wish {
            no_low_pass: true,
            ..wish(Discretization::Hold)
        }),
        "without a low-pass the filters are not causal as zoh makes them"
    );
    assert_eq!(
        refused(&zeros(40.0, 1.5), base),
        "axis X: a zero that does not oscillate cannot be evened out"
    );
    let refused = |axes: Vec<AxisResponse>, band| refusal(Tuned::new(axes, base, band)).0;
    let x = || axis('X', &[]);
    assert_eq!(
        refused(vec![x()], 50.0),
        "one axis alone has nothing to be like"
    );
    assert_eq!(refused(vec![x(), x()], 50.0), "axis X is given twice");
    assert_eq!(
        refused(vec![x(), axis('Y', &[])], 501.0),
        "axes cannot be compared up to 501 Hz"
    );
    assert_eq!(
        refused(vec![x(), from_command('Y', &[], 0.0)], 50.0),
        "axis Y is known from its command, axis X from its force"
    );
}

#[test]
fn too_little_motion_is_refused() {
    let position: Vec<f64> = (0..4000)
        .map(|k| 0.5 * libm::sin(TAU * 5.0 * f64::from(k) * PERIOD_S))
        .collect();
    let recording = table(&["torque_nm", "position_mm"], &[&position, &position]);
    // 0.5·(2π·5)² = 493.5 mm/s², by √2.
    let found = excited(&recording, 'X', Some(340.0)).unwrap();
    assert!(
        (found.rms - 348.9).abs() < 0.5 && found.unit == "mm/s²",
        "{found:?}"
    );
    let (message, help) = refusal(excited(&recording, 'X', Some(360.0)));
    assert!(
        message.starts_with("axis X: the excitation moves it by 348.9")
            && message.ends_with("mm/s² rms, less than the 360 that are asked for"),
        "{message}"
    );
    assert_eq!(
        help,
        "excite with more amplitude (gwatt excite --amplitude), and record again"
    );
}

#[test]
fn parameters_come_back_as_they_were() {
    let mut x = from_command('X', &[lag(0.025), pair(60.0, 0.4)], 1.5e-3);
    x.zeros = vec![Zero::exact(TAU * 40.25, 0.031)];
    x.zeros[0].omega_rad_s.std = 0.5;
    x.zeros[0].damping.std = 0.001;
    x.further_zeros = vec![lag(-0.001)];
    let y = from_command('Y', &[lag(0.025)], 0.0);
    let wish = Wish {
        period_s: 2e-3,
        order: Some(3),
        bandwidth_hz: Some(90.0),
        ..wish(Discretization::Tustin)
    };
    let first = Tuned::new(vec![x, y], wish, 40.0).unwrap();
    let text = Parameters::write(&first.axes, &first.wish, first.band_hz, &first.correction);
    let read = Parameters::read(&text).unwrap();
    assert_eq!(read.discretization, Some(Discretization::Tustin));
    assert_eq!((read.period_s, read.band_hz), (Some(2e-3), Some(40.0)));
    assert_eq!((read.order, read.bandwidth_hz), (Some(3), Some(90.0)));
    let again = Tuned::new(read.axes, wish, 40.0).unwrap();
    let text_again = Parameters::write(&again.axes, &again.wish, again.band_hz, &again.correction);
    assert_eq!(text_again, text);
    for wrong in [
        "",
        "schema = 2\n[axes]",
        "schema = 1\nperiod_ms = 0\n[axes]",
        "schema = 1\nlow_pass = \"bessel\"\n[axes]",
        "schema = 1\ndiscretize = \"euler\"\n[axes]",
        "schema = 1\n[axes.XY]\ninput = \"command\"",
        "schema = 1\n[axes.X]\ninput = \"speed\"",
        "schema = 1\n[axes.X]\ninput = \"force\"",
        "schema = 1\n[axes.X]\ninput = \"force\"\ninertia_kg_m2 = 1",
        "schema = 1\n[axes.X]\ninput = \"command\"\nmass_kg = 1",
        "schema = 1\n[axes.X]\ninput = \"command\"\ndelay_ms = -1",
        "schema = 1\n[axes.X]\ninput = \"command\"\npoles = [{ frequency_hz = 1 }]",
        "schema = 1\n[axes.X]\ninput = \"command\"\npoles = [{ time_constant_s = -1 }]",
        "schema = 1\n[axes.X]\ninput = \"command\"\nzeros = [{ time_constant_s = 1 }]",
        "schema = 1\n[axes.X]\ninput = \"command\"\nzeros = [{ frequency_hz = inf, damping = 0 }]",
    ] {
        let (message, help) = refusal(Parameters::read(wrong));
        assert!(!message.is_empty() && !help.is_empty(), "{wrong}");
    }
}

/// The script of the page, run by node where there is one: what it computes is
/// what gwatt computes, and what it saves gwatt reads.
#[test]
fn the_page_computes_redraws_and_saves() {
    let mut axes = vec![
        axis('X', &[(40.0, 0.03)]),
        axis('Y', &[(31.0, 0.03), (70.0, 0.02)]),
    ];
    axes[0].source = "</script><b>&\"".to_owned();
    let recording = recording(&one_side(), 4.0, 0.05, 1);
    axes[1].measured = of_recording(&recording, 'Y', &choice(Method::Iv))
        .unwrap()
        .measured;
    axes[0].poles = vec![pair(45.0, 0.03)];
    let mut page = Vec::new();
    let shown = tuned(axes, wish(Discretization::Matched));
    tune_page(&shown, &mut page).unwrap();
    let text = String::from_utf8(page.clone()).unwrap();
    assert_eq!(text.matches("</script>").count(), 2);
    assert!(!text.contains("/*") && !text.contains("http://127"));
    assert!(text.matches("://").count() == text.matches("http://www.w3.org/2000/svg").count());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page.html");
    fs::write(&path, page).unwrap();
    let harness = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tune/page.js");
    let Ok(output) = Command::new("node").arg(harness).arg(&path).output() else {
        eprintln!("skipped: there is no node");
        return;
    };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
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

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("examples/recordings")
        .join(name)
}

fn gwatt(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gwatt"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

const MILL: &str = r#"schema = 1
name = "mill"
controller = "iso"
[converter]
peak_power_w = 3000
[axes.X] # long
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300
[axes.Y] # short
rapid_mm_min = 24000
accel_mm_s2 = 4000
mass_kg = 300
"#;

#[test]
fn recordings_become_filters_in_the_machine_file() {
    let shop = tempfile::tempdir().unwrap();
    let folder = shop.path();
    for axis in ["x", "y"] {
        let name = format!("flexible-{axis}.csv");
        fs::copy(example(&name), folder.join(&name)).unwrap();
    }
    fs::write(folder.join("mill.toml"), MILL).unwrap();
    let (code, text, said) = gwatt(
        folder,
        &[
            "tune",
            "flexible-x.csv",
            "flexible-y.csv",
            "--into",
            "mill.toml",
            "--json",
            "t.json",
            "--csv",
            "t.csv",
            "--toml",
            "t.toml",
            "--html",
            "t.html",
            "--least-accel-mm-s2",
            "9000",
        ],
    );
    assert_eq!(code, 0, "{said}");
    assert!(
        text.contains("X: flexible-x.csv, from torque, inertia 0.024"),
        "{text}"
    );
    assert!(said.contains("mill.toml has the new figures"), "{said}");
    let mill = fs::read_to_string(folder.join("mill.toml")).unwrap();
    for line in [
        "[axes.X] # long\n",
        "[axes.X.correction]\nperiod_ms = 1.0\n",
        "[axes.Y.response]\n",
    ] {
        assert!(mill.contains(line), "{mill}");
    }
    let (code, _, said) = gwatt(folder, &["machine", "check", "mill.toml"]);
    assert_eq!(code, 0, "{said}");
    let csv = fs::read_to_string(folder.join("t.csv")).unwrap();
    assert_eq!(csv.lines().count(), 3);
    assert_eq!(
        csv.lines().next(),
        Some("axis,section,period_s,b0,b1,b2,a1,a2")
    );
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("t.json")).unwrap()).unwrap();
    assert_eq!(json["axes"][0]["rigid"], false);
    let hz = json["axes"][1]["zeros"][0]["frequency_hz"]
        .as_f64()
        .unwrap();
    assert!((hz - 31.0).abs() < 0.3, "{hz}");
    // The file of parameters gives the same filters.
    let (code, _, said) = gwatt(folder, &["tune", "--from", "t.toml", "--csv", "again.csv"]);
    assert_eq!(code, 0, "{said}");
    assert_eq!(fs::read_to_string(folder.join("again.csv")).unwrap(), csv);
    // Too little motion: nothing is written.
    let (code, text, said) = gwatt(
        folder,
        &[
            "tune",
            "X=flexible-x.csv",
            "Y=flexible-y.csv",
            "--least-accel-mm-s2",
            "1e6",
            "--csv",
            "none.csv",
        ],
    );
    assert_eq!((code, text.as_str()), (2, ""));
    assert!(
        said.contains("less than the 1000000 that are asked for"),
        "{said}"
    );
    assert!(!folder.join("none.csv").exists());
}

#[test]
fn wrong_arguments_of_tune_are_told() {
    let shop = tempfile::tempdir().unwrap();
    let folder = shop.path();
    let accel: Vec<f64> = (0..300).map(|k| libm::sin(f64::from(k))).collect();
    fs::write(
        folder.join("run7.csv"),
        csv(&["torque_nm", "accel_m_s2"], &[&accel, &accel]),
    )
    .unwrap();
    fs::write(
        folder.join("p.toml"),
        "schema = 1\n[axes.X]\ninput = \"command\"\n",
    )
    .unwrap();
    for (arguments, expected) in [
        (vec!["run7.csv"], "run7.csv: which axis is this?"),
        (vec!["X=run7.csv", "x=run7.csv"], "axis X is given twice"),
        (vec!["X=-"], "are read from files, not from standard input"),
        (vec!["Q=run7.csv"], "Q is no axis"),
        (vec!["x.csv"], "x.csv: cannot read the recording"),
        (
            vec!["--from", "p.toml"],
            "one axis alone has nothing to be like",
        ),
        (
            vec!["--from", "p.toml", "--position-gain", "Y=3"],
            "--position-gain: there is no axis Y",
        ),
        (
            vec!["--from", "p.toml", "--position-gain", "X=3"],
            "--position-gain: the loop of axis X is in its recording already",
        ),
        (vec!["--from", "none.toml"], "cannot read none.toml"),
        (
            vec!["--from", "run7.csv"],
            "run7.csv: this is no file of parameters",
        ),
    ] {
        let arguments: Vec<&str> = [vec!["tune"], arguments].concat();
        let (code, text, said) = gwatt(folder, &arguments);
        assert_eq!((code, text.as_str()), (2, ""), "{arguments:?}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}

#[test]
fn a_tuning_as_json_knows_what_is_not_known() {
    let mut out = Vec::new();
    let result = tuned(
        vec![axis('X', &[]), axis('Y', &[])],
        wish(Discretization::Matched),
    );
    tuned_json(&result, &mut out).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&out).unwrap();
    assert_eq!(json["axes"][0]["rigid"], true);
    assert_eq!(json["axes"][0]["delay_s"], serde_json::Value::Null);
    assert_eq!(json["axes"][0]["sections"], serde_json::json!([]));
    assert_eq!(json["delays_agree"], serde_json::Value::Null);
    assert!(
        tuned_text(&result).contains("no axis has an anti-resonance: nothing is to be evened out")
    );
}
